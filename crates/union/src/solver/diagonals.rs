//! Which diagonal of its cells a refined surface has.
//!
//! A refinement splits all cells of its grids the same way. A fifth to a third of them would be better off with the
//! other diagonal: that of a Delaunay triangulation, across which angles are at most 180° together. With it smallest
//! angles are largest, and a tetrahedralization has most edges of the surface without being told: TetGen misses a tenth
//! as many, and needs a third less time.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use crate::surface::stars::normal;
use crate::surface::work::Work;

/// By how much the angles across a diagonal may exceed 180° (0.02°): those of a rectangle do by rounding. With 0.5°
/// TetGen misses four times as many edges.
const SLACK: f64 = 0.0004;

/// Cosine of how far faces may turn (5.7°): the surface stays where it is.
const FLAT: f64 = 0.995;

/// Gives nearly flat pairs of triangles that follow one another the diagonal of a Delaunay triangulation, but those
/// with a vertex that is `fixed`.
pub(crate) fn choose_diagonals(work: &mut Work, fixed: &[bool]) {
    let pairs = 0..work.triangles.len().saturating_sub(1) as u32;
    let pairs = pairs.into_par_iter();
    let better: Vec<Pair> = pairs
        .filter_map(|first| better(work, first, fixed))
        .collect();
    let mut fresh = Vec::with_capacity(better.len());
    let mut last = None;
    for pair in better {
        // A triangle belongs to one pair.
        if last.is_none_or(|last| last + 1 < pair.first) {
            last = Some(pair.first);
            fresh.push(pair);
        }
    }
    fresh.par_sort_unstable_by_key(|pair| pair.edge);
    let there = known_edges(work, &fresh);
    for (at, pair) in fresh.iter().enumerate() {
        // Two pairs may want the same edge, as on a tube of four sides.
        let twice = at > 0 && fresh[at - 1].edge == pair.edge;
        if !twice && !there[at] {
            let first = pair.first as usize;
            work.triangles[first..first + 2].copy_from_slice(&pair.triangles);
            work.changed[first..first + 2].fill(true);
        }
    }
}

/// Two triangles in place of a triangle and the next.
struct Pair {
    first: u32,
    triangles: [[u32; 3]; 2],
    /// Their common edge, from the lower end to the higher.
    edge: [u32; 2],
}

/// What a triangle and the next become if the other diagonal is better.
fn better(work: &Work, first: u32, fixed: &[bool]) -> Option<Pair> {
    let [one, other] = [first, first + 1].map(|face| work.triangles[face as usize]);
    let side = (0..3).find(|&k| other.contains(&one[k]) && other.contains(&one[(k + 1) % 3]))?;
    let [from, to, apex] = [0, 1, 2].map(|k| one[(side + k) % 3]);
    let far = *other.iter().find(|&&v| v != from && v != to)?;
    if [from, to, apex, far].iter().any(|&v| fixed[v as usize]) {
        return None;
    }
    let at = |v: u32| work.position(v).as_dvec3();
    let [a, b, p, q] = [from, to, apex, far].map(at);
    let angle = |corner: DVec3| (a - corner).angle_between(b - corner);
    // False of a triangle without a shape, whose angles are no numbers.
    let wide = angle(p) + angle(q) > PI + SLACK;
    let triangles = [[apex, from, far], [far, to, apex]];
    let old = [one, other].map(|face| normal(&face.map(at)));
    let new = triangles.map(|face| normal(&face.map(at)));
    let flat = old.iter().chain(&new).all(|n| {
        let cosine = n.dot(old[0]);
        cosine > FLAT * n.length() * old[0].length()
    });
    (wide && flat).then_some(Pair {
        first,
        triangles,
        edge: [apex.min(far), apex.max(far)],
    })
}

/// For each of some pairs, in the order of their edges, whether the surface has that edge already.
fn known_edges(work: &Work, pairs: &[Pair]) -> Vec<bool> {
    let faces = work.triangles.par_iter();
    let found: Vec<usize> = faces
        .flat_map_iter(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|[from, to]| from < to)
        .filter_map(|edge| pairs.binary_search_by_key(&edge, |pair| pair.edge).ok())
        .collect();
    let mut known = vec![false; pairs.len()];
    for at in found {
        known[at] = true;
    }
    known
}
