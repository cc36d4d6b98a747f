//! Frames that turn as little as possible along a path.

use std::f64::consts::FRAC_PI_2;

use glam::{DQuat, DVec3};

use crate::plan::unit_across;

/// Carries a normal from one point of a path to the next by two reflections.
///
/// `frame` is a unit vector across `tangent`; the result is one across `next_tangent`. Wang et al.,
/// Computation of rotation minimizing frames, ACM TOG 27(1), 2008, table I.
pub(crate) fn transport(way: DVec3, frame: DVec3, tangent: DVec3, next_tangent: DVec3) -> DVec3 {
    let reflect = |v: DVec3, across: DVec3| {
        let length = across.length_squared();
        if length > 0.0 {
            v - across * (2.0 * across.dot(v) / length)
        } else {
            v
        }
    };
    let (frame_left, tangent_left) = (reflect(frame, way), reflect(tangent, way));
    across(
        reflect(frame_left, next_tangent - tangent_left),
        next_tangent,
    )
}

/// The part of a vector across a unit direction, as a unit vector; any if there is none.
pub(crate) fn across(vector: DVec3, direction: DVec3) -> DVec3 {
    unit_across(vector, direction).unwrap_or_else(|| direction.any_orthonormal_vector())
}

/// Angle about `axis` from one vector across it to another, as quarter turns and what remains
/// (at most 45° either way).
pub(crate) fn quarters(from: DVec3, to: DVec3, axis: DVec3) -> (i32, f64) {
    let angle = f64::atan2(axis.dot(from.cross(to)), from.dot(to));
    let quarter = (angle / FRAC_PI_2).round();
    (quarter as i32, angle - quarter * FRAC_PI_2)
}

/// Turns a vector about a unit axis.
pub(crate) fn turn(vector: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    if angle == 0.0 {
        vector
    } else {
        DQuat::from_axis_angle(axis, angle).mul_vec3(vector)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along a planar curve the binormal stays itself.
    #[test]
    fn planar_path_keeps_its_binormal() {
        let tangent = |t: f64| DVec3::new(t.cos(), t.sin(), 0.0);
        let mut frame = DVec3::Z;
        for i in 0..20 {
            let (a, b) = (f64::from(i) * 0.2, f64::from(i + 1) * 0.2);
            let way = tangent(0.5 * (a + b)) * 0.2;
            frame = transport(way, frame, tangent(a), tangent(b));
            assert!((frame - DVec3::Z).length() < 1e-12);
        }
    }

    #[test]
    fn quarters_split_an_angle() {
        let to = turn(DVec3::X, DVec3::Z, 2.0);
        let (quarter, rest) = quarters(DVec3::X, to, DVec3::Z);
        assert_eq!(quarter, 1);
        assert!((rest - (2.0 - FRAC_PI_2)).abs() < 1e-12);
    }
}
