//! Two views side by side.

use glam::{DMat3, DQuat, DVec3};
use neurotess::render::{Camera, Side};
use serde::{Deserialize, Serialize};

use crate::model::view::View;

/// The view that is not that of the commands, and how the two belong together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Split {
    /// The other view.
    #[serde(default)]
    pub view: View,
    /// Whether both move together.
    #[serde(default)]
    pub linked: bool,
    /// Whether the right one is that of the commands.
    #[serde(default)]
    pub right: bool,
    /// The side from which the other one shows everything, until it is moved by hand.
    #[serde(skip)]
    pub(crate) fitted: Option<Side>,
    /// Width by height of its picture.
    #[serde(skip, default = "square")]
    pub(crate) aspect: f64,
    /// Both views when the one last followed the other.
    #[serde(skip)]
    pub(crate) followed: Option<[View; 2]>,
}

fn square() -> f64 {
    1.0
}

impl Split {
    /// Two views, the other of which is this one.
    pub fn new(view: View) -> Self {
        Self {
            view,
            linked: false,
            right: false,
            fitted: None,
            aspect: square(),
            followed: None,
        }
    }

    /// What a session keeps of it.
    pub(crate) fn kept(self) -> Self {
        Self {
            linked: self.linked,
            right: self.right,
            ..Self::new(self.view)
        }
    }
}

/// A view that moves as another one did: about the same axes of the world by the same angles, by the same way, and
/// nearer by the same factor.
#[must_use]
pub fn following(view: &View, before: &View, after: &View) -> View {
    let [camera, a, b] = [view, before, after].map(View::camera);
    let turn = rotation(&b) * rotation(&a).inverse();
    let away = |camera: &Camera| camera.eye().distance(camera.target());
    let distance = away(&camera) * away(&b) / away(&a).max(1e-12);
    let target = camera.target() + b.target() - a.target();
    let turned = turn * rotation(&camera);
    let eye = target + turned * DVec3::Z * distance;
    let followed = View {
        eye: eye.to_array(),
        target: target.to_array(),
        up: (turned * DVec3::Y).to_array(),
        orthographic: after.orthographic,
        ..*view
    };
    let fits = eye.is_finite() && distance > 1e-6;
    if fits { followed } else { *view }
}

fn rotation(camera: &Camera) -> DQuat {
    let [right, up, backward] = camera.axes();
    DQuat::from_mat3(&DMat3::from_cols(right, up, backward)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: DVec3, b: DVec3) -> bool {
        a.distance(b) < 1e-6 * (1.0 + a.length())
    }

    #[test]
    fn a_view_follows_turns_ways_and_distances() {
        let front = View::default();
        let side = front.orbited(1.5, 0.0, DVec3::Y);
        let moved = front
            .orbited(0.4, 0.0, DVec3::Y)
            .panned(30.0, -10.0, 300.0)
            .zoomed(0.5, DVec3::ZERO);
        let follows = following(&side, &front, &moved).camera();
        // Both turned about y by the same angle, so the angle between them stays.
        let between = |a: &Camera, b: &Camera| a.axes()[2].dot(b.axes()[2]);
        let (a, b) = (front.camera(), side.camera());
        assert!((between(&a, &b) - between(&moved.camera(), &follows)).abs() < 1e-9);
        assert!(near(follows.target(), moved.camera().target()));
        let away = follows.eye().distance(follows.target());
        assert!((away - 150.0).abs() < 1e-6, "{away}");
        assert!(follows.axes()[1].y > 0.99, "upright");
        // A view follows itself, and one that does not move keeps it.
        let same = following(&front, &front, &moved).camera();
        assert!(near(same.eye(), moved.camera().eye()));
        let still = following(&side, &moved, &moved).camera();
        assert!(near(still.eye(), side.camera().eye()));
    }

    #[test]
    fn the_projection_follows_too() {
        let parallel = View {
            orthographic: true,
            ..View::default()
        };
        let follows = following(&View::default(), &View::default(), &parallel);
        assert!(follows.orthographic);
    }
}
