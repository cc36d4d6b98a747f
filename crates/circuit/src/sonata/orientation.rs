//! How nodes are turned: by quaternions, or by angles around the axes.
//!
//! **Quaternions** `orientation_{w,x,y,z}` turn the morphology's axes to the circuit's. Real files
//! have lengths from 0.95 to 1.59, so they are normalized. **Angles** `rotation_angle_{x,y,z}axis`
//! (radians) turn about the circuit's z, then y, then x: R = Rx Ry Rz for column vectors; a missing
//! one is zero. Each node goes by what its own group or type has; where that has both, quaternions win, as in bluepysnap (bmtk
//! 1.2.0 reads angles alone). SONATA developer guide,
//! "Representing nodes"; bluepysnap `NodePopulation.orientations`.

use glam::DQuat;

/// The unit quaternion of four components; `None` if they have no length or are not finite.
pub(crate) fn from_components([w, x, y, z]: [f64; 4]) -> Option<DQuat> {
    let largest = [w, x, y, z].iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let all_finite = [w, x, y, z].iter().all(|c| c.is_finite());
    if !all_finite || largest == 0.0 {
        return None;
    }
    // Scaled first: the square of 1e-200 is zero.
    let [w, x, y, z] = [w, x, y, z].map(|c| c / largest);
    Some(DQuat::from_xyzw(x, y, z, w).normalize())
}

/// The rotation by angles (radians) about z, then y, then x; `None` if they are not finite.
pub(crate) fn from_angles([x, y, z]: [f64; 3]) -> Option<DQuat> {
    let finite = x.is_finite() && y.is_finite() && z.is_finite();
    finite
        .then(|| DQuat::from_rotation_x(x) * DQuat::from_rotation_y(y) * DQuat::from_rotation_z(z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn quaternions_of_any_length_turn_alike() {
        let unit = from_components([0.5, 0.5, 0.5, 0.5]).expect("a rotation");
        for length in [1e-200, 0.95, 1.59, 1e200] {
            let turned = from_components([length; 4]).expect("a rotation");
            assert!(turned.angle_between(unit) < 1e-12, "{length}");
        }
        assert_eq!(from_components([0.0; 4]), None);
        assert_eq!(from_components([f64::NAN, 0.0, 0.0, 1.0]), None);
    }

    #[test]
    fn angles_turn_about_z_first() {
        let turned = from_angles([FRAC_PI_2, 0.0, FRAC_PI_2]).expect("a rotation") * DVec3::X;
        // About z: x becomes y; about x: y becomes z.
        assert!(turned.distance(DVec3::Z) < 1e-12, "{turned}");
    }
}
