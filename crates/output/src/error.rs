//! Why a file could not be written.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

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
    /// Where a file of ours is to be there is something else, which is not written to.
    #[error("{} is {what}, not a file of neurotess: remove it", .path.display())]
    NotOurs { path: PathBuf, what: &'static str },
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
