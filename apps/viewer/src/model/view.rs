//! Views, and how they are moved. Angles are radians, lengths µm.

use glam::{DMat3, DQuat, DVec3};
use neurotess::render::{BoundingSphere, Camera, DEFAULT_FOV, Lens, Side};
use serde::{Deserialize, Serialize};

/// Margin around a scene that is fitted into the picture, as a share of its width and height: the
/// same as that of `neurotess render`.
const MARGIN: f64 = 0.04;

/// A camera's position and target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct View {
    /// Position of the eye.
    pub eye: [f64; 3],
    /// The point that it looks at and turns around.
    pub target: [f64; 3],
    /// Direction upwards in the picture.
    pub up: [f64; 3],
    /// Vertical angle of view (degrees).
    pub fov: f64,
    /// Whether there is no perspective. Things at the target's depth have the same size with it and
    /// without.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub orthographic: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            eye: [0.0, 0.0, 300.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov: DEFAULT_FOV.to_degrees(),
            orthographic: false,
        }
    }
}

impl From<Camera> for View {
    fn from(camera: Camera) -> Self {
        Self {
            eye: camera.eye().to_array(),
            target: camera.target().to_array(),
            up: camera.axes()[1].to_array(),
            fov: camera.fov().to_degrees(),
            orthographic: camera.is_orthographic(),
        }
    }
}

impl View {
    /// The camera; a default one if the numbers are invalid.
    pub fn camera(&self) -> Camera {
        let [eye, target, up] = [self.eye, self.target, self.up].map(DVec3::from_array);
        let made = Camera::new(eye, target, up, self.lens());
        let usual = || Camera::fit(Side::Front, DEFAULT_FOV, 1.0, 0.1, &[]);
        made.or_else(|_| usual())
            .unwrap_or_else(|_| unreachable!("a fixed camera"))
    }

    fn lens(&self) -> Lens {
        let fov = self.fov.to_radians();
        match self.orthographic {
            true => Lens::orthographic(fov),
            false => fov.into(),
        }
    }

    fn with(&self, eye: DVec3, target: DVec3, up: DVec3) -> Self {
        let fits = eye.is_finite() && target.is_finite() && up.is_finite();
        if !fits || eye.distance(target) < 1e-6 {
            return *self;
        }
        Self {
            eye: eye.to_array(),
            target: target.to_array(),
            up: up.to_array(),
            ..*self
        }
    }

    /// Moves around the target: `right` about the world's upwards direction, `up` towards the top,
    /// but not beyond it.
    #[must_use]
    pub fn orbited(&self, right: f64, up: f64, upwards: DVec3) -> Self {
        let camera = self.camera();
        let [side, _, backward] = camera.axes();
        let height = backward.dot(upwards).clamp(-1.0, 1.0).asin();
        let most = 89.5_f64.to_radians();
        let up = (height + up).clamp(-most, most) - height;
        let turn = DQuat::from_axis_angle(upwards, -right) * DQuat::from_axis_angle(side, -up);
        let offset = turn * (camera.eye() - camera.target());
        self.with(camera.target() + offset, camera.target(), upwards)
    }

    /// Moves the scene by this number of pixels in a picture of this height.
    #[must_use]
    pub fn panned(&self, right: f64, down: f64, height: f64) -> Self {
        let camera = self.camera();
        let [side, up, _] = camera.axes();
        let pixel = camera.pixel_at_target(height);
        let way = (up * down - side * right) * pixel;
        self.with(camera.eye() + way, camera.target() + way, up)
    }

    /// Multiplies the distance by a factor, with `place` staying where it is in the picture.
    #[must_use]
    pub fn zoomed(&self, factor: f64, place: DVec3) -> Self {
        let camera = self.camera();
        let distance = camera.eye().distance(camera.target());
        let factor = factor.clamp(1e-3 / distance.max(1e-9), 1e9 / distance.max(1e-9));
        let nearer = |p: DVec3| place + (p - place) * factor;
        self.with(
            nearer(camera.eye()),
            nearer(camera.target()),
            camera.axes()[1],
        )
    }

    /// Moves the eye and the target right, up and forward (µm). Without perspective, moving forward
    /// would change nothing: it enlarges instead.
    #[must_use]
    pub fn flown(&self, right: f64, up: f64, forward: f64) -> Self {
        let camera = self.camera();
        let [side, upwards, backward] = camera.axes();
        let across = side * right + upwards * up;
        if self.orthographic {
            let moved = self.with(camera.eye() + across, camera.target() + across, upwards);
            let distance = camera.eye().distance(camera.target());
            return moved.zoomed((-forward / distance).exp(), camera.target() + across);
        }
        let way = across - backward * forward;
        self.with(camera.eye() + way, camera.target() + way, upwards)
    }

    /// Looks at a sphere from the same direction, as near as it fits with some margin.
    #[must_use]
    pub fn focused(&self, (center, radius): BoundingSphere) -> Self {
        let camera = self.camera();
        let [_, up, backward] = camera.axes();
        let distance = 1.3 * radius.max(1e-3) / (camera.fov() / 2.0).sin();
        self.with(center + backward * distance, center, up)
    }

    /// The view from a side with all spheres in the picture.
    #[must_use]
    pub fn fitted(
        &self,
        side: Side,
        y_down: bool,
        aspect: f64,
        spheres: &[BoundingSphere],
    ) -> Self {
        let lens = self.camera().lens();
        let side = if y_down { below(side) } else { side };
        let Ok(camera) = Camera::fit(side, lens, aspect.max(1e-3), MARGIN, spheres) else {
            return *self;
        };
        let up = camera.axes()[1] * if y_down { -1.0 } else { 1.0 };
        self.with(camera.eye(), middle(&camera, spheres), up)
    }

    /// The view for another aspect ratio (width by height), with the same extent along the shorter
    /// side.
    #[must_use]
    pub fn reshaped(&self, before: f64, after: f64) -> Self {
        let factor = before.min(1.0) / after.min(1.0);
        self.zoomed(factor, self.camera().target())
    }

    /// The point at the target's depth that is at this position in the picture (pixels).
    pub fn under(&self, [x, y]: [f64; 2], size: [f64; 2]) -> DVec3 {
        let camera = self.camera();
        let depth = camera.depth(camera.target());
        self.at_depth([x, y], size, depth)
    }

    /// Depth (µm) of a point that is seen: positive, unless there is no perspective.
    pub fn depth_in_front(&self, point: DVec3) -> f64 {
        let depth = self.camera().depth(point);
        depth.max(if self.orthographic { depth } else { 1e-6 })
    }

    /// The point at this depth that is at this position in the picture (pixels).
    pub fn at_depth(&self, [x, y]: [f64; 2], size: [f64; 2], depth: f64) -> DVec3 {
        let camera = self.camera();
        let [side, up, backward] = camera.axes();
        let pixel = camera.pixel_size(size[1]).at(depth);
        let (right, above) = (x - size[0] / 2.0, size[1] / 2.0 - y);
        camera.eye() + (side * right + up * above) * pixel - backward * depth
    }

    /// A view between two: this one at 0, the other at 1. Target and direction are interpolated
    /// evenly; the projection is that of the nearer end.
    #[must_use]
    pub fn between(&self, other: &Self, t: f64) -> Self {
        let (a, b) = (self.camera(), other.camera());
        let rotation = |camera: &Camera| {
            let [right, up, backward] = camera.axes();
            DQuat::from_mat3(&DMat3::from_cols(right, up, backward)).normalize()
        };
        let turned = rotation(&a).slerp(rotation(&b), t);
        let away = |camera: &Camera| camera.eye().distance(camera.target());
        // The distance changes by equal ratios, so that zooming looks even.
        let distance = away(&a).powf(1.0 - t) * away(&b).powf(t);
        let target = a.target().lerp(b.target(), t);
        let mut view = self.with(
            target + turned * DVec3::Z * distance,
            target,
            turned * DVec3::Y,
        );
        view.fov = self.fov + (other.fov - self.fov) * t;
        view.orthographic = if t < 0.5 { self } else { other }.orthographic;
        view
    }
}

/// With y downwards, the side that shows what this side shows with y upwards, upside down.
fn below(side: Side) -> Side {
    match side {
        Side::Front => Side::Back,
        Side::Back => Side::Front,
        Side::Top => Side::Bottom,
        Side::Bottom => Side::Top,
        other => other,
    }
}

/// The target of a fitted camera: the middle of all spheres along its direction, not the nearest
/// sphere. Without perspective it is there already, and its distance is the picture's size.
fn middle(camera: &Camera, spheres: &[BoundingSphere]) -> DVec3 {
    if camera.is_orthographic() {
        return camera.target();
    }
    let depths = spheres
        .iter()
        .map(|&(c, r)| (camera.depth(c) - r, camera.depth(c) + r));
    let (near, far) = depths.fold((f64::MAX, f64::MIN), |(n, f), (a, b)| (n.min(a), f.max(b)));
    if near > far {
        return camera.target();
    }
    let depth = ((near + far) / 2.0).max(1e-3);
    camera.eye() - camera.axes()[2] * depth
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [f64; 2] = [400.0, 300.0];

    fn near(a: DVec3, b: DVec3) -> bool {
        a.distance(b) < 1e-6 * (1.0 + a.length())
    }

    #[test]
    fn orbiting_keeps_the_distance_and_stops_at_the_top() {
        let view = View::default();
        let mut turned = view;
        for _ in 0..200 {
            turned = turned.orbited(0.1, 0.3, DVec3::Y);
        }
        let camera = turned.camera();
        assert!((camera.eye().distance(camera.target()) - 300.0).abs() < 1e-6);
        assert!(camera.axes()[1].y > 0.0, "never upside down");
    }

    #[test]
    fn without_perspective_zooming_and_moving_keep_to_pixels() {
        let view = View {
            orthographic: true,
            ..View::default().orbited(0.4, 0.2, DVec3::Y)
        };
        let seen = |view: &View, p: DVec3| view.camera().pixel_of(p, [400, 300]).expect("seen");
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-6;
        // Far in front of the target and far behind it, even behind the eye.
        for depth in [-900.0, 20.0, 5000.0] {
            let place = view.at_depth([100.0, 80.0], SIZE, depth);
            assert!(near(seen(&view, place), [100.0, 80.0]));
            assert!((view.camera().depth(place) - depth).abs() < 1e-6);
            assert!(near(seen(&view.zoomed(0.3, place), place), [100.0, 80.0]));
            let panned = view.panned(30.0, -20.0, 300.0);
            assert!(near(seen(&panned, place), [130.0, 60.0]));
        }
        // Flying forward enlarges.
        let nearer = view.flown(0.0, 0.0, 30.0).camera();
        assert!(nearer.height() < 0.95 * view.camera().height());
        assert_eq!(nearer.target(), view.camera().target());
        // What is looked at stays as large with perspective and without.
        let other = View {
            orthographic: false,
            ..view
        };
        let place = view.under([320.0, 40.0], SIZE);
        assert!(near(seen(&other, place), seen(&view, place)));
        assert!(!view.between(&other, 0.7).orthographic);
    }

    #[test]
    fn zooming_keeps_what_is_under_the_cursor() {
        let view = View::default().orbited(0.4, 0.2, DVec3::Y);
        let place = view.under([100.0, 80.0], SIZE);
        let seen = |view: &View| view.camera().pixel_of(place, [400, 300]).expect("in front");
        let [x, y] = seen(&view);
        assert!((x - 100.0).abs() < 1e-6 && (y - 80.0).abs() < 1e-6);
        let [x, y] = seen(&view.zoomed(0.3, place));
        assert!((x - 100.0).abs() < 1e-6 && (y - 80.0).abs() < 1e-6);
    }

    #[test]
    fn a_picture_of_another_form_keeps_its_shorter_side() {
        let view = View::default().orbited(0.4, 0.2, DVec3::Y);
        let away = |view: View| view.camera().eye().distance(view.camera().target());
        assert!((away(view.reshaped(2.0, 1.5)) - 300.0).abs() < 1e-9);
        // Half as wide as high: twice as far.
        let narrow = view.reshaped(2.0, 0.5);
        assert!((away(narrow) - 600.0).abs() < 1e-9);
        assert!((away(narrow.reshaped(0.5, 1.0)) - 300.0).abs() < 1e-9);
    }

    #[test]
    fn panning_moves_the_target_by_pixels() {
        let view = View::default();
        let target = view.camera().target();
        let moved = view.panned(30.0, -20.0, 300.0);
        let [x, y] = moved
            .camera()
            .pixel_of(target, [400, 300])
            .expect("in front");
        assert!(
            (x - 230.0).abs() < 1e-6 && (y - 130.0).abs() < 1e-6,
            "{x} {y}"
        );
    }

    #[test]
    fn sides_fit_and_y_may_run_down() {
        let spheres = [
            (DVec3::new(0.0, 50.0, 0.0), 1.0),
            (DVec3::new(0.0, -50.0, 9.0), 1.0),
        ];
        let parallel = View {
            orthographic: true,
            ..View::default()
        };
        for side in [Side::Front, Side::Top, Side::Iso] {
            let up = View::default().fitted(side, false, 1.3, &spheres).camera();
            let down = View::default().fitted(side, true, 1.3, &spheres).camera();
            let fitted = parallel.fitted(side, false, 1.3, &spheres);
            assert!(fitted.orthographic);
            for camera in [up, down, fitted.camera()] {
                assert!(
                    spheres
                        .iter()
                        .all(|&(c, _)| camera.pixel_of(c, [400, 300]).is_some())
                );
            }
        }
        let y = |camera: Camera| camera.pixel_of(spheres[0].0, [400, 300]).expect("seen")[1];
        assert!(
            y(View::default()
                .fitted(Side::Front, false, 1.3, &spheres)
                .camera())
                < 150.0
        );
        let down = View::default()
            .fitted(Side::Front, true, 1.3, &spheres)
            .camera();
        assert!(
            y(down) > 150.0 && down.axes()[0].x > 0.99,
            "x still runs to the right"
        );
    }

    #[test]
    fn views_between_begin_and_end_where_they_should() {
        let a = View::default();
        let b = a.orbited(1.0, 0.3, DVec3::Y).zoomed(0.2, DVec3::X);
        for (t, end) in [(0.0, a), (1.0, b)] {
            let there = a.between(&b, t).camera();
            assert!(
                near(there.eye(), end.camera().eye())
                    && near(there.target(), end.camera().target())
            );
        }
    }

    #[test]
    fn numbers_that_are_none_change_nothing() {
        let view = View::default();
        assert_eq!(view.flown(f64::NAN, 0.0, 0.0), view);
        let broken = View {
            eye: [f64::NAN; 3],
            ..view
        };
        assert!(broken.camera().eye().is_finite());
    }
}
