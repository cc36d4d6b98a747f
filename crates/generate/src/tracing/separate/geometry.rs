//! Segments and round cones in space.

use glam::DVec3;

/// A vector is no direction below this length (µm). A guard.
const NOTHING: f64 = 1e-12;

/// The direction of a vector, or zero where it has none.
pub(super) fn direction(vector: DVec3) -> DVec3 {
    let length = vector.length();
    if length > NOTHING {
        vector / length
    } else {
        DVec3::ZERO
    }
}

/// Shares s and t at which segments p and q are nearest each other, each from its first end
/// (Ericson, Real-Time Collision Detection, 2005, 5.1.9). Where they are parallel: in the middle of
/// the part that they have side by side, so that a push moves both ends of each.
pub(super) fn closest(p: [DVec3; 2], q: [DVec3; 2]) -> (f64, f64) {
    let (along_p, along_q, between) = (p[1] - p[0], q[1] - q[0], p[0] - q[0]);
    let (a, e) = (along_p.length_squared(), along_q.length_squared());
    let (b, c, f) = (
        along_p.dot(along_q),
        along_p.dot(between),
        along_q.dot(between),
    );
    if a <= 0.0 || e <= 0.0 {
        let on = |length: f64, at: f64| if length > 0.0 { at / length } else { 0.0 };
        return (on(a, -c).clamp(0.0, 1.0), on(e, f).clamp(0.0, 1.0));
    }
    let slanted = a * e - b * b;
    let s = if slanted > 1e-12 * a * e {
        ((b * f - c * e) / slanted).clamp(0.0, 1.0)
    } else {
        let (first, last) = (-c / a, (b - c) / a);
        let low = first.min(last).clamp(0.0, 1.0);
        let high = first.max(last).clamp(0.0, 1.0);
        0.5 * (low + high)
    };
    let t = (b * s + f) / e;
    if t < 0.0 {
        ((-c / a).clamp(0.0, 1.0), 0.0)
    } else if t > 1.0 {
        (((b - c) / a).clamp(0.0, 1.0), 1.0)
    } else {
        (s, t)
    }
}

/// Share of a segment, from its first end, that is nearest to a point.
pub(super) fn nearest_to(point: DVec3, segment: [DVec3; 2]) -> f64 {
    let along = segment[1] - segment[0];
    let square = along.length_squared();
    if square > 0.0 {
        ((point - segment[0]).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;
    use proptest::prelude::*;

    use super::*;

    fn apart(p: [DVec3; 2], q: [DVec3; 2], s: f64, t: f64) -> f64 {
        p[0].lerp(p[1], s).distance(q[0].lerp(q[1], t))
    }

    #[test]
    fn parallel_segments_are_nearest_in_the_middle_of_what_is_side_by_side() {
        let p = [DVec3::ZERO, dvec3(4.0, 0.0, 0.0)];
        let q = [dvec3(6.0, 1.0, 0.0), dvec3(2.0, 1.0, 0.0)];
        let (s, t) = closest(p, q);
        assert_eq!((s, t), (0.75, 0.75));
    }

    fn point() -> impl Strategy<Value = DVec3> {
        // On a lattice, so that parallel, equal and empty segments are drawn too.
        [-3..4, -3..4, -3..4].prop_map(|place: [i32; 3]| DVec3::from(place.map(f64::from)))
    }

    proptest! {
        #[test]
        fn no_other_pair_of_points_is_nearer(
            p in [point(), point()], q in [point(), point()], s in 0.0..1.0, t in 0.0..1.0,
        ) {
            let (nearest_s, nearest_t) = closest(p, q);
            let least = apart(p, q, nearest_s, nearest_t);
            prop_assert!(least <= apart(p, q, s, t) + 1e-9);
            let on_p = nearest_to(q[0].lerp(q[1], nearest_t), p);
            prop_assert!(apart(p, q, on_p, nearest_t) >= least - 1e-9);
        }
    }
}
