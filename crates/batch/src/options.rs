//! All that a cell's mesh and its files depend on.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use neurotess_formats::ReadOptions;
use neurotess_output::Existing;
use neurotess_recipe::{FileOptions, MeshOptions};

use crate::tables::Tables;

/// All that a cell's mesh and its files depend on.
#[derive(Clone, Debug)]
pub(crate) struct CellOptions {
    pub(crate) read: ReadOptions,
    pub(crate) mesh: MeshOptions,
    pub(crate) files: FileOptions,
    pub(crate) tables: Tables,
    /// What becomes of files that are there.
    pub(crate) existing: Existing,
    /// Whether volume and area are measured, which takes a pass over the surface.
    pub(crate) measures: bool,
    /// Set by another thread that asks to stop.
    pub(crate) stopped: Arc<AtomicBool>,
}

impl CellOptions {
    /// Whether another thread asked to stop.
    pub(crate) fn is_stopped(&self) -> bool {
        // Nothing else is read by it: a moment later is as good.
        self.stopped.load(Ordering::Relaxed)
    }
}
