//! Files that are there whole or not at all.
//!
//! What is written goes to `.NAME.neurotess-part` beside the final name and is renamed at the end.
//! The name is always the same, so that a run that was killed leaves nothing that the next one
//! does not use up; a lock on the file keeps two runs from writing one file at a time.
//!
//! A program that is interrupted calls [`remove_unfinished`] and leaves. **Why not** a flag that
//! everything polls: a long read or solve would answer late. Instead every temporary file is known
//! here, and no file gets its final name but under the same lock.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use thiserror::Error;

static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// What is done with a file that is there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// It is replaced.
    Replace,
    /// It stays, with an error that says what to do.
    Refuse(&'static str),
}

/// Why a file could not be written: `what: what to do`.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the names say it")]
pub enum OutputError {
    /// The file exists and must not be replaced; what to do.
    #[error("{} exists: {advice}", .path.display())]
    Exists { path: PathBuf, advice: &'static str },
    /// The path ends in no file's name.
    #[error("{} names no file: give a file's name", .path.display())]
    Nameless { path: PathBuf },
    /// Another run, or another part of this one, writes the file now.
    #[error("{} is being written by another run: wait for it", .path.display())]
    Taken { path: PathBuf },
    /// The folder is not there and cannot be made.
    #[error("folder {} cannot be made ({source}): choose another one", .path.display())]
    Folder { path: PathBuf, source: io::Error },
    /// The file cannot be written.
    #[error("{} cannot be written ({source}): check space and permissions", .path.display())]
    Broken { path: PathBuf, source: io::Error },
}

impl OutputError {
    /// A failure to write this file.
    pub fn broken(path: &Path, source: impl Into<io::Error>) -> Self {
        Self::Broken {
            path: path.into(),
            source: source.into(),
        }
    }
}

impl Existing {
    /// An error if the file exists and must not be replaced.
    ///
    /// # Errors
    /// [`OutputError::Exists`].
    pub fn check(self, path: &Path) -> Result<(), OutputError> {
        match self {
            Self::Refuse(advice) if fs::symlink_metadata(path).is_ok() => {
                Err(OutputError::Exists {
                    path: path.into(),
                    advice,
                })
            }
            _ => Ok(()),
        }
    }
}

/// A file being written; dropped before it is finished, it was never there.
#[derive(Debug)]
pub struct Output {
    file: Option<File>,
    part: PathBuf,
    path: PathBuf,
    existing: Existing,
}

impl Output {
    /// Begins a file, in a folder that is made if need be.
    ///
    /// # Errors
    /// What is in the way.
    pub fn create(path: &Path, existing: Existing) -> Result<Self, OutputError> {
        existing.check(path)?;
        let part = part_of(path)?;
        let folder = part.parent().filter(|p| !p.as_os_str().is_empty());
        if let Some(folder) = folder {
            fs::create_dir_all(folder).map_err(|source| OutputError::Folder {
                path: folder.into(),
                source,
            })?;
        }
        let mut unfinished = lock();
        let file = open_part(&part, path)?;
        unfinished.insert(part.clone());
        drop(unfinished);
        Ok(Self {
            file: Some(file),
            part,
            path: path.to_path_buf(),
            existing,
        })
    }

    /// The file that another program writes to, before it has its name.
    pub fn part(&self) -> &Path {
        &self.part
    }

    /// Where to write.
    pub fn file(&mut self) -> &mut File {
        self.file.as_mut().expect("open until it is finished")
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// Another file has got this name meanwhile, or the file system refuses.
    pub fn finish(mut self) -> Result<(), OutputError> {
        self.existing.check(&self.path)?;
        let renamed = settle(&self.part, || fs::rename(&self.part, &self.path));
        // The lock ends here, after the renaming.
        self.file = None;
        renamed.map_err(|e| {
            drop(fs::remove_file(&self.part));
            OutputError::broken(&self.path, e)
        })
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        if self.file.is_some() {
            drop(settle(&self.part, || fs::remove_file(&self.part)));
        }
    }
}

/// Writes a file from beginning to end.
///
/// # Errors
/// What is in the way, or what `write` says.
pub fn write_whole(
    path: &Path,
    existing: Existing,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let mut output = Output::create(path, existing)?;
    let mut file = BufWriter::new(output.file());
    let written = write(&mut file).and_then(|()| {
        file.into_inner()
            .map_err(io::IntoInnerError::into_error)
            .map(drop)
    });
    written.map_err(|e| OutputError::broken(path, e))?;
    output.finish()
}

/// While this lives, no file is made or gets its final name.
#[derive(Debug)]
#[must_use = "files can be made again when this is dropped"]
pub struct Ended(#[expect(dead_code, reason = "held")] MutexGuard<'static, BTreeSet<PathBuf>>);

/// Removes all files that are being written, for a program that is about to leave.
pub fn remove_unfinished() -> Ended {
    let unfinished = lock();
    for path in unfinished.iter() {
        drop(fs::remove_file(path));
    }
    Ended(unfinished)
}

/// Ends the file's time as a temporary one, by renaming or removing it.
fn settle(part: &Path, end: impl FnOnce() -> io::Result<()>) -> io::Result<()> {
    let mut unfinished = lock();
    let ended = end();
    unfinished.remove(part);
    ended
}

fn lock() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Opens the temporary file, empty and locked.
fn open_part(part: &Path, path: &Path) -> Result<File, OutputError> {
    let taken = || OutputError::Taken { path: path.into() };
    let broken = |e| OutputError::broken(path, e);
    let mut options = OpenOptions::new();
    options.create(true).truncate(false).write(true);
    let file = options.open(part).map_err(broken)?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => return Err(taken()),
        // Some file systems know no locks.
        Ok(()) | Err(TryLockError::Error(_)) => {}
    }
    // Between opening and locking, another run may have given the file its final name.
    if !part.exists() {
        return Err(taken());
    }
    file.set_len(0).map_err(broken)?;
    Ok(file)
}

fn part_of(path: &Path) -> Result<PathBuf, OutputError> {
    let name = path
        .file_name()
        .ok_or_else(|| OutputError::Nameless { path: path.into() })?;
    let mut part = OsString::from(".");
    part.push(name);
    part.push(".neurotess-part");
    Ok(path.with_file_name(part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    const REFUSE: Existing = Existing::Refuse("choose another name");

    #[test]
    fn files_appear_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("sub/cell.ply");
        let mut output = Output::create(&path, REFUSE).expect("begun");
        output.file().write_all(b"half").expect("written");
        assert!(Output::create(&path, REFUSE).is_err(), "locked");
        drop(output);
        assert_eq!(
            fs::read_dir(folder.path().join("sub"))
                .expect("read")
                .count(),
            0
        );

        let mut output = Output::create(&path, REFUSE).expect("begun");
        output.file().write_all(b"whole").expect("written");
        output.finish().expect("finished");
        assert_eq!(fs::read(&path).expect("there"), b"whole");
        let refused = Output::create(&path, REFUSE).expect_err("there");
        assert!(refused.to_string().ends_with("exists: choose another name"));
        assert!(Output::create(&path, Existing::Replace).is_ok());
        assert_eq!(fs::read(&path).expect("still there"), b"whole");
    }

    #[test]
    fn a_write_that_fails_leaves_what_was_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/a.txt");
        write_whole(&path, REFUSE, |to| to.write_all(b"one")).expect("written");
        let broken = write_whole(&path, Existing::Replace, |to| {
            to.write_all(b"half")?;
            Err(io::Error::other("no space"))
        });
        assert!(broken.expect_err("broken").to_string().contains("no space"));
        assert_eq!(fs::read(&path).expect("there"), b"one");
        let files = fs::read_dir(path.parent().expect("one")).expect("there");
        assert_eq!(files.count(), 1);
    }

    #[test]
    fn leavings_of_a_killed_run_are_used_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("cell.ply");
        let leavings = folder.path().join(".cell.ply.neurotess-part");
        fs::write(leavings, "long leavings").expect("made");
        write_whole(&path, REFUSE, |to| to.write_all(b"new")).expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        assert_eq!(fs::read_dir(folder.path()).expect("read").count(), 1);
    }
}
