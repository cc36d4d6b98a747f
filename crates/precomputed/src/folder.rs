//! The folder that is written: its files, and whether they are of this work.
//!
//! `neurotess.json` says of which cells and options the files are. It is written before any cell; so what is there in a
//! folder of the same plan is right, since files are there whole or not at all.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use neurotess_output::{Existing, Output, OutputError, write_into, write_whole};

use crate::error::ExportError;
use crate::shards::Sharding;

/// The file that says what the others are of.
const PLAN: &str = "neurotess.json";
/// Folders of cells.
const MESH: &str = "mesh";
const SKELETONS: &str = "skeletons";
/// Time between two looks at a file that another process writes, and looks.
const PATIENCE: Duration = Duration::from_millis(100);
const LOOKS: u32 = 100;

/// What becomes of a folder that is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Before {
    /// It stays, and nothing is written.
    Refuse,
    /// What is there of the same plan stays.
    Keep,
    /// It is written anew.
    Replace,
}

/// The folder.
#[derive(Clone, Debug)]
pub(crate) struct Folder {
    root: PathBuf,
    sharding: Option<Sharding>,
}

impl Folder {
    pub(crate) fn new(root: &Path, sharding: Option<Sharding>) -> Self {
        Self {
            root: root.to_path_buf(),
            sharding,
        }
    }

    /// Begins the work of a plan.
    pub(crate) fn begin(&self, plan: &str, before: Before) -> Result<(), ExportError> {
        let path = self.path(PLAN);
        // Looked for first: where another process has begun, its plan is there before all else.
        let has_files = self.has_files();
        let found = fs::read(&path).ok();
        let is_ours = found.is_some();
        let is_same = found.as_deref() == Some(plan.as_bytes());
        match before {
            Before::Keep if is_same => return Ok(()),
            Before::Keep if is_ours => return Err(ExportError::Other(self.root.clone())),
            _ if has_files && !is_ours => return Err(ExportError::Foreign(self.root.clone())),
            Before::Replace if is_ours => {
                // First a plan of nothing, so that a run that is killed leaves a folder that is ours, and not right.
                write_whole(&path, Existing::Replace, |to| to.write_all(b"{}\n"))?;
                self.clear()?;
            }
            _ if is_ours => return Err(ExportError::Exists(self.root.clone())),
            _ => {}
        }
        for _ in 0..LOOKS {
            match write_whole(&path, Existing::Replace, |to| to.write_all(plan.as_bytes())) {
                // Another process begins the same work.
                Err(OutputError::Taken { .. }) => std::thread::sleep(PATIENCE),
                written => return Ok(written?),
            }
        }
        Err(OutputError::Taken { path }.into())
    }

    /// Whether something is there that nobody hides.
    fn has_files(&self) -> bool {
        let mut entries = fs::read_dir(&self.root).into_iter().flatten().flatten();
        entries.any(|entry| !entry.file_name().as_encoded_bytes().starts_with(b"."))
    }

    /// Removes files of cells: those whose names are ids or shards.
    fn clear(&self) -> Result<(), OutputError> {
        for folder in [MESH, SKELETONS].map(|name| self.path(name)) {
            for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
                let name = entry.file_name().to_string_lossy().into_owned();
                let id = name.strip_suffix(".index").unwrap_or(&name);
                let is_id = id.bytes().all(|byte| byte.is_ascii_digit());
                if is_id || name.ends_with(".shard") {
                    let path = entry.path();
                    fs::remove_file(&path).map_err(|e| OutputError::broken(&path, e))?;
                }
            }
        }
        Ok(())
    }

    /// Writes a file that all cells share, unless it is there as it should be.
    pub(crate) fn shared(
        &self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<&mut fs::File>) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        write_whole(&self.path(name), Existing::Replace, write)
    }

    /// Whether all files of a cell, or of a shard, are there. None is empty, unless a disk lost what was in it.
    pub(crate) fn has(&self, unit: Files) -> bool {
        let is_whole =
            |path: &PathBuf| fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() > 0);
        self.files(unit).iter().all(is_whole)
    }

    /// Files of a cell, or of a shard: fragments or shard of meshes, manifest, skeleton.
    pub(crate) fn files(&self, unit: Files) -> Vec<PathBuf> {
        match (unit, self.sharding) {
            (Files::Shard(shard), Some(sharding)) => {
                let name = sharding.file_name(shard);
                [MESH, SKELETONS]
                    .map(|folder| self.path(folder).join(&name))
                    .to_vec()
            }
            (Files::Cell(number) | Files::Shard(number), _) => vec![
                self.path(MESH).join(number.to_string()),
                self.path(MESH).join(format!("{number}.index")),
                self.path(SKELETONS).join(number.to_string()),
            ],
        }
    }

    /// Begins a file of a cell or a shard.
    pub(crate) fn output(path: &Path) -> Result<Output, OutputError> {
        Output::create(path, Existing::Replace)
    }

    /// Writes a file of a cell.
    pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
        write_into(Self::output(path)?, path, |to| to.write_all(bytes))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }
}

/// Which files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Files {
    /// Of the cell with this id.
    Cell(u64),
    /// Of the shard with this number.
    Shard(u64),
}
