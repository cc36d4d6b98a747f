//! Files that are there whole or not at all.
//!
//! What is written goes to `.NAME.neurotess-part` beside the final name and is renamed at the end.
//! The name is always the same, so that a run that was killed leaves nothing that the next one
//! does not use up; a lock on the file keeps two runs from writing one file at a time.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use crate::interrupt;

/// Why a file could not be written: `what: what to do`.
#[derive(Debug)]
pub(crate) struct OutputError(String);

impl std::fmt::Display for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for OutputError {}

/// A file being written.
pub(crate) struct Output {
    file: Option<File>,
    part: PathBuf,
    path: PathBuf,
    force: bool,
}

impl Output {
    /// Begins a file, in a folder that is made if need be.
    pub(crate) fn create(path: &Path, force: bool) -> Result<Self, OutputError> {
        refuse_existing(path, force)?;
        let part = part_of(path)?;
        let folder = part.parent().filter(|p| !p.as_os_str().is_empty());
        if let Some(folder) = folder {
            fs::create_dir_all(folder).map_err(|e| {
                OutputError(format!(
                    "folder {} cannot be made ({e}): choose another one",
                    folder.display()
                ))
            })?;
        }
        let file = interrupt::make(&part, || open_part(&part, path))?;
        Ok(Self {
            file: Some(file),
            part,
            path: path.to_path_buf(),
            force,
        })
    }

    /// Where to write.
    pub(crate) fn file(&mut self) -> &mut File {
        self.file.as_mut().expect("open until it is finished")
    }

    /// Gives the file its name.
    pub(crate) fn finish(mut self) -> Result<(), OutputError> {
        refuse_existing(&self.path, self.force)?;
        let renamed = interrupt::settle(&self.part, || fs::rename(&self.part, &self.path));
        // The lock ends here, after the renaming.
        self.file = None;
        renamed.map_err(|e| {
            drop(fs::remove_file(&self.part));
            broken(&self.path, &e)
        })
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        if self.file.is_some() {
            drop(interrupt::settle(&self.part, || {
                fs::remove_file(&self.part)
            }));
        }
    }
}

/// A failure to write this file.
pub(crate) fn broken(path: &Path, error: &io::Error) -> OutputError {
    OutputError(format!(
        "{} cannot be written ({error}): check space and permissions",
        path.display()
    ))
}

/// An error if the file exists and must not be replaced.
pub(crate) fn refuse_existing(path: &Path, force: bool) -> Result<(), OutputError> {
    if force || fs::symlink_metadata(path).is_err() {
        return Ok(());
    }
    Err(OutputError(format!(
        "{} exists: use --force to replace it",
        path.display()
    )))
}

/// Opens the temporary file, empty and locked.
fn open_part(part: &Path, path: &Path) -> Result<File, OutputError> {
    let taken = || {
        OutputError(format!(
            "{} is being written by another run: wait for it",
            path.display()
        ))
    };
    let mut options = OpenOptions::new();
    options.create(true).truncate(false).write(true);
    let file = options.open(part).map_err(|e| broken(path, &e))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => return Err(taken()),
        // Some file systems know no locks.
        Ok(()) | Err(TryLockError::Error(_)) => {}
    }
    // Between opening and locking, another run may have given the file its final name.
    if !part.exists() {
        return Err(taken());
    }
    file.set_len(0).map_err(|e| broken(path, &e))?;
    Ok(file)
}

fn part_of(path: &Path) -> Result<PathBuf, OutputError> {
    let Some(name) = path.file_name() else {
        return Err(OutputError(format!(
            "{} names no file: give a file's name",
            path.display()
        )));
    };
    let mut part = OsString::from(".");
    part.push(name);
    part.push(".neurotess-part");
    Ok(path.with_file_name(part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn files_appear_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("sub/cell.ply");
        let mut output = Output::create(&path, false).expect("begun");
        output.file().write_all(b"half").expect("written");
        assert!(Output::create(&path, false).is_err(), "locked");
        drop(output);
        assert_eq!(
            fs::read_dir(folder.path().join("sub"))
                .expect("read")
                .count(),
            0
        );

        let mut output = Output::create(&path, false).expect("begun");
        output.file().write_all(b"whole").expect("written");
        output.finish().expect("finished");
        assert_eq!(fs::read(&path).expect("there"), b"whole");
        assert!(Output::create(&path, false).is_err());
        assert!(Output::create(&path, true).is_ok());
        assert_eq!(fs::read(&path).expect("still there"), b"whole");
    }

    #[test]
    fn leavings_of_a_killed_run_are_used_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("cell.ply");
        fs::write(
            folder.path().join(".cell.ply.neurotess-part"),
            "long leavings",
        )
        .expect("made");
        let mut output = Output::create(&path, false).expect("begun");
        output.file().write_all(b"new").expect("written");
        output.finish().expect("finished");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        assert_eq!(fs::read_dir(folder.path()).expect("read").count(), 1);
    }
}
