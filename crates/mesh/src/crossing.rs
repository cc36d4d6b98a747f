//! Do two triangles have a point in common? Exact: every decision is the sign of a determinant
//! that `robust` computes without rounding errors (J. R. Shewchuk, Adaptive Precision
//! Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997).
//!
//! Triangles are closed: touching counts. Both must have an area. Two triangles in general
//! position meet where an edge of one passes through the other (P. Guigue, O. Devillers, Fast and
//! Robust Triangle-Triangle Overlap Test Using Orientation Predicates, 2003, decide the same with
//! fewer determinants; ours come after a box test that leaves few pairs, and one test for edges
//! also serves the triangles that share a vertex).
//!
//! Nearly all pairs are far from touching, seen from the nearer of the two: a plane parts them by
//! much more than what rounding can amount to. Such planes are looked for first (`parting.rs`).

use glam::DVec3;
use robust::{Coord, Coord3D};

use crate::parting::{flat_fold_is_excluded, plane_parts_fans, plane_parts_triangles};

type Triangle = [DVec3; 3];

/// Whether triangles without a common vertex meet.
pub(crate) fn triangles_meet(a: &Triangle, b: &Triangle) -> bool {
    !plane_parts_triangles(a, b) && triangles_meet_exactly(a, b)
}

fn triangles_meet_exactly(a: &Triangle, b: &Triangle) -> bool {
    let a_beside_b = a.map(|p| side(b, p));
    if apart(a_beside_b) {
        return false;
    }
    if a_beside_b == [0.0; 3] {
        return coplanar_triangles_meet(a, b);
    }
    let b_beside_a = b.map(|p| side(a, p));
    !apart(b_beside_a) && (edges_pass(a, a_beside_b, b) || edges_pass(b, b_beside_a, a))
}

/// Whether triangles whose first corners are one and the same meet elsewhere: then the edge of one
/// that lies opposite meets the other.
pub(crate) fn fans_meet(a: &Triangle, b: &Triangle) -> bool {
    !plane_parts_fans(a, b) && fans_meet_exactly(a, b)
}

fn fans_meet_exactly(a: &Triangle, b: &Triangle) -> bool {
    segment_meets(a[1], a[2], b) || segment_meets(b[1], b[2], a)
}

/// Whether triangles whose first two corners are the same, in either order, lie upon each other.
pub(crate) fn folded(a: &Triangle, b: &Triangle) -> bool {
    if flat_fold_is_excluded(a, b) || side(a, b[2]) != 0.0 {
        return false;
    }
    let axis = flat_axis(a);
    let turn = |apex| turn(axis, a[0], a[1], apex);
    (turn(a[2]) > 0.0) == (turn(b[2]) > 0.0)
}

/// Whether the corners are on no line.
pub(crate) fn has_area(triangle: &Triangle) -> bool {
    let [a, b, c] = *triangle;
    (0..3).any(|axis| turn(axis, a, b, c) != 0.0)
}

fn apart(sides: [f64; 3]) -> bool {
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

/// Whether an edge of `a`, whose corners are on the given sides of `b`, meets `b`.
fn edges_pass(a: &Triangle, sides: [f64; 3], b: &Triangle) -> bool {
    (0..3).any(|n| {
        let m = (n + 1) % 3;
        segment_with_sides_meets(a[n], a[m], sides[n], sides[m], b)
    })
}

fn segment_meets(p: DVec3, q: DVec3, triangle: &Triangle) -> bool {
    segment_with_sides_meets(p, q, side(triangle, p), side(triangle, q), triangle)
}

fn segment_with_sides_meets(p: DVec3, q: DVec3, sp: f64, sq: f64, triangle: &Triangle) -> bool {
    if (sp > 0.0 && sq > 0.0) || (sp < 0.0 && sq < 0.0) {
        return false;
    }
    if sp == 0.0 && sq == 0.0 {
        return coplanar_segment_meets(p, q, triangle);
    }
    let [a, b, c] = *triangle;
    let turns = [orient(p, q, a, b), orient(p, q, b, c), orient(p, q, c, a)];
    turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
}

fn coplanar_triangles_meet(a: &Triangle, b: &Triangle) -> bool {
    let axis = flat_axis(b);
    (0..3).any(|n| coplanar_segment_meets(a[n], a[(n + 1) % 3], b)) || inside(axis, b[0], a)
}

fn coplanar_segment_meets(p: DVec3, q: DVec3, triangle: &Triangle) -> bool {
    let axis = flat_axis(triangle);
    inside(axis, p, triangle)
        || (0..3).any(|n| segments_meet(axis, p, q, triangle[n], triangle[(n + 1) % 3]))
}

/// Whether a point in the triangle's plane is in the triangle.
fn inside(axis: usize, p: DVec3, triangle: &Triangle) -> bool {
    let turns = [0, 1, 2].map(|n| turn(axis, triangle[n], triangle[(n + 1) % 3], p));
    turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
}

/// Whether segments in one plane meet.
fn segments_meet(axis: usize, p: DVec3, q: DVec3, r: DVec3, s: DVec3) -> bool {
    let (r_side, s_side) = (turn(axis, p, q, r), turn(axis, p, q, s));
    let (p_side, q_side) = (turn(axis, r, s, p), turn(axis, r, s, q));
    if r_side == 0.0 && s_side == 0.0 && p_side == 0.0 && q_side == 0.0 {
        // On one line: as intervals, along every axis.
        let overlap = p.min(q).cmple(r.max(s)) & r.min(s).cmple(p.max(q));
        return overlap.all();
    }
    opposite(r_side, s_side) && opposite(p_side, q_side)
}

fn opposite(a: f64, b: f64) -> bool {
    a == 0.0 || b == 0.0 || (a > 0.0) != (b > 0.0)
}

/// An axis along which the triangle can be projected and keeps an area.
fn flat_axis(&[a, b, c]: &Triangle) -> usize {
    let normal = (b - a).cross(c - a).abs().to_array();
    let widest = (0..3).fold(0, |best, axis| {
        if normal[axis] > normal[best] {
            axis
        } else {
            best
        }
    });
    if turn(widest, a, b, c) != 0.0 {
        return widest;
    }
    (0..3)
        .find(|&axis| turn(axis, a, b, c) != 0.0)
        .unwrap_or(widest)
}

/// On which side of a triangle a point lies.
fn side(&[a, b, c]: &Triangle, p: DVec3) -> f64 {
    orient(a, b, c, p)
}

fn orient(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    });
    robust::orient3d(a, b, c, d)
}

/// Which way a → b → c turns, seen along an axis.
fn turn(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| match axis {
        0 => Coord { x: p.y, y: p.z },
        1 => Coord { x: p.z, y: p.x },
        _ => Coord { x: p.x, y: p.y },
    });
    robust::orient2d(a, b, c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a small grid, so that many are in one plane, on one line or the same; and some
    /// far from the origin, where coordinates round.
    fn points(seed: u32) -> impl Iterator<Item = DVec3> {
        let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(12_345);
        let mut next = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 16
        };
        let shift = if seed.is_multiple_of(3) { 1000.1 } else { 0.0 };
        let scale = if seed.is_multiple_of(2) { 1.0 } else { 0.1 };
        let mut number = move || ((next() % 5) as f32 * scale + shift) as f64;
        std::iter::from_fn(move || Some(DVec3::new(number(), number(), number())))
    }

    #[test]
    fn what_a_plane_parts_is_apart_exactly() {
        let (mut parted, mut left) = ([0; 3], [0; 3]);
        for seed in 0..60_000 {
            let p: Vec<DVec3> = points(seed).take(6).collect();
            let (a, b) = ([p[0], p[1], p[2]], [p[3], p[4], p[5]]);
            let (fan, wing) = ([p[0], p[4], p[5]], [p[0], p[1], p[5]]);
            if !(has_area(&a) && has_area(&b) && has_area(&fan) && has_area(&wing)) {
                continue;
            }
            let found = [
                (
                    plane_parts_triangles(&a, &b),
                    triangles_meet_exactly(&a, &b),
                ),
                (plane_parts_fans(&a, &fan), fans_meet_exactly(&a, &fan)),
                (flat_fold_is_excluded(&a, &wing), side(&a, wing[2]) == 0.0),
            ];
            for (n, (excluded, meet)) in found.into_iter().enumerate() {
                assert!(!(excluded && meet), "{seed}: {n}");
                parted[n] += usize::from(excluded);
                left[n] += usize::from(!excluded && !meet);
            }
        }
        // It pays only if it parts most of those that are apart.
        assert!(
            (0..3).all(|n| parted[n] > 2 * left[n]),
            "{parted:?} {left:?}"
        );
    }
}
