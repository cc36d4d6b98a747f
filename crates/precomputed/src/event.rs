//! What is told while a folder is written, and what became of it.

use std::collections::BTreeMap;
use std::path::Path;

use neurotess_batch::NotFound;
use neurotess_formats::Warning;

use crate::error::Failure;

/// What happens while a folder is written.
#[non_exhaustive]
pub enum Event<'e> {
    /// So many cells are to be written, and so many are there already.
    Planned {
        /// Cells that are to be written.
        to_do: usize,
        /// Cells whose files are there.
        kept: usize,
    },
    /// A cell was written; told by any thread.
    Written(&'e CellDone),
    /// A tracing was read with warnings, told once.
    Warned {
        /// The tracing.
        file: &'e Path,
        /// What is odd about it.
        warnings: &'e [Warning],
    },
    /// A tracing was not, the first time that it is needed.
    Failed(&'e Failure),
}

/// A cell that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellDone {
    /// What it is called.
    pub label: String,
    /// Its segment.
    pub id: u64,
    /// Triangles of all its levels.
    pub triangles: usize,
    /// Bytes of its mesh and its skeleton.
    pub bytes: u64,
}

/// What became of a folder.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ExportReport {
    /// Cells that were written.
    pub written: usize,
    /// Cells that were there already.
    pub kept: usize,
    /// Triangles of those that were written.
    pub triangles: u64,
    /// Bytes of those that were written.
    pub bytes: u64,
    /// Synapses that were written.
    pub synapses: usize,
    /// Tracings that were not written.
    pub failures: Vec<Failure>,
    /// How many of the tracings that were meshed have a warning of each code.
    pub warnings: BTreeMap<&'static str, usize>,
    /// Inputs without any file.
    pub not_found: Vec<NotFound>,
    /// Opens the cells in the public client; empty of a part that does not write what all cells share.
    pub link: String,
    /// Whether another thread ended it.
    pub stopped: bool,
}
