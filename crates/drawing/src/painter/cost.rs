//! What pictures took, and what they show.

use std::collections::BTreeMap;

use serde::Serialize;

/// The time and memory that a picture took.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cost {
    /// Milliseconds from the first command to the last byte.
    pub cpu_ms: f64,
    /// Milliseconds by pass, if a GPU drew and supports timestamps.
    pub gpu_ms: Option<Vec<(&'static str, f64)>>,
    /// Number of tiles, or of the processor's bands.
    pub tiles: usize,
    /// Bytes of what it is drawn into and finished in.
    pub target_bytes: u64,
}

/// What a picture draws, and what it holds.
#[derive(Clone, Debug, Default)]
pub struct SourceStats {
    /// Coarse patches of all instances.
    pub patches: u64,
    /// Those that are drawn.
    pub patches_drawn: u64,
    /// Vertices that are drawn.
    pub vertices: u64,
    /// Triangles that are drawn.
    pub triangles: u64,
    /// Sides of patches by level.
    pub levels: BTreeMap<u32, u64>,
    /// Bytes that are held, by what they are.
    pub bytes: BTreeMap<&'static str, u64>,
    /// Bytes of a tracing point.
    pub bytes_per_point: f64,
    /// Of exploration: what it drew.
    pub exploration: Option<BudgetStats>,
    /// Synapses and points that are drawn, those in view, and all.
    pub markers: Option<[usize; 3]>,
    /// Meshes that are no cells, and their triangles.
    pub meshes: Option<[u64; 2]>,
}

/// What `--lod exploration` drew and what it left out, in triangles.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BudgetStats {
    /// Most triangles.
    pub budget: u64,
    /// Triangles that would show.
    pub wanted: u64,
    /// Left out, or drawn more coarsely than within half a pixel.
    pub left_out: u64,
    /// Whether `wanted` and `left_out` may be more: in the largest scenes, not everything is asked.
    pub at_least: bool,
    /// Neurons in view.
    pub neurons_in_picture: u64,
    /// If not all tracings fit the adapter's memory.
    pub streamed: Option<StreamStats>,
}

/// Tracings of which the adapter's memory does not hold all points at once.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StreamStats {
    /// Distinct tracings.
    pub tracings: usize,
    /// Those that are there more finely than the others.
    pub finer: usize,
    /// Those that are there with all their points.
    pub whole: usize,
    /// Those that might show more finely than there is room for.
    pub coarser: usize,
    /// Bytes that were uploaded.
    pub uploaded_bytes: u64,
}
