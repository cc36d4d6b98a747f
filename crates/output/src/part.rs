//! Temporary files. All that this program is writing are known here, so that they can be removed.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::OutputError;
use crate::own::open_own;

static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

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
pub(crate) fn settle(part: &Path, end: impl FnOnce() -> io::Result<()>) -> io::Result<()> {
    let mut unfinished = lock();
    let ended = end();
    unfinished.remove(part);
    ended
}

pub(crate) fn lock() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Opens the temporary file, empty and locked.
pub(crate) fn open_part(part: &Path, path: &Path) -> Result<File, OutputError> {
    let taken = || OutputError::Taken { path: path.into() };
    let broken = |e| OutputError::broken(path, e);
    // Whatever else has this name is not ours.
    let opened = open_own(part, OpenOptions::new().write(true));
    let file = opened.map_err(|e| match e {
        OutputError::Broken { source, .. } => broken(source),
        // Another run has given the file its final name meanwhile, or removed it.
        OutputError::NotOurs {
            what: "being replaced",
            ..
        } => taken(),
        other => other,
    })?;
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

pub(crate) fn part_of(path: &Path) -> Result<PathBuf, OutputError> {
    let name = path
        .file_name()
        .ok_or_else(|| OutputError::Nameless { path: path.into() })?;
    let mut part = OsString::from(".");
    part.push(name);
    part.push(".neurotess-part");
    Ok(path.with_file_name(part))
}
