//! The level of an edge from the edge alone: 1 to 64, along neurites by length 1 to 256.
//!
//! A level depends on the edge's two corners and their tracing points alone, and not on their
//! order, so the two faces beside the edge always agree: no cracks for any choice of levels.

use glam::Vec3;

use crate::evaluate::{
    CenterLine, Corner, EdgeCurve, EdgeKind, Profile, hermite_tangents, loft_controls,
    soma_controls,
};
use crate::{EdgeRule, Lod, LodCriterion, LodView, Path};

/// Highest level.
pub const HIGHEST_LEVEL: u32 = 64;

/// Highest level of edges along neurites that are cut by length: sparse tracings have segments of hundreds of
/// radii. It is bounded, so that thin paths of a careless tracing do not fill the memory.
pub const HIGHEST_LEVEL_BY_LENGTH: u32 = 256;

/// The share of the permitted error that each direction of a patch may take, around and along; the
/// rest is for the error of flat triangles on a twisted quad. Checked by `adaptive_error_is_kept`.
pub(crate) const SHARE: f32 = 0.3;

/// Subtracted before a level is rounded up. Two devices that compute a level from the same numbers
/// differ by a few 10⁻⁷ of it; geometry made of round numbers gives exactly whole levels, where the
/// last bit would decide. A level that is too low by this much adds 10⁻⁴ of the error.
pub(crate) const SLACK: f32 = 1e-4;

/// Greatest tan(θ/2) of the angle θ between two corners that a level is computed for: tan 1.3.
pub(crate) const STEEPEST: f32 = 3.6;

/// Level of an edge between tracing points `ta` and `tb`.
pub(crate) fn edge_level(
    lod: &Lod<'_>,
    path: Path,
    kind: EdgeKind,
    (a, ta): (&Corner, u32),
    (b, tb): (&Corner, u32),
) -> u32 {
    if let Some(rule) = lod.edges {
        return by_rule(rule, path, kind, a, b);
    }
    let level = match lod.criterion {
        LodCriterion::Homogeneous(level) => level,
        LodCriterion::PerPoint => {
            let of = |t: u32| {
                lod.point_levels
                    .get(t as usize)
                    .copied()
                    .map_or(1, u32::from)
            };
            of(ta).max(of(tb))
        }
        LodCriterion::MaxError(error) => by_error(error.max(1e-6) * SHARE, path, kind, a, b),
        LodCriterion::Distance { level, far } => by_distance(&lod.view, level, far, a, b),
        LodCriterion::PixelSize(pixels) => {
            let size = pixels * um_per_pixel(&lod.view, a, b);
            round_up((b.position - a.position).length() / size)
        }
        LodCriterion::PixelError(pixels) => by_error(
            pixels * um_per_pixel(&lod.view, a, b) * SHARE,
            path,
            kind,
            a,
            b,
        ),
    };
    level.clamp(1, HIGHEST_LEVEL)
}

/// Times as thick as the thinner end of a piece of a neurite that the thicker one counts: pieces that the thinner one likes
/// would be slivers at the thicker one, hundreds of them.
const TAPERED: f32 = 4.0;

/// The level that a rule gives an edge, within its bounds; see [`EdgeRule`].
fn by_rule(rule: EdgeRule, path: Path, kind: EdgeKind, a: &Corner, b: &Corner) -> u32 {
    let lengthwise = matches!(kind, EdgeKind::Along | EdgeKind::Loft);
    match rule {
        EdgeRule::Levels { around, along } => {
            let level = if lengthwise { along } else { around };
            level.clamp(1, HIGHEST_LEVEL)
        }
        EdgeRule::Lengths {
            radii,
            aspect,
            least,
            most,
        } => {
            // The greatest length counts even where it is below the least.
            let pieces = |length: f32, wanted: f32| length / wanted.max(least).min(most);
            let (thin, thick) = (a.radius.min(b.radius), a.radius.max(b.radius));
            let piece = match lengthwise {
                true => radii * thin.max(thick / TAPERED),
                false => radii * thin,
            };
            let level = pieces(edge_length(kind, a, b), piece).round();
            let (level, highest) = match lengthwise {
                // Hardly a piece longer than it may be, and no more of them than without that.
                true => {
                    let fewest = pieces(longest_length(path, kind, a, b), piece * aspect).ceil();
                    (level.min(fewest), HIGHEST_LEVEL_BY_LENGTH)
                }
                false => (level, HIGHEST_LEVEL),
            };
            // Also where it is not a number.
            if level < highest as f32 {
                level.max(1.0) as u32
            } else {
                highest
            }
        }
    }
}

/// Length of an edge (µm), about: that of an arc around a ring, else that of the chord.
fn edge_length(kind: EdgeKind, a: &Corner, b: &Corner) -> f32 {
    if kind == EdgeKind::Ring {
        let radius = 0.5 * (a.offset.length() + b.offset.length());
        return radius * a.radial.angle_between(b.radial);
    }
    (b.position - a.position).length()
}

/// Length (µm) of an edge if all its pieces were about as long as the longest. A curve goes faster at some parameters
/// than at others, as at the outer side of a bend. So this is midway between its length (by Boole's rule) and
/// its greatest speed: by the length alone, one triangle in a hundred is narrower than 13.5° in noisy tracings;
/// by the speed alone those have a quarter more triangles.
fn longest_length(path: Path, kind: EdgeKind, a: &Corner, b: &Corner) -> f32 {
    let curve = EdgeCurve::new(kind, a, b, path);
    let speeds = [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| curve.at(t).derivative.length());
    let [start, early, middle, late, end] = speeds;
    let length = (7.0 * (start + end) + 32.0 * (early + late) + 12.0 * middle) / 90.0;
    let greatest = speeds.into_iter().fold(0.0, f32::max);
    0.5 * (length + greatest)
}

/// A curve with a second derivative of at most M, cut into n parts, is at most M / (8 n²) from its
/// chords.
fn by_error(error: f32, path: Path, kind: EdgeKind, a: &Corner, b: &Corner) -> u32 {
    round_up((bend(path, kind, a, b) / (8.0 * error)).sqrt())
}

/// Bound of the second derivative of an edge (µm).
pub(crate) fn bend(path: Path, kind: EdgeKind, a: &Corner, b: &Corner) -> f32 {
    match kind {
        EdgeKind::Ring => turning(a, b),
        EdgeKind::Along => center_bend(a, b, path) + turning(a, b) + widening(a, b, path),
        EdgeKind::Soma => cubic_bend(soma_controls(a, b)),
        EdgeKind::Loft => cubic_bend(loft_controls(a, b)),
    }
}

fn cubic_bend([p0, p1, p2, p3]: [Vec3; 4]) -> f32 {
    let second = |p: Vec3, q: Vec3, r: Vec3| (p - q * 2.0 + r).length() * 6.0;
    second(p0, p1, p2).max(second(p1, p2, p3))
}

/// The importance of García-Cantero et al. 2017, as the mean of the two ends.
fn by_distance(view: &LodView, level: u32, far: f32, a: &Corner, b: &Corner) -> u32 {
    let importance = |k: &Corner| (1.0 - (k.center - view.eye).length() / far).clamp(0.0, 1.0);
    (level as f32 * 0.5 * (importance(a) + importance(b)) + 0.5) as u32
}

/// Size (µm) of a pixel at the nearer end of an edge.
fn um_per_pixel(view: &LodView, a: &Corner, b: &Corner) -> f32 {
    let depth = |k: &Corner| view.forward.dot(k.center - view.eye) - k.offset.length();
    let nearer = depth(a).min(depth(b)).max(view.near);
    view.slope * nearer + view.flat
}

fn round_up(cuts: f32) -> u32 {
    // Written so that NaN gives the highest level.
    if cuts < HIGHEST_LEVEL as f32 {
        (cuts - SLACK).ceil().max(1.0) as u32
    } else {
        HIGHEST_LEVEL
    }
}

/// Bound of the second derivative of the offset as it turns from one corner to the other: the
/// normalized mixture of two directions θ apart turns by at most 2 tan(θ/2) per unit.
fn turning(a: &Corner, b: &Corner) -> f32 {
    let (ra, rb) = (a.offset.length(), b.offset.length());
    let speed = speed(a, b);
    ra.max(rb) * speed * speed + 2.0 * (ra - rb).abs() * speed
}

/// Greatest speed (radians) of the normalized mixture of two corners' radials.
fn speed(a: &Corner, b: &Corner) -> f32 {
    // tan(θ/2) of unit vectors without the arc cosine, which is inaccurate on GPUs.
    let (apart, together) = (
        (a.radial - b.radial).length(),
        (a.radial + b.radial).length(),
    );
    2.0 * (apart / together.max(1e-6)).min(STEEPEST)
}

/// Bound of what the second derivative of the offset is more where the radius is no straight line.
fn widening(a: &Corner, b: &Corner, path: Path) -> f32 {
    let profile = Profile::new(a, b, &CenterLine::new(a, b, path));
    let radii = |k: &Corner| k.offset.length() / k.radius.max(f32::MIN_POSITIVE);
    let steeper = profile.steepest() - (b.radius - a.radius).abs();
    radii(a).max(radii(b)) * (profile.bend() + 2.0 * steeper * speed(a, b))
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
