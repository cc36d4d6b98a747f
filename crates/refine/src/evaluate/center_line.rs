//! The center line between two tracing points.

use glam::Vec3;
use neurotess_mesh::Role;

use super::corner::{Corner, Jet};
use crate::Path;

/// The center line between two tracing points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CenterLine {
    from: Vec3,
    to: Vec3,
    way: Vec3,
    /// Of a curve: those at its ends.
    tangents: Option<(Vec3, Vec3)>,
}

impl CenterLine {
    pub(crate) fn new(a: &Corner, b: &Corner, path: Path) -> Self {
        Self {
            from: a.center,
            to: b.center,
            way: b.center - a.center,
            tangents: (path == Path::Hermite).then(|| hermite_tangents(a, b)),
        }
    }

    /// Lengths (µm) of its derivatives at both ends.
    pub(crate) fn speeds(&self) -> [f32; 2] {
        let (near, far) = self.tangents.unwrap_or((self.way, self.way));
        [near.length(), far.length()]
    }

    /// At y ∈ [0, 1].
    pub(crate) fn at(&self, y: f32) -> Jet {
        let Self { from, to, way, .. } = *self;
        let Some((m0, m1)) = self.tangents else {
            return Jet {
                position: from * (1.0 - y) + to * y,
                derivative: way,
            };
        };
        let (y2, y3) = (y * y, y * y * y);
        let position = from * (2.0 * y3 - 3.0 * y2 + 1.0)
            + m0 * (y3 - 2.0 * y2 + y)
            + to * (3.0 * y2 - 2.0 * y3)
            + m1 * (y3 - y2);
        let derivative = way * (6.0 * y - 6.0 * y2)
            + m0 * (3.0 * y2 - 4.0 * y + 1.0)
            + m1 * (3.0 * y2 - 2.0 * y);
        Jet {
            position,
            derivative,
        }
    }
}

/// Greatest distance by which the tangent at one end may bend the center line away from the
/// straight segment, in radii of the thinner end.
///
/// With its full tangents, a thin neurite with long segments would sway by many times its radius,
/// away from the cones that were traced and into its neighbors. Chosen from 0.1, 0.12, 0.25, 0.5
/// and no limit with the example `fidelity`: the largest that keeps the median distance to the
/// traced cones under 0.05 of the median radius on every real cell (no limit: 0.25 on Cha-F-700113,
/// 0.20 on IF4_140201). The price is visible corners on thin axons with long segments.
pub(crate) const MAX_SWAY: f32 = 0.12;

/// Tangents of the center line: the directions at its ends times the segment's length, so that it
/// makes no loops, shortened where it would sway too far. At a joint the segment itself, since the
/// tubes there have no common direction.
///
/// A tangent bends a cubic away from the segment by at most 4/27 of the tangent's part across the
/// segment.
pub(crate) fn hermite_tangents(a: &Corner, b: &Corner) -> (Vec3, Vec3) {
    let way = b.center - a.center;
    let length = way.length();
    let direction = way / length.max(f32::MIN_POSITIVE);
    let most = MAX_SWAY * a.radius.min(b.radius) * (27.0 / 4.0);
    let tangent = |corner: &Corner| {
        if corner.role == Role::Joint {
            return way;
        }
        let across = corner.tangent - direction * corner.tangent.dot(direction);
        let sway = across.length() * length;
        corner.tangent * (length * (most / sway.max(most)))
    };
    (tangent(a), tangent(b))
}
