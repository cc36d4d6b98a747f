//! The level of an edge, 1 to 64, from what the edge itself knows.
//!
//! A level depends on the edge's two corners and their tracing points alone, and not on their
//! order, so the two faces beside the edge always agree: no cracks for any choice of levels.

use glam::Vec3;

use crate::evaluate::{Corner, EdgeKind, hermite_tangents, soma_controls};
use crate::{Levels, Path};

/// Highest level.
pub const HIGHEST_LEVEL: u32 = 64;

/// The share of the permitted error that one direction of a patch may take: around, along, and a
/// rest for what flat triangles lose on a twisted quad. Checked by `adaptive_error_is_kept`.
const SHARE: f32 = 0.3;

/// Level of an edge between tracing points `ta` and `tb`.
pub(crate) fn edge_level(
    levels: &Levels<'_>,
    path: Path,
    kind: EdgeKind,
    (a, ta): (&Corner, u32),
    (b, tb): (&Corner, u32),
) -> u32 {
    let level = match levels {
        Levels::Homogeneous(level) => *level,
        Levels::PerPoint(levels) => {
            let of = |t: u32| levels.get(t as usize).copied().map_or(1, u32::from);
            of(ta).max(of(tb))
        }
        Levels::MaxError(error) => by_error(error.max(1e-6) * SHARE, path, kind, a, b),
    };
    level.clamp(1, HIGHEST_LEVEL)
}

/// A curve of second derivative M, cut in n, is at most M / (8 n²) from its chords.
fn by_error(error: f32, path: Path, kind: EdgeKind, a: &Corner, b: &Corner) -> u32 {
    let bend = match kind {
        EdgeKind::Ring => turning(a, b),
        EdgeKind::Along => center_bend(a, b, path) + turning(a, b),
        EdgeKind::Soma => {
            let [p0, p1, p2, p3] = soma_controls(a, b);
            let second = |p: Vec3, q: Vec3, r: Vec3| (p - q * 2.0 + r).length() * 6.0;
            second(p0, p1, p2).max(second(p1, p2, p3))
        }
    };
    let cuts = (bend / (8.0 * error)).sqrt().ceil();
    if cuts.is_finite() {
        cuts as u32
    } else {
        HIGHEST_LEVEL
    }
}

/// Bound of the second derivative of the offset as it turns from one corner to the other: the
/// normalised mixture of two directions θ apart turns by at most 2 tan(θ/2) per unit.
fn turning(a: &Corner, b: &Corner) -> f32 {
    let (ra, rb) = (a.offset.length(), b.offset.length());
    let half = (0.5 * a.radial.angle_between(b.radial)).min(1.3);
    let speed = 2.0 * half.tan();
    ra.max(rb) * speed * speed + 2.0 * (ra - rb).abs() * speed
}

fn center_bend(a: &Corner, b: &Corner, path: Path) -> f32 {
    if path == Path::Linear {
        return 0.0;
    }
    let way = b.center - a.center;
    let (m0, m1) = hermite_tangents(a, b);
    let start = way * 6.0 - m0 * 4.0 - m1 * 2.0;
    let end = m0 * 2.0 + m1 * 4.0 - way * 6.0;
    start.length().max(end.length())
}
