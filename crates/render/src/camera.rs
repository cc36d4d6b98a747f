//! From where the scene is seen.
//!
//! A circuit is 10⁴ µm wide and a membrane 10⁻² µm thick, so a camera is f64 and shaders get
//! everything relative to the eye: near things keep all their digits.
//!
//! Depth is reversed and has no far end: 1 at the near plane, 0 infinitely far. With floating-point
//! depth, precision is then the same share of the distance everywhere (Upchurch & Desbrun,
//! Tightening the precision of perspective rendering, 2012).

use glam::{DMat3, DQuat, DVec3, Mat4, Vec3, Vec4};
use neurotess_refine::View;

use crate::error::CameraError;
use crate::frame::shows;

/// An eye in perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: DVec3,
    target: DVec3,
    /// Rows: right, up and backward, unit and orthogonal.
    view_from_world: DMat3,
    fov: f64,
}

/// Sides to look from. Cells stand in y; x points right, z towards the one who looks from the front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Along −z.
    #[default]
    Front,
    /// Along +z.
    Back,
    /// Along +x.
    Left,
    /// Along −x.
    Right,
    /// Along −y.
    Top,
    /// Along +y.
    Bottom,
    /// From the right, above and before.
    Iso,
}

/// A ball to be seen: centre and radius (µm).
pub type Ball = (DVec3, f64);

/// Angle of view (radians) unless told otherwise: little distortion, as through a long lens.
pub const DEFAULT_FOV: f64 = 20.0 * std::f64::consts::PI / 180.0;

impl Side {
    /// From the target to the eye, and upwards.
    fn axes(self) -> (DVec3, DVec3) {
        match self {
            Self::Front => (DVec3::Z, DVec3::Y),
            Self::Back => (DVec3::NEG_Z, DVec3::Y),
            Self::Left => (DVec3::NEG_X, DVec3::Y),
            Self::Right => (DVec3::X, DVec3::Y),
            Self::Top => (DVec3::Y, DVec3::NEG_Z),
            Self::Bottom => (DVec3::NEG_Y, DVec3::Z),
            Self::Iso => (DVec3::new(1.0, 0.8, 1.0), DVec3::Y),
        }
    }
}

impl Camera {
    /// A camera at `eye` (µm) that looks at `target`; `up` is upwards in the picture, `fov` the
    /// vertical angle of view (radians).
    ///
    /// # Errors
    /// Numbers that are not finite, or that leave the direction open.
    pub fn new(eye: DVec3, target: DVec3, up: DVec3, fov: f64) -> Result<Self, CameraError> {
        for (value, name) in [(eye, "eye"), (target, "target"), (up, "up")] {
            if !value.is_finite() {
                return Err(CameraError::NotFinite(name));
            }
        }
        if !fov.is_finite() {
            return Err(CameraError::NotFinite("field of view"));
        }
        if !(0.01..=170.0).contains(&fov.to_degrees()) {
            return Err(CameraError::FieldOfView(fov.to_degrees()));
        }
        let backward = (eye - target).try_normalize();
        let backward = backward.ok_or(CameraError::NoDirection)?;
        let up = up.try_normalize().ok_or(CameraError::NoUp)?;
        let right = up.cross(backward);
        if right.length() < 1e-6 {
            return Err(CameraError::NoUp);
        }
        let right = right / right.length();
        let axes = DMat3::from_cols(right, backward.cross(right), backward);
        Ok(Self {
            eye,
            target,
            view_from_world: axes.transpose(),
            fov,
        })
    }

    /// The camera on this side that is as near as it can be while all balls are in the picture and
    /// `margin` of its width and height stays free on each side. `aspect` is width by height. No
    /// ball at all: from 100 µm away at the origin.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn fit(
        side: Side,
        fov: f64,
        aspect: f64,
        margin: f64,
        balls: &[Ball],
    ) -> Result<Self, CameraError> {
        Self::fit_within(side, fov, aspect, [margin; 4], balls)
    }

    /// As [`Camera::fit`], with a margin for each side: left, right, top, bottom.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn fit_within(
        side: Side,
        fov: f64,
        aspect: f64,
        margins: [f64; 4],
        balls: &[Ball],
    ) -> Result<Self, CameraError> {
        let (backward, up) = side.axes();
        let start = Self::new(backward, DVec3::ZERO, up, fov)?;
        if balls.is_empty() {
            return Self::new(backward * 100.0, DVec3::ZERO, up, fov);
        }
        let (tan_x, tan_y) = start.tangents(aspect, 0.0);
        let [left, right, top, bottom] = margins.map(|m| 1.0 - 2.0 * m.clamp(0.0, 0.45));
        // Where the eye must be along an axis, and how far back, for the planes on its low and high
        // side to touch.
        let touch = |axis: usize, low_tan: f64, high_tan: f64| {
            let (mut low, mut high) = (f64::MAX, f64::MIN);
            for &(center, radius) in balls {
                let v = start.view_from_world * center;
                high = high.max(v[axis] + high_tan * v.z + radius * high_tan.hypot(1.0));
                low = low.min(v[axis] - low_tan * v.z - radius * low_tan.hypot(1.0));
            }
            let depth = (high - low) / (low_tan + high_tan);
            (
                (low * high_tan + high * low_tan) / (low_tan + high_tan),
                depth,
            )
        };
        let (x, depth_x) = touch(0, tan_x * left, tan_x * right);
        let (y, depth_y) = touch(1, tan_y * bottom, tan_y * top);
        let depth = depth_x.max(depth_y);
        // Farther than an axis asks for, its things stay in the middle of what is free.
        let x = x + (depth - depth_x) * tan_x * (left - right) / 2.0;
        let y = y + (depth - depth_y) * tan_y * (bottom - top) / 2.0;
        let nearest = balls
            .iter()
            .map(|&(center, radius)| (start.view_from_world * center).z + radius)
            .fold(f64::MIN, f64::max);
        let middle = start.view_from_world * mean(balls);
        // A scene without extent is seen from a little away; never from within the nearest ball.
        let depth = depth.max(nearest + 1e-3 * (nearest - middle.z).abs().max(1e-3));
        let eye = DVec3::new(x, y, depth);
        let target = DVec3::new(x, y, middle.z.min(nearest - 1e-6).min(depth - 1e-3));
        let world = start.view_from_world.transpose();
        Self::new(world * eye, world * target, up, fov)
    }

    /// The camera that keeps all balls in the picture while it goes around them by
    /// [`Camera::turned`], as near as it can be.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn fit_turning(
        side: Side,
        fov: f64,
        aspect: f64,
        margin: f64,
        balls: &[Ball],
    ) -> Result<Self, CameraError> {
        let still = Self::fit(side, fov, aspect, margin, balls)?;
        let (tan_x, tan_y) = still.tangents(aspect, margin);
        let [right, up, backward] = still.axes();
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for &(center, radius) in balls {
            let v = still.view_from_world * center;
            low = low.min(v - radius);
            high = high.max(v + radius);
        }
        if balls.is_empty() {
            return Ok(still);
        }
        let middle = (low + high) / 2.0;
        let mut distance: f64 = 0.0;
        for &(center, radius) in balls {
            let v = still.view_from_world * center - middle;
            let around = v.x.hypot(v.z);
            // ρ (sin θ + t cos θ) is at most ρ √(1 + t²).
            distance = distance
                .max((around + radius) * tan_x.hypot(1.0) / tan_x)
                .max(around + (v.y.abs() + radius * tan_y.hypot(1.0)) / tan_y);
        }
        let target = right * middle.x + up * middle.y + backward * middle.z;
        Self::new(target + backward * distance.max(1e-3), target, up, fov)
    }

    /// The same camera, gone around its target by an angle (radians), to the right if positive.
    pub fn turned(&self, angle: f64) -> Self {
        let turn = DQuat::from_axis_angle(self.axes()[1], angle);
        let [right, up, backward] = self.axes().map(|axis| turn * axis);
        Self {
            eye: self.target + turn * (self.eye - self.target),
            view_from_world: DMat3::from_cols(right, up, backward).transpose(),
            ..*self
        }
    }

    /// Position of the eye (µm).
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// What it looks at (µm).
    pub fn target(&self) -> DVec3 {
        self.target
    }

    /// Vertical angle of view (radians).
    pub fn fov(&self) -> f64 {
        self.fov
    }

    /// Unit directions: right, up and backward.
    pub fn axes(&self) -> [DVec3; 3] {
        let world = self.view_from_world.transpose();
        [world.x_axis, world.y_axis, world.z_axis]
    }

    /// Depth (µm) of a point along the sight, negative behind the eye.
    pub fn depth(&self, point: DVec3) -> f64 {
        -(self.view_from_world * (point - self.eye)).z
    }

    /// Nearest depth (µm) at which anything shows, for a scene of these balls: a little before the
    /// nearest, and never so near that digits are lost.
    pub fn near(&self, balls: &[Ball]) -> f64 {
        let depths = balls
            .iter()
            .map(|&(c, r)| (self.depth(c) - r, self.depth(c) + r));
        let (near, far) = depths.fold((f64::MAX, 1e-3_f64), |(n, f), (a, b)| (n.min(a), f.max(b)));
        (0.9 * near.min(far)).max(1e-5 * far)
    }

    /// Depth (µm) of the nearest ball in the picture, at least a thousandth of the target's: what
    /// lies outside or behind the eye need not be fine. Nothing seen: the target's.
    pub fn nearest_seen(&self, aspect: f64, balls: &[Ball]) -> f64 {
        let target = self.depth(self.target).abs();
        let planes = self.frustum(aspect, 0.0);
        let seen = balls.iter().filter(|&&(center, radius)| {
            shows(&planes, (center - self.eye).as_vec3(), radius as f32)
        });
        let depths = seen.map(|&(center, radius)| self.depth(center) - radius);
        let nearest = depths.fold(f64::MAX, f64::min);
        let nearest = if nearest == f64::MAX { target } else { nearest };
        nearest.max(1e-3 * target)
    }

    /// Rotation from the world to the view, as f32: x right, y up, z backward.
    pub fn view_rotation(&self) -> [Vec3; 3] {
        let rows = self.view_from_world.transpose();
        [rows.x_axis, rows.y_axis, rows.z_axis].map(DVec3::as_vec3)
    }

    /// Clip space from positions relative to the eye (world axes, µm): reversed depth, no far end.
    pub fn clip_from_relative(&self, aspect: f64, near: f64) -> Mat4 {
        let [right, up, backward] = self.axes().map(DVec3::as_vec3);
        let (tan_x, tan_y) = self.tangents(aspect, 0.0);
        let rows = [
            (right / tan_x as f32).extend(0.0),
            (up / tan_y as f32).extend(0.0),
            Vec4::new(0.0, 0.0, 0.0, near as f32),
            (-backward).extend(0.0),
        ];
        Mat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose()
    }

    /// Planes of the frustum relative to the eye, normals inwards, unit: left, right, bottom, top,
    /// near. A point p is inside where n·p + d ≥ 0.
    pub fn frustum(&self, aspect: f64, near: f64) -> [Vec4; 5] {
        let [right, up, backward] = self.axes();
        let (tan_x, tan_y) = self.tangents(aspect, 0.0);
        let side = |axis: DVec3, tan: f64| {
            ((axis - backward * tan) / tan.hypot(1.0))
                .as_vec3()
                .extend(0.0)
        };
        [
            side(right, tan_x),
            side(-right, tan_x),
            side(up, tan_y),
            side(-up, tan_y),
            (-backward).as_vec3().extend(-near as f32),
        ]
    }

    /// Where a point is seen in a picture of this size (pixels from the upper left corner); nowhere
    /// if it lies behind the eye.
    pub fn pixel_of(&self, point: DVec3, size: [u32; 2]) -> Option<[f64; 2]> {
        let v = self.view_from_world * (point - self.eye);
        let [width, height] = size.map(f64::from);
        let pixel = -v.z * self.pixel_slope(height);
        (v.z < 0.0).then(|| [width / 2.0 + v.x / pixel, height / 2.0 - v.y / pixel])
    }

    /// Size (µm) of a pixel at unit depth, in a picture of this height (pixels).
    pub fn pixel_slope(&self, height: f64) -> f64 {
        2.0 * (self.fov / 2.0).tan() / height
    }

    /// The view that levels are chosen from, in coordinates relative to `origin` (µm).
    pub fn refine_view(&self, origin: DVec3, height: f64, near: f64) -> View {
        View {
            eye: (self.eye - origin).as_vec3(),
            forward: -self.axes()[2].as_vec3(),
            slope: self.pixel_slope(height) as f32,
            flat: 0.0,
            near: near as f32,
        }
    }

    /// Tangents of half the angles of view, without the margins.
    fn tangents(&self, aspect: f64, margin: f64) -> (f64, f64) {
        let tan_y = (self.fov / 2.0).tan() * (1.0 - 2.0 * margin.clamp(0.0, 0.49));
        (tan_y * aspect, tan_y)
    }
}

fn mean(balls: &[Ball]) -> DVec3 {
    let sum: DVec3 = balls.iter().map(|&(center, _)| center).sum();
    sum / balls.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDES: [Side; 7] = [
        Side::Front,
        Side::Back,
        Side::Left,
        Side::Right,
        Side::Top,
        Side::Bottom,
        Side::Iso,
    ];

    fn balls() -> Vec<Ball> {
        (0..40)
            .map(|i| {
                let t = f64::from(i);
                let center = DVec3::new(t.sin() * 300.0, t * 7.0 - 1e4, (2.0 * t).cos() * 50.0);
                (center, 1.0 + t / 4.0)
            })
            .collect()
    }

    /// Farthest that a ball reaches in the picture, from −1 to 1 in both directions.
    fn reach(camera: &Camera, aspect: f64, balls: &[Ball]) -> f64 {
        let planes = camera.frustum(aspect, 1e-3);
        let mut most = f64::MIN;
        for &(center, radius) in balls {
            let p = (center - camera.eye()).as_vec3().extend(1.0);
            for plane in &planes[..4] {
                most = most.max(radius - f64::from(plane.dot(p)));
            }
        }
        most
    }

    #[test]
    fn fitted_balls_touch_the_frustum_from_within() {
        for side in SIDES {
            for aspect in [0.3, 1.0, 2.5] {
                let camera = Camera::fit(side, 0.5, aspect, 0.0, &balls()).expect("fits");
                let most = reach(&camera, aspect, &balls());
                assert!(most.abs() < 0.01, "{side:?} {aspect}: {most}");
            }
        }
    }

    #[test]
    fn margins_stay_free() {
        let margins = [0.3, 0.05, 0.02, 0.1];
        for aspect in [0.5, 2.0] {
            let camera = Camera::fit_within(Side::Iso, 0.4, aspect, margins, &balls());
            let camera = camera.expect("fits");
            let size = [(4000.0 * aspect) as u32, 4000];
            let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
            for (center, _) in balls() {
                let p = camera.pixel_of(center, size).expect("in front");
                for k in 0..2 {
                    low[k] = low[k].min(p[k] / f64::from(size[k]));
                    high[k] = high[k].max(p[k] / f64::from(size[k]));
                }
            }
            let free = [low[0], 1.0 - high[0], low[1], 1.0 - high[1]];
            for (free, margin) in free.iter().zip(margins) {
                assert!(*free > margin - 0.001, "{free} {margin}");
            }
            let slack = [
                free[0] - 0.3 + free[1] - 0.05,
                free[2] - 0.02 + free[3] - 0.1,
            ];
            assert!(
                slack[0].min(slack[1]) < 0.1,
                "as near as it can be: {slack:?}"
            );
        }
    }

    #[test]
    fn turning_keeps_everything_in_the_picture() {
        for side in SIDES {
            let camera = Camera::fit_turning(side, 0.4, 1.5, 0.0, &balls()).expect("fits");
            for step in 0..24 {
                let turned = camera.turned(f64::from(step) * 0.3);
                assert!(reach(&turned, 1.5, &balls()) < 0.01, "{side:?} {step}");
            }
            let whole = camera.turned(std::f64::consts::TAU);
            assert!(whole.eye().distance(camera.eye()) < 1e-6);
        }
    }

    #[test]
    fn clip_space_is_reversed_and_upright() {
        let camera = Camera::new(DVec3::Z * 10.0, DVec3::ZERO, DVec3::Y, 1.0).expect("a camera");
        let clip = camera.clip_from_relative(2.0, 0.5);
        let project = |p: DVec3| {
            let c = clip * (p - camera.eye()).as_vec3().extend(1.0);
            c.truncate() / c.w
        };
        assert!((project(DVec3::Z * 9.5).z - 1.0).abs() < 1e-6);
        assert!(project(DVec3::ZERO).z > project(DVec3::Z * -1e6).z);
        let (right, up) = (project(DVec3::X), project(DVec3::Y));
        assert!(right.x > 0.0 && right.y.abs() < 1e-6 && up.y > 0.0);
        assert!((2.0 * right.x - up.y).abs() < 1e-6, "square pixels");
    }

    #[test]
    fn impossible_cameras_are_errors() {
        let new = |eye, up, fov| Camera::new(eye, DVec3::ZERO, up, fov);
        assert!(new(DVec3::NAN, DVec3::Y, 1.0).is_err());
        assert!(new(DVec3::Z, DVec3::INFINITY, 1.0).is_err());
        assert!(new(DVec3::Z, DVec3::Y, f64::NAN).is_err());
        assert_eq!(
            new(DVec3::ZERO, DVec3::Y, 1.0),
            Err(CameraError::NoDirection)
        );
        assert_eq!(new(DVec3::Z, DVec3::Z, 1.0), Err(CameraError::NoUp));
        assert!(matches!(
            new(DVec3::Z, DVec3::Y, 4.0),
            Err(CameraError::FieldOfView(_))
        ));
    }

    #[test]
    fn scenes_without_extent_have_a_camera() {
        for side in SIDES {
            assert!(Camera::fit(side, 0.5, 1.0, 0.1, &[]).is_ok());
            let point = [(DVec3::new(1.0, 2.0, 3.0), 0.0)];
            assert!(Camera::fit(side, 0.5, 1.0, 0.1, &point).is_ok());
            assert!(Camera::fit_turning(side, 0.5, 1.0, 0.1, &point).is_ok());
        }
    }
}
