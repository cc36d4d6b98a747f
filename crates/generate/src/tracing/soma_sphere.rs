//! A soma as its neurites meet it.

use glam::DVec3;

/// A soma's sphere as the neurites meet it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SomaSphere {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// Farthest distance of a first ring, in radii.
    pub(crate) reach: f64,
}
