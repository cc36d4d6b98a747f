//! Where a window keeps what is not saved, in case that it ends without asking.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::model::session;

/// Most windows that are open at once and keep what is not saved.
const WINDOWS: usize = 64;

/// A window's own file. The first window has the first one, and so on: what a window has left behind is found by the
/// next one that takes its place. A lock, which ends with the program however that ends, tells whether it is taken.
#[derive(Debug)]
pub(crate) struct Slot {
    file: PathBuf,
    /// Locked as long as it is open.
    _lock: File,
}

impl Slot {
    /// The first free one in a folder; none if the folder cannot be written to.
    pub(crate) fn take(folder: &Path) -> Option<Self> {
        fs::create_dir_all(folder).ok()?;
        (0..WINDOWS).find_map(|number| {
            let lock = folder.join(format!("unsaved-{number}.lock"));
            let lock = File::options()
                .create(true)
                .truncate(false)
                .write(true)
                .open(lock)
                .ok()?;
            lock.try_lock().ok()?;
            Some(Self {
                file: folder.join(format!("unsaved-{number}.{}", session::EXTENSION)),
                _lock: lock,
            })
        })
    }

    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// When it was written, if it is there.
    pub(crate) fn written(&self) -> Option<SystemTime> {
        fs::metadata(&self.file).ok()?.modified().ok()
    }

    pub(crate) fn clear(&self) {
        // It is not there, or another window will offer it.
        drop(fs::remove_file(&self.file));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_window_has_its_own_and_finds_what_one_before_left() {
        let folder = tempfile::tempdir().expect("a folder");
        let take = || Slot::take(folder.path()).expect("a free one");
        let (first, second) = (take(), take());
        assert_ne!(first.file(), second.file());
        fs::write(first.file(), "left").expect("written");
        assert!(second.written().is_none());
        drop(first);
        let next = take();
        assert!(next.written().is_some());
        next.clear();
        assert!(next.written().is_none());
    }
}
