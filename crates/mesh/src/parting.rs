//! Planes that part triangles by more than rounding can amount to: most pairs need nothing else.
//!
//! Corners are coordinates of single precision, in doubles. Differences of two have a relative error of
//! 2⁻⁵³ at most, products and sums of them a few times that. A triple product u × v · w of differences has
//! an error below 4.7 × 10⁻¹⁵ times the product of the three's largest coordinates (three terms of two
//! products each, by the bound of `orient3d` in Shewchuk, 1997); [`ROUNDING`] is more than twice that.

use glam::DVec3;

type Triangle = [DVec3; 3];

/// Error of a triple product over the product of the largest coordinates; for a product of two, too.
const ROUNDING: f64 = 1e-14;

/// Whether the plane of one of two triangles has the other surely on one side.
pub(crate) fn plane_parts_triangles(a: &Triangle, b: &Triangle) -> bool {
    is_beside(a, b) || is_beside(b, a)
}

/// Whether all corners of `b` are surely on one side of the plane of `a`.
fn is_beside(a: &Triangle, b: &Triangle) -> bool {
    let (u, v) = (a[1] - a[0], a[2] - a[0]);
    let normal = u.cross(v);
    let scale = ROUNDING * largest(u) * largest(v);
    on_one_side(normal, scale, b.map(|corner| corner - a[0]))
}

/// Whether two triangles whose first corners are the same have surely nothing else in common: a plane through
/// that corner parts them, either one between the two or that of one of them.
pub(crate) fn plane_parts_fans(a: &Triangle, b: &Triangle) -> bool {
    let [a1, a2, b1, b2] = [a[1], a[2], b[1], b[2]].map(|corner| corner - a[0]);
    let (to_a, to_b) = (a1 + a2, b1 + b2);
    let between = to_a * to_b.length() - to_b * to_a.length();
    let scale = ROUNDING * largest(between);
    // The other side for `b`: turned around, all four are on one.
    if on_one_side(between, scale, [a1, a2, -b1, -b2]) {
        return true;
    }
    let beside = |u: DVec3, v: DVec3, others: [DVec3; 2]| {
        let scale = ROUNDING * largest(u) * largest(v);
        on_one_side(u.cross(v), scale, others)
    };
    beside(a1, a2, [b1, b2]) || beside(b1, b2, [a1, a2])
}

/// Whether two triangles whose first two corners are the same are surely not in one plane.
pub(crate) fn flat_fold_is_excluded(a: &Triangle, b: &Triangle) -> bool {
    let (u, v) = (a[1] - a[0], a[2] - a[0]);
    let scale = ROUNDING * largest(u) * largest(v);
    on_one_side(u.cross(v), scale, [b[2] - a[0]])
}

/// Whether points are surely on one side of the plane through the origin with this normal; `scale` times a
/// point's largest coordinate bounds the error.
fn on_one_side<const N: usize>(normal: DVec3, scale: f64, points: [DVec3; N]) -> bool {
    let sides = points.map(|point| (normal.dot(point), scale * largest(point)));
    sides.iter().all(|&(side, error)| side > error)
        || sides.iter().all(|&(side, error)| side < -error)
}

/// The largest coordinate.
fn largest(v: DVec3) -> f64 {
    v.abs().max_element()
}
