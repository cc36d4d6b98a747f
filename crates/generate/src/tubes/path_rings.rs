//! A path as it becomes rings.

use glam::DVec3;

use crate::plan::RoundCone;

/// Segments of the trunk to either side that an inset stands over.
const TRUNK_SEGMENTS: usize = 3;

/// A path as it becomes rings.
pub(super) struct PathRings {
    pub(super) nodes: Vec<u32>,
    pub(super) centers: Vec<DVec3>,
    pub(super) radii: Vec<f64>,
    pub(super) tangents: Vec<DVec3>,
    pub(super) frames: Vec<DVec3>,
}

impl PathRings {
    /// Angle of a direction about a ring, from its frame on.
    pub(super) fn angle(&self, ring: usize, direction: DVec3) -> f64 {
        let side = self.tangents[ring].cross(self.frames[ring]);
        f64::atan2(direction.dot(side), direction.dot(self.frames[ring]))
    }

    /// Unit direction to the next ring.
    pub(super) fn chord(&self, ring: usize) -> DVec3 {
        let way = self.centers[ring + 1] - self.centers[ring];
        way.try_normalize().unwrap_or(self.tangents[ring])
    }

    /// Cones of the segments around one of them.
    pub(super) fn cones(&self, segment: usize) -> Vec<RoundCone> {
        let first = segment.saturating_sub(TRUNK_SEGMENTS);
        let end = (segment + TRUNK_SEGMENTS + 1).min(self.centers.len() - 1);
        RoundCone::along(&self.centers, &self.radii, first..end)
    }
}
