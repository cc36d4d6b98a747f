//! The level of an edge from the edge alone: 1 to 64, along neurites by length 1 to 256.
//!
//! A level depends on the edge's two corners and their tracing points alone, and not on their
//! order, so the two faces beside the edge always agree: no cracks for any choice of levels.

use neurotess_mesh::CoarseMesh;

use crate::edge::Edge;
use crate::evaluate::{
    CenterLines, Corners, EdgeCurves, EdgeKind, F32x4, Profiles, Vec3x4, hermite_tangents,
    loft_controls, soma_controls,
};
use crate::fours::four;
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

/// Levels of four edges of one kind.
pub(crate) fn edge_levels(
    mesh: &CoarseMesh,
    lod: &Lod<'_>,
    path: Path,
    edges: [&Edge; 4],
) -> [u32; 4] {
    // Each kind needs other things of corners.
    match edges[0].kind {
        EdgeKind::Ring => levels_of(mesh, lod, path, EdgeKind::Ring, edges),
        EdgeKind::Along => levels_of(mesh, lod, path, EdgeKind::Along, edges),
        kind => levels_of(mesh, lod, path, kind, edges),
    }
}

#[inline(always)]
fn levels_of(
    mesh: &CoarseMesh,
    lod: &Lod<'_>,
    path: Path,
    kind: EdgeKind,
    edges: [&Edge; 4],
) -> [u32; 4] {
    let ends = four(|k| edges[k].ends());
    if let Some(rule) = lod.edges {
        return by_rule(mesh, rule, path, kind, ends);
    }
    let levels = match lod.criterion {
        LodCriterion::Homogeneous(level) => [level; 4],
        LodCriterion::PerPoint => {
            let of = |vertex: u32| {
                let point = mesh.vertices[vertex as usize].tracing as usize;
                lod.point_levels.get(point).copied().map_or(1, u32::from)
            };
            ends.map(|[from, to]| of(from).max(of(to)))
        }
        LodCriterion::MaxError(error) => {
            let [a, b] = &Corners::of_edges(mesh, ends);
            by_error(F32x4::splat(error.max(1e-6) * SHARE), path, kind, a, b)
        }
        LodCriterion::Distance { level, far } => {
            let [a, b] = &Corners::of_edges(mesh, ends);
            by_distance(&lod.view, level, far, a, b)
        }
        LodCriterion::PixelSize(pixels) => {
            let [a, b] = &Corners::of_edges(mesh, ends);
            let size = pixels * um_per_pixel(&lod.view, a, b);
            round_up((b.position - a.position).length() / size)
        }
        LodCriterion::PixelError(pixels) => {
            let [a, b] = &Corners::of_edges(mesh, ends);
            let error = pixels * um_per_pixel(&lod.view, a, b) * SHARE;
            by_error(error, path, kind, a, b)
        }
    };
    levels.map(|level| level.clamp(1, HIGHEST_LEVEL))
}

/// Times as thick as the thinner end of a piece of a neurite that the thicker one counts: pieces that the thinner one likes
/// would be slivers at the thicker one, hundreds of them.
const TAPERED: f32 = 4.0;

/// The levels that a rule gives edges, within its bounds; see [`EdgeRule`].
fn by_rule(
    mesh: &CoarseMesh,
    rule: EdgeRule,
    path: Path,
    kind: EdgeKind,
    ends: [[u32; 2]; 4],
) -> [u32; 4] {
    let lengthwise = matches!(kind, EdgeKind::Along | EdgeKind::Loft);
    match rule {
        EdgeRule::Levels { around, along } => {
            let level = if lengthwise { along } else { around };
            [level.clamp(1, HIGHEST_LEVEL); 4]
        }
        EdgeRule::Lengths {
            radii,
            aspect,
            least,
            most,
        } => {
            let [a, b] = &Corners::of_edges(mesh, ends);
            // The greatest length counts even where it is below the least.
            let pieces = |length: F32x4, wanted: F32x4| {
                length / wanted.max(F32x4::splat(least)).min(F32x4::splat(most))
            };
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
            level.to_array().map(|level| {
                if level < highest as f32 {
                    level.max(1.0) as u32
                } else {
                    highest
                }
            })
        }
    }
}

/// Lengths of edges (µm), about: those of arcs around a ring, else those of the chords.
fn edge_length(kind: EdgeKind, a: &Corners, b: &Corners) -> F32x4 {
    if kind == EdgeKind::Ring {
        let radius = 0.5 * (a.offset.length() + b.offset.length());
        let (from, to) = (a.radial.each(), b.radial.each());
        return radius * F32x4::from_array(four(|k| from[k].angle_between(to[k])));
    }
    (b.position - a.position).length()
}

/// Lengths (µm) of edges if all their pieces were about as long as the longest. A curve goes faster at some parameters
/// than at others, as at the outer side of a bend. So this is midway between its length (by Boole's rule) and
/// its greatest speed: by the length alone, one triangle in a hundred is narrower than 13.5° in noisy tracings;
/// by the speed alone those have a quarter more triangles.
fn longest_length(path: Path, kind: EdgeKind, a: &Corners, b: &Corners) -> F32x4 {
    let curves = EdgeCurves::new(kind, a, b, path);
    let speeds =
        [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| curves.at(F32x4::splat(t)).derivative.length());
    let [start, early, middle, late, end] = speeds;
    let length = (7.0 * (start + end) + 32.0 * (early + late) + 12.0 * middle) / 90.0;
    let greatest = speeds
        .into_iter()
        .fold(F32x4::ZERO, |most, speed| speed.max(most));
    0.5 * (length + greatest)
}

/// A curve with a second derivative of at most M, cut into n parts, is at most M / (8 n²) from its
/// chords.
#[inline(always)]
fn by_error(error: F32x4, path: Path, kind: EdgeKind, a: &Corners, b: &Corners) -> [u32; 4] {
    round_up((bend(path, kind, a, b) / (8.0 * error)).sqrt())
}

/// Bounds of the second derivatives of edges (µm).
#[inline(always)]
pub(crate) fn bend(path: Path, kind: EdgeKind, a: &Corners, b: &Corners) -> F32x4 {
    match kind {
        EdgeKind::Ring => turning(a, b),
        EdgeKind::Along => center_bend(a, b, path) + turning(a, b) + widening(a, b, path),
        EdgeKind::Soma => cubic_bend(soma_controls(a, b)),
        EdgeKind::Loft => cubic_bend(loft_controls(a, b)),
    }
}

fn cubic_bend([p0, p1, p2, p3]: [Vec3x4; 4]) -> F32x4 {
    let second = |p: Vec3x4, q: Vec3x4, r: Vec3x4| (p - q * 2.0 + r).length() * 6.0;
    second(p0, p1, p2).max(second(p1, p2, p3))
}

/// The importance of García-Cantero et al. 2017, as the mean of the two ends.
fn by_distance(view: &LodView, level: u32, far: f32, a: &Corners, b: &Corners) -> [u32; 4] {
    let eye = Vec3x4::splat(view.eye);
    let importance = |k: &Corners| {
        let importance = (1.0 - (k.center - eye).length() / far).to_array();
        F32x4::from_array(importance.map(|of| of.clamp(0.0, 1.0)))
    };
    let levels = level as f32 * 0.5 * (importance(a) + importance(b)) + 0.5;
    levels.to_array().map(|level| level as u32)
}

/// Size (µm) of a pixel at the nearer end of each edge.
#[inline(always)]
fn um_per_pixel(view: &LodView, a: &Corners, b: &Corners) -> F32x4 {
    let [forward, eye] = [view.forward, view.eye].map(Vec3x4::splat);
    let depth = |k: &Corners| forward.dot(k.center - eye) - k.offset.length();
    let nearer = depth(a).min(depth(b)).max(F32x4::splat(view.near));
    view.slope * nearer + view.flat
}

#[inline(always)]
fn round_up(cuts: F32x4) -> [u32; 4] {
    cuts.to_array().map(|cuts| {
        // Written so that NaN gives the highest level.
        if cuts < HIGHEST_LEVEL as f32 {
            let cuts = (cuts - SLACK).max(1.0);
            // Some processors round up in a call of a function only.
            let whole = cuts as u32;
            whole + u32::from(cuts > whole as f32)
        } else {
            HIGHEST_LEVEL
        }
    })
}

/// Bound of the second derivative of the offset as it turns from one corner to the other: the
/// normalized mixture of two directions θ apart turns by at most 2 tan(θ/2) per unit.
#[inline(always)]
fn turning(a: &Corners, b: &Corners) -> F32x4 {
    let (ra, rb) = (a.offset.length(), b.offset.length());
    let speed = speed(a, b);
    ra.max(rb) * speed * speed + 2.0 * (ra - rb).abs() * speed
}

/// Greatest speed (radians) of the normalized mixture of two corners' radials.
#[inline(always)]
fn speed(a: &Corners, b: &Corners) -> F32x4 {
    // tan(θ/2) of unit vectors without the arc cosine, which is inaccurate on GPUs.
    let (apart, together) = (
        (a.radial - b.radial).length(),
        (a.radial + b.radial).length(),
    );
    2.0 * (apart / together.max(F32x4::splat(1e-6))).min(F32x4::splat(STEEPEST))
}

/// Bound of what the second derivative of the offset is more where the radius is no straight line.
#[inline(always)]
fn widening(a: &Corners, b: &Corners, path: Path) -> F32x4 {
    let profile = Profiles::new(a, b, &CenterLines::new(a, b, path));
    let radii = |k: &Corners| k.offset.length() / k.radius.max(F32x4::splat(f32::MIN_POSITIVE));
    let steeper = profile.steepest() - (b.radius - a.radius).abs();
    radii(a).max(radii(b)) * (profile.bend() + 2.0 * steeper * speed(a, b))
}

#[inline(always)]
fn center_bend(a: &Corners, b: &Corners, path: Path) -> F32x4 {
    if path == Path::Linear {
        return F32x4::ZERO;
    }
    let way = b.center - a.center;
    let (m0, m1) = hermite_tangents(a, b);
    let start = way * 6.0 - m0 * 4.0 - m1 * 2.0;
    let end = m0 * 2.0 + m1 * 4.0 - way * 6.0;
    start.length().max(end.length())
}
