//! What pictures took, and what they show.

use std::collections::BTreeMap;

use serde::Serialize;

/// The time and memory that a picture took.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Cost {
    /// Milliseconds from the first command to the last byte.
    pub(crate) cpu_ms: f64,
    /// Milliseconds by pass, if a GPU drew and supports timestamps.
    pub(crate) gpu_ms: Option<Vec<(&'static str, f64)>>,
    /// Number of tiles, or of the processor's bands.
    pub(crate) tiles: usize,
    /// Bytes of what it is drawn into and finished in.
    pub(crate) target_bytes: u64,
}

/// What a picture draws, and what it holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct SourceStats {
    pub(crate) patches: u64,
    pub(crate) patches_drawn: u64,
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) levels: BTreeMap<u32, u64>,
    pub(crate) bytes: BTreeMap<&'static str, u64>,
    pub(crate) bytes_per_point: f64,
    pub(crate) exploration: Option<BudgetStats>,
    /// Synapses and points that are drawn, those in view, and all.
    pub(crate) markers: Option<[usize; 3]>,
    /// Meshes that are no cells, and their triangles.
    pub(crate) meshes: Option<[u64; 2]>,
}

/// What `--lod exploration` drew and what it left out, in triangles.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct BudgetStats {
    pub(crate) budget: u64,
    pub(crate) wanted: u64,
    /// Left out, or drawn more coarsely than within half a pixel.
    pub(crate) left_out: u64,
    /// Whether `wanted` and `left_out` may be more: in the largest scenes, not everything is asked.
    pub(crate) at_least: bool,
    pub(crate) neurons_in_picture: u64,
    /// If not all tracings fit the adapter's memory.
    pub(crate) streamed: Option<StreamStats>,
}

/// Tracings of which the adapter's memory does not hold all points at once.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct StreamStats {
    pub(crate) tracings: usize,
    /// Those that are there more finely than the others.
    pub(crate) finer: usize,
    /// Those that are there with all their points.
    pub(crate) whole: usize,
    /// Those that might show more finely than there is room for.
    pub(crate) coarser: usize,
    pub(crate) uploaded_bytes: u64,
}
