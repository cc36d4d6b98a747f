//! `--log`: one JSON line per cell as it finishes.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::Context;
use serde::Serialize;

use crate::report::Failure;

/// A file that lines are appended to. Each line is one write, so that it is whole even if several
/// runs share the file or one is killed.
pub(crate) struct Log {
    path: PathBuf,
    file: Mutex<File>,
}

impl Log {
    /// Opens the file, or makes it.
    pub(crate) fn open(path: &Path) -> anyhow::Result<Self> {
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.with_context(|| {
            format!(
                "{}: the log cannot be written: check the path",
                path.display()
            )
        })?;
        Ok(Self {
            path: path.to_path_buf(),
            file: Mutex::new(file),
        })
    }

    /// Appends one line.
    pub(crate) fn line(&self, value: &impl Serialize) -> Result<(), Failure> {
        let failed = |e: std::io::Error| {
            Failure(format!(
                "{}: the log cannot be written ({e}): check space and permissions",
                self.path.display()
            ))
        };
        let mut text = serde_json::to_vec(value).map_err(|e| failed(e.into()))?;
        text.push(b'\n');
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(&text).map_err(failed)
    }
}
