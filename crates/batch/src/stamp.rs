//! By what a file is known again.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use neurotess_formats as formats;
use serde::{Deserialize, Serialize};

use crate::targets::Job;

/// Length and time, by which a file is distinguished from another one of the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Stamp {
    bytes: u64,
    /// Nanoseconds since 1970.
    pub(crate) modified: u64,
}

impl Stamp {
    /// None if there is no such file.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        fs::metadata(path).ok().and_then(|data| Self::new(&data))
    }

    /// Of each file that an output is made of, in the order of the job; none if one is missing.
    pub(crate) fn of_inputs(job: &Job) -> Option<Vec<Self>> {
        let first = formats::file_of(&job.input);
        let further = job.further.iter().map(PathBuf::as_path);
        std::iter::once(&*first)
            .chain(further)
            .map(Self::of)
            .collect()
    }

    /// Of several files as one: all bytes, and the latest time. None if one is missing.
    pub(crate) fn of_all(paths: &[PathBuf]) -> Option<Self> {
        let none = Self {
            bytes: 0,
            modified: 0,
        };
        paths.iter().try_fold(none, |all, path| {
            let one = Self::of(path)?;
            Some(Self {
                bytes: all.bytes + one.bytes,
                modified: all.modified.max(one.modified),
            })
        })
    }

    fn new(data: &fs::Metadata) -> Option<Self> {
        let since = data.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        Some(Self {
            bytes: data.len(),
            modified: u64::try_from(since.as_nanos()).ok()?,
        })
    }
}
