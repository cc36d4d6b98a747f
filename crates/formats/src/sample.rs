//! What readers of several formats take for a traced point.

use glam::DVec3;

/// A point with its radius (µm) and where the file has it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) position: DVec3,
    pub(crate) radius: f64,
    /// Line, or row of a dataset; from 1 on.
    pub(crate) line: u64,
}
