//! What is there already under a file's name.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::OutputError;

/// What is done with a file that is there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// It is replaced.
    Replace,
    /// It stays, with an error that says what to do.
    Refuse(&'static str),
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
pub(crate) fn target(path: &Path) -> Result<PathBuf, OutputError> {
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
