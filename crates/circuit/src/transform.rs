//! Matrices that place a rigid cell.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};

/// Greatest departure from a rotation, as a part of the scale: files round to three decimals or so.
pub(crate) const TOLERANCE: f64 = 2e-3;

/// Translation (µm), rotation and uniform scale.
pub(crate) type Placement = (DVec3, DQuat, f64);

/// The placement that a matrix of 16 numbers, row by row, makes; `None` if it is not rigid up to a
/// uniform scale, mirrors, or has numbers that are not finite.
pub(crate) fn rigid(rows: [f64; 16]) -> Option<Placement> {
    let matrix = DMat4::from_cols_array(&rows).transpose();
    if !matrix.is_finite() || !matrix.row(3).abs_diff_eq(DVec4::W, 1e-9) {
        return None;
    }
    let linear = DMat3::from_mat4(matrix);
    let scale = linear.determinant().cbrt();
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    let turned = linear * scale.recip();
    let off = turned * turned.transpose() - DMat3::IDENTITY;
    let largest = off
        .to_cols_array()
        .into_iter()
        .fold(0.0, |m: f64, x| m.max(x.abs()));
    let rotation = DQuat::from_mat3(&turned).normalize();
    let rigid = largest <= TOLERANCE && rotation.is_finite();
    rigid.then(|| (matrix.w_axis.truncate(), rotation, scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rigid_matrices_come_apart() {
        let rotation = DQuat::from_rotation_y(0.7);
        let matrix = DMat4::from_scale_rotation_translation(
            DVec3::splat(2.0),
            rotation,
            DVec3::new(1.0, 2.0, 3.0),
        );
        let (place, turned, scale) =
            rigid(matrix.transpose().to_cols_array()).expect("it is rigid");
        assert_eq!(place, DVec3::new(1.0, 2.0, 3.0));
        assert!(turned.angle_between(rotation) < 1e-9 && (scale - 2.0).abs() < 1e-12);
    }

    #[test]
    fn sheared_mirrored_and_broken_ones_do_not() {
        let identity = DMat4::IDENTITY.to_cols_array();
        for (place, value) in [(1, 0.5), (0, -1.0), (0, 0.0), (3, f64::NAN), (15, 2.0)] {
            let mut rows = identity;
            rows[place] = value;
            assert_eq!(rigid(rows), None, "{place} {value}");
        }
    }
}
