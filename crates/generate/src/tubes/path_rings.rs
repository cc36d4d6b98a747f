//! A path as it becomes rings.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::taper::{Straight, taper};
use crate::plan::{Path, RingKind, RoundCone};

/// Segments of the trunk to either side that an inset stands over.
const TRUNK_SEGMENTS: usize = 3;

/// The inner corner of a ring at a bend.
pub(super) struct Crease {
    pub(super) corner: usize,
    /// From where the corner would be on a circle (radians), at most 45° either way.
    pub(super) angle: f64,
    /// From the center, in radii.
    pub(super) offset: DVec3,
}

/// A path with the frames of its rings.
pub(super) struct PathRings<'a> {
    pub(super) path: &'a Path,
    /// As planned, but for insets: where these are.
    pub(super) centers: Vec<DVec3>,
    pub(super) radii: Vec<f64>,
    pub(super) tangents: Vec<DVec3>,
    pub(super) frames: Vec<DVec3>,
}

impl PathRings<'_> {
    /// Index of the last ring.
    pub(super) fn last(&self) -> usize {
        self.path.last()
    }

    /// Angle of a direction about a ring, from its frame on.
    pub(super) fn angle(&self, ring: usize, direction: DVec3) -> f64 {
        let side = self.tangents[ring].cross(self.frames[ring]);
        f64::atan2(direction.dot(side), direction.dot(self.frames[ring]))
    }

    /// At a bend: the corner of the ring that is nearest to the inner side, and the angle of that side.
    pub(super) fn crease(&self, ring: usize) -> Option<Crease> {
        let offset = self.path.rings[ring].crease?;
        let angle = self.angle(ring, offset);
        let quarter = (angle / FRAC_PI_2).round();
        Some(Crease {
            corner: (quarter as i32).rem_euclid(4) as usize,
            angle: angle - quarter * FRAC_PI_2,
            offset,
        })
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

    /// Change of the radius along the path at a ring (µm per µm); 0 at an end, where the tube goes over into its cap.
    pub(super) fn taper(&self, ring: usize) -> f64 {
        if ring == 0 || ring == self.last() {
            return 0.0;
        }
        let length = |i: usize| self.centers[i].distance(self.centers[i + 1]);
        let radii = [ring - 1, ring, ring + 1].map(|i| self.radii[i]);
        // Between the rings of a zone the trunk stays a cone: bulging, it would cross the branches that leave there.
        let straight = match self.path.rings[ring].kind {
            RingKind::Zone {
                begins: Some(_),
                ends: None,
            } => Straight::After,
            RingKind::Zone {
                begins: None,
                ends: Some(_),
            } => Straight::Before,
            _ => Straight::Across,
        };
        taper(radii, [length(ring - 1), length(ring)], straight)
    }

    /// Where on the way from the ring before a ring's section begins: see [`TracingPoint::border`].
    ///
    /// [`TracingPoint::border`]: neurotess_mesh::TracingPoint::border
    pub(super) fn border(&self, ring: usize) -> i8 {
        // What leads from a joint to a ring is all the ring's.
        if ring == 0 || ring == 1 && self.path.start.is_joint() {
            return 0;
        }
        let [before, own] = [ring - 1, ring].map(|ring| &self.path.rings[ring]);
        let [first, second] = [before, own].map(|ring| ring.label.section);
        if first == second {
            return 0;
        }
        // Of several forks the first: what comes after it hangs on the section after it.
        let changes = self.path.changes.iter();
        let change = changes.copied().find(|&change| change >= before.arc);
        let way = own.arc - before.arc;
        let share = match change {
            Some(change) if way > 0.0 => (change - before.arc) / way,
            _ => 0.5,
        };
        let steps = (16.0 * share).round().clamp(1.0, 15.0) as i8;
        if second < first { -steps } else { steps }
    }
}
