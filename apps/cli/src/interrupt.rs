//! Interrupted: no half-written file, exit code 130, at once.
//!
//! **Why not** a flag that everything polls: a long read or solve would answer late. Instead every
//! temporary file is known here, and no file gets its final name but under the same lock; whoever
//! holds the lock may remove them all and leave.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static TEMPORARY: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Exit code of an interrupted run.
const INTERRUPTED: i32 = 130;

/// From now on, Ctrl-C and requests to end remove what is half written and leave.
pub(crate) fn watch() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        let temporary = lock();
        for path in temporary.iter() {
            drop(fs::remove_file(path));
        }
        // Still under the lock: no file is made or renamed any more.
        std::process::exit(INTERRUPTED);
    })
}

/// Makes a file that an interruption removes.
pub(crate) fn make<T, E>(path: &Path, open: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    let mut temporary = lock();
    let made = open()?;
    temporary.insert(path.to_path_buf());
    Ok(made)
}

/// Ends the file's time as a temporary one, by renaming or removing it.
pub(crate) fn settle<T>(path: &Path, end: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
    let mut temporary = lock();
    let ended = end();
    temporary.remove(path);
    ended
}

fn lock() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}
