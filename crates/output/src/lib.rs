//! Files that are there whole or not at all.
//!
//! What is written goes to `.NAME.neurotess-part` beside the final name and is renamed at the end.
//! The name is always the same, so that a run that was killed leaves nothing that the next one
//! does not use up; a lock on the file keeps two runs from writing one file at a time.
//!
//! Only regular files are ever replaced. Where the name is a link, its target is written, and the link
//! stays; a device, a pipe or a folder is left alone. [`Output::standard`] is for standard output: it
//! gets the whole or nothing too.
//!
//! A program that is interrupted calls [`remove_unfinished`] and leaves. **Why not** a flag that
//! everything polls: a long read or solve would answer late. Instead every temporary file is known
//! here, and no file gets its final name but under the same lock.
#![forbid(unsafe_code)]

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Seek, Write};
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
    /// There is something else than a file, which is never replaced.
    #[error(
        "{} is {what}, not a file: choose another name, or - for standard output",
        .path.display()
    )]
    NotAFile { path: PathBuf, what: &'static str },
    /// Links that lead nowhere.
    #[error("{} is a link that cannot be followed ({source}): remove it", .path.display())]
    Link { path: PathBuf, source: io::Error },
    /// Standard output took no more.
    #[error("standard output cannot be written ({source}): check where it goes")]
    Standard { source: io::Error },
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
    /// [`OutputError::Exists`]; [`OutputError::NotAFile`] if it is none, which nothing replaces.
    pub fn check(self, path: &Path) -> Result<(), OutputError> {
        if fs::symlink_metadata(path).is_err() {
            return Ok(());
        }
        replaceable(path)?;
        match self {
            Self::Refuse(advice) => Err(OutputError::Exists {
                path: path.into(),
                advice,
            }),
            Self::Replace => Ok(()),
        }
    }
}

/// An error if there is something else than a regular file, or a link to one.
fn replaceable(path: &Path) -> Result<(), OutputError> {
    let Ok(data) = fs::metadata(path) else {
        return Ok(());
    };
    let what = match data.file_type() {
        kind if kind.is_file() => return Ok(()),
        kind if kind.is_dir() => "a folder",
        _ => "a device or a pipe",
    };
    Err(OutputError::NotAFile {
        path: path.into(),
        what,
    })
}

/// Most links in a row.
const LINKS: usize = 40;

/// Where a link leads; any other path itself.
fn target(path: &Path) -> Result<PathBuf, OutputError> {
    let failed = |source| OutputError::Link {
        path: path.into(),
        source,
    };
    let mut target = path.to_path_buf();
    for _ in 0..LINKS {
        match fs::symlink_metadata(&target) {
            Ok(data) if data.is_symlink() => {
                let next = fs::read_link(&target).map_err(failed)?;
                target = match target.parent() {
                    Some(folder) => folder.join(next),
                    None => next,
                };
            }
            _ => return Ok(target),
        }
    }
    Err(failed(io::Error::other("too many links")))
}

/// A file being written; dropped before it is finished, it was never there.
#[derive(Debug)]
pub struct Output {
    file: Option<File>,
    to: To,
}

/// Where a file goes.
#[derive(Debug)]
enum To {
    /// Its final name, as it was named and with links followed.
    Path {
        part: PathBuf,
        path: PathBuf,
        target: PathBuf,
        existing: Existing,
    },
    /// Standard output.
    Standard,
}

impl Output {
    /// Begins a file, in a folder that is made if need be.
    ///
    /// # Errors
    /// What is in the way.
    pub fn create(path: &Path, existing: Existing) -> Result<Self, OutputError> {
        existing.check(path)?;
        let target = target(path)?;
        let part = part_of(&target)?;
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
            to: To::Path {
                part,
                path: path.to_path_buf(),
                target,
                existing,
            },
        })
    }

    /// Begins what standard output gets as a whole at the end, since some formats are not written from
    /// the beginning to the end.
    ///
    /// # Errors
    /// No file without a name can be made for it.
    pub fn standard() -> Result<Self, OutputError> {
        let file = tempfile::tempfile().map_err(|source| OutputError::Standard { source })?;
        Ok(Self {
            file: Some(file),
            to: To::Standard,
        })
    }

    /// The file that another program writes to, before it has its name; `-` for standard output.
    pub fn part(&self) -> &Path {
        match &self.to {
            To::Path { part, .. } => part,
            To::Standard => Path::new("-"),
        }
    }

    /// Where to write.
    pub fn file(&mut self) -> &mut File {
        self.file.as_mut().expect("open until it is finished")
    }

    /// Gives the file its name, or standard output what it holds. A reader that has gone away is no
    /// error.
    ///
    /// # Errors
    /// Another file has got this name meanwhile, or the file system refuses.
    pub fn finish(mut self) -> Result<(), OutputError> {
        let To::Path {
            part,
            path,
            target,
            existing,
        } = &self.to
        else {
            let copied = self.file.take().map_or(Ok(()), copy_to_standard);
            return match copied {
                Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(()),
                copied => copied.map_err(|source| OutputError::Standard { source }),
            };
        };
        existing.check(path)?;
        let renamed = settle(part, || fs::rename(part, target));
        // The lock ends here, after the renaming.
        self.file = None;
        renamed.map_err(|e| {
            drop(fs::remove_file(part));
            OutputError::broken(path, e)
        })
    }
}

fn copy_to_standard(mut file: File) -> io::Result<()> {
    file.rewind()?;
    let mut out = io::stdout().lock();
    io::copy(&mut file, &mut out)?;
    out.flush()
}

impl Drop for Output {
    fn drop(&mut self) {
        if let (Some(_), To::Path { part, .. }) = (&self.file, &self.to) {
            drop(settle(part, || fs::remove_file(part)));
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
    write_into(Output::create(path, existing)?, path, write)
}

/// Writes what has been begun from beginning to end; `path` is what errors call it.
///
/// # Errors
/// What `write` or the file system says.
pub fn write_into(
    mut output: Output,
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> Result<(), OutputError> {
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
    // Whatever else has this name is not ours.
    if fs::symlink_metadata(part).is_ok_and(|data| !data.is_file()) {
        return Err(OutputError::NotAFile {
            path: part.into(),
            what: "in the way and no regular file",
        });
    }
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

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_its_target_is_written() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a folder");
        let (target, link) = (
            folder.path().join("sub/real.ply"),
            folder.path().join("a.ply"),
        );
        fs::create_dir(folder.path().join("sub")).expect("made");
        fs::write(&target, "old").expect("written");
        symlink("sub/real.ply", &link).expect("linked");
        assert!(write_whole(&link, REFUSE, |to| to.write_all(b"new")).is_err());
        write_whole(&link, Existing::Replace, |to| to.write_all(b"new")).expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&target).expect("there"), b"new");
        // One that leads to nothing yet.
        fs::remove_file(&target).expect("removed");
        write_whole(&link, Existing::Replace, |to| to.write_all(b"again")).expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&target).expect("there"), b"again");
        // One that leads to itself.
        symlink("b.ply", folder.path().join("b.ply")).expect("linked");
        let circle = write_whole(&folder.path().join("b.ply"), Existing::Replace, |_| Ok(()));
        assert!(
            matches!(circle, Err(OutputError::Link { .. })),
            "{circle:?}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_never_replaced() {
        use std::os::unix::fs::{FileTypeExt, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let link = folder.path().join("a.ply");
        symlink("/dev/null", &link).expect("linked");
        for path in [link.as_path(), Path::new("/dev/null"), folder.path()] {
            let refused = write_whole(path, Existing::Replace, |to| to.write_all(b"new"));
            assert!(
                matches!(refused, Err(OutputError::NotAFile { .. })),
                "{refused:?}"
            );
        }
        assert!(link.is_symlink());
        let null = fs::metadata("/dev/null").expect("there").file_type();
        assert!(null.is_char_device());
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
