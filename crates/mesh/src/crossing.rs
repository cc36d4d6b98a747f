//! Do two triangles have a point in common? Exact: every decision is the sign of a determinant
//! that `robust` computes without rounding errors (J. R. Shewchuk, Adaptive Precision
//! Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997).
//!
//! Triangles are closed: touching counts. Both must have an area. Two triangles in general
//! position meet where an edge of one passes through the other (P. Guigue, O. Devillers, Fast and
//! Robust Triangle-Triangle Overlap Test Using Orientation Predicates, 2003, decide the same with
//! fewer determinants; ours come after a box test that leaves few pairs, and one test for edges
//! also serves the triangles that share a vertex).

use glam::DVec3;
use robust::{Coord, Coord3D};

type Triangle = [DVec3; 3];

/// Whether triangles without a common vertex meet.
pub(crate) fn triangles_meet(a: &Triangle, b: &Triangle) -> bool {
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
    segment_meets(a[1], a[2], b) || segment_meets(b[1], b[2], a)
}

/// Whether triangles whose first two corners are the same, in either order, lie upon each other.
pub(crate) fn folded(a: &Triangle, b: &Triangle) -> bool {
    if side(a, b[2]) != 0.0 {
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
