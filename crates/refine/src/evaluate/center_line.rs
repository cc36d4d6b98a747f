//! The center lines between two tracing points each.

use neurotess_mesh::Role;

use super::corner::{Corners, Jets};
use super::four::{F32x4, Vec3x4};
use crate::Path;

/// Four center lines, each between two tracing points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CenterLines {
    from: Vec3x4,
    to: Vec3x4,
    way: Vec3x4,
    /// Of curves: those at their ends.
    tangents: Option<(Vec3x4, Vec3x4)>,
}

impl CenterLines {
    #[inline(always)]
    pub(crate) fn new(a: &Corners, b: &Corners, path: Path) -> Self {
        Self {
            from: a.center,
            to: b.center,
            way: b.center - a.center,
            tangents: (path == Path::Hermite).then(|| hermite_tangents(a, b)),
        }
    }

    /// Lengths (µm) of their derivatives at both ends.
    pub(crate) fn speeds(&self) -> [F32x4; 2] {
        let (near, far) = self.tangents.unwrap_or((self.way, self.way));
        [near.length(), far.length()]
    }

    /// At y ∈ [0, 1].
    #[inline(always)]
    pub(crate) fn at(&self, y: F32x4) -> Jets {
        let Self { from, to, way, .. } = *self;
        let Some((m0, m1)) = self.tangents else {
            return Jets {
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
        Jets {
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

/// Tangents of center lines: the directions at their ends times the segment's length, so that they
/// make no loops, shortened where they would sway too far. At a joint the segment itself, since the
/// tubes there have no common direction.
///
/// A tangent bends a cubic away from the segment by at most 4/27 of the tangent's part across the
/// segment.
#[inline(always)]
pub(crate) fn hermite_tangents(a: &Corners, b: &Corners) -> (Vec3x4, Vec3x4) {
    let way = b.center - a.center;
    let length = way.length();
    let direction = way / length.max(F32x4::splat(f32::MIN_POSITIVE));
    let most = MAX_SWAY * a.radius.min(b.radius) * (27.0 / 4.0);
    let at_joint = |corner: &Corners| corner.has_role(Role::Joint);
    (
        Vec3x4::select(at_joint(a), way, tangent(a, length, direction, most)),
        Vec3x4::select(at_joint(b), way, tangent(b, length, direction, most)),
    )
}

/// `most`: greatest sway times 27/4.
#[inline(always)]
fn tangent(corner: &Corners, length: F32x4, direction: Vec3x4, most: F32x4) -> Vec3x4 {
    let across = corner.tangent - direction * corner.tangent.dot(direction);
    let sway = across.length() * length;
    corner.tangent * (length * (most / sway.max(most)))
}
