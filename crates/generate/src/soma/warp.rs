//! A smooth warp of the sphere's directions that turns every insertion quad onto its neurite and widens
//! or narrows it to the angle that the neurite takes.
//!
//! **Theory.** Landmarks (the insertion quads' corners) travel along great circles from where the sphere
//! has them to where the rings need them. At every instant a tangent velocity field that interpolates
//! their velocities, a sum of bell-shaped kernels, carries all other directions along. The flow of
//! a smooth field cannot fold, whatever the landmarks' paths are as long as they do not collide
//! (Joshi & Miller, Landmark matching via large deformation diffeomorphisms, 2000; ours skips the
//! optimal control: the paths are given).
//!
//! Why not a Laplacian relaxation with fixed corners: it folds where an insertion quad is far off its neurite.

use glam::{DMat3, DQuat, DVec3};

use super::cholesky::Columns;

/// The flow, ready to be applied to any direction.
pub(crate) struct Warp {
    /// Per step: landmark positions and the kernels' weights, each weight already times the step.
    steps: Vec<(Vec<DVec3>, Vec<DVec3>)>,
    width: f64,
}

impl Warp {
    /// Flow that takes each `from` to its `to` (unit vectors), or `None` if landmarks coincide.
    /// `width` is the kernels' reach on the sphere (chord length).
    pub(crate) fn new(from: &[DVec3], to: &[DVec3], width: f64, count: usize) -> Option<Self> {
        let n = from.len();
        let mut here = from.to_vec();
        let mut steps = Vec::with_capacity(count);
        for step in 0..count {
            let t = (step + 1) as f64 / count as f64;
            let next: Vec<DVec3> = from
                .iter()
                .zip(to)
                .map(|(&a, &b)| great_circle(a, b, t))
                .collect();
            let gram = Columns::from_fn(n, |i, j| {
                let near = kernel(here[i].distance_squared(here[j]) / (width * width));
                near + if i == j { 1e-9 } else { 0.0 }
            });
            let velocities = next.iter().zip(&here).map(|(&next, &here)| next - here);
            let mut weights: Vec<[f64; 3]> = velocities.map(|v| v.to_array()).collect();
            let factor = gram.factor()?;
            factor.forward(&mut weights);
            factor.backward(&mut weights);
            let weights = weights.into_iter().map(DVec3::from_array);
            steps.push((std::mem::replace(&mut here, next), weights.collect()));
        }
        Some(Self { steps, width })
    }

    /// Where a direction goes.
    pub(crate) fn apply(&self, direction: DVec3) -> DVec3 {
        let scale = (self.width * self.width).recip();
        self.steps.iter().fold(direction, |x, (centers, weights)| {
            let bells = centers.iter().zip(weights);
            let move_by: DVec3 = bells
                .map(|(&c, &w)| w * kernel(x.distance_squared(c) * scale))
                .sum();
            (x + move_by).try_normalize().unwrap_or(x)
        })
    }
}

/// Inverse multiquadric of order 2: smooth, positive definite, no transcendental function. `distance_squared`: in squares of
/// its width.
fn kernel(distance_squared: f64) -> f64 {
    let q = 1.0 + distance_squared;
    1.0 / (q * q)
}

fn great_circle(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    let axis = a.cross(b);
    match axis.try_normalize() {
        Some(axis) => DQuat::from_axis_angle(axis, t * a.angle_between(b)).mul_vec3(a),
        None => a,
    }
}

/// Four directions at an angle about `center`, a quarter turn apart, counter-clockwise, turned so
/// that they lie nearest to the four given ones.
pub(crate) fn ring_directions(center: DVec3, angle: f64, near: [DVec3; 4]) -> [DVec3; 4] {
    across(center, near).map(|out| center * angle.cos() + out * angle.sin())
}

/// Four unit directions across an axis, a quarter turn apart, counter-clockwise, turned so that they lie nearest to the
/// ways from the middle of four places to them.
pub(crate) fn across(axis: DVec3, near: [DVec3; 4]) -> [DVec3; 4] {
    let (e1, e2) = axis.any_orthonormal_pair();
    let middle = near.iter().copied().sum::<DVec3>() / 4.0;
    let mut turn = (0.0, 0.0);
    for (quarter, place) in near.iter().enumerate() {
        let off = *place - middle;
        let (x, y) = (off.dot(e1), off.dot(e2));
        let (sin, cos) = (-std::f64::consts::FRAC_PI_2 * quarter as f64).sin_cos();
        let (x, y) = (x * cos - y * sin, x * sin + y * cos);
        turn = (turn.0 + x, turn.1 + y);
    }
    let start = f64::atan2(turn.1, turn.0);
    [0.0, 1.0, 2.0, 3.0].map(|quarter| {
        let around = start + std::f64::consts::FRAC_PI_2 * quarter;
        e1 * around.cos() + e2 * around.sin()
    })
}

/// Rotates directions given in the sphere's frame.
pub(crate) fn rotate(rotation: DMat3, corners: [DVec3; 4]) -> [DVec3; 4] {
    corners.map(|corner| rotation * corner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn landmarks_arrive_exactly() {
        let from = [DVec3::X, DVec3::Y, DVec3::NEG_Z];
        let to = [
            DVec3::new(1.0, 0.3, 0.1),
            DVec3::new(0.2, 1.0, 0.0),
            DVec3::NEG_Z,
        ]
        .map(DVec3::normalize_or_zero);
        let warp = Warp::new(&from, &to, 0.6, 8).unwrap();
        for (a, b) in from.iter().zip(&to) {
            assert!(warp.apply(*a).distance(*b) < 1e-6);
        }
    }

    #[test]
    fn ring_is_counter_clockwise_and_near() {
        let center = DVec3::new(0.2, -0.5, 0.8).normalize_or_zero();
        let (e1, e2) = center.any_orthonormal_pair();
        let near = [0.3_f64, 1.9, 3.4, 5.1].map(|t| center + (e1 * t.cos() + e2 * t.sin()) * 0.2);
        let ring = ring_directions(center, 0.1, near);
        let normal = (ring[2] - ring[0]).cross(ring[3] - ring[1]);
        assert!(normal.dot(center) > 0.0);
        for (r, n) in ring.iter().zip(near) {
            assert!((*r - center).dot(n - center) > 0.0);
            assert!((r.angle_between(center) - 0.1).abs() < 1e-12);
        }
    }
}
