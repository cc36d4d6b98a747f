//! `--log`: one JSON line per cell as it finishes.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::Context;
use serde::{Deserialize, Serialize};

use super::failure::Failure;

/// A file that lines are appended to, each before its mesh gets its name: a run that is killed
/// between the two leaves a line too many, never one too few. Each line is one write, so that it is
/// whole even if several runs share the file or one is killed.
pub(crate) struct Log {
    path: PathBuf,
    file: Mutex<File>,
    /// Outputs that had a line when the log was opened.
    known: BTreeSet<String>,
}

/// The fields of a line that are read.
#[derive(Deserialize)]
struct Line {
    out: String,
}

impl Log {
    /// Opens the file, or creates it.
    pub(crate) fn open(path: &Path) -> anyhow::Result<Self> {
        let before = match fs::metadata(path) {
            Ok(data) if data.is_file() => fs::read(path).unwrap_or_default(),
            _ => Vec::new(),
        };
        let lines = before.split(|&byte| byte == b'\n');
        let known = lines.filter_map(|line| serde_json::from_slice::<Line>(line).ok());
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
            known: known.map(|line| line.out).collect(),
        })
    }

    /// Whether an output had a line when the log was opened.
    pub(crate) fn knows(&self, out: &str) -> bool {
        self.known.contains(out)
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
