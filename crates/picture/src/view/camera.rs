//! Cameras.
//!
//! A circuit is 10⁴ µm wide and a membrane 10⁻² µm thick, so a camera has f64 coordinates, and
//! shaders get all positions relative to the eye: near things keep their full precision.
//!
//! Depth is reversed and has no far end: 1 at the near plane, 0 infinitely far. With floating-point
//! depth, precision is then the same share of the distance everywhere (Upchurch & Desbrun,
//! Tightening the precision of perspective rendering, 2012).
//!
//! An orthographic camera sees all of the scene, also what is behind its eye, since where on the line
//! of sight the eye is changes nothing that one sees. Its near plane has a negative depth, and the
//! far one is as far before the eye: `-near`. Depth falls evenly between them from 1 to 0. Positions
//! stay relative to the eye, which comes near what is enlarged, and so keep their precision.

use glam::{DMat3, DQuat, DVec3, Mat4, Vec3, Vec4};
use neurotess_refine::LodView;
use thiserror::Error;

use crate::view::frustum::{BoundingSphere, shows};
use crate::view::lens::{Lens, PixelSize, Projection};

/// Why a camera is not valid. Messages have the form `what: what to do`.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum CameraError {
    /// A coordinate or angle is no number, or is infinite.
    #[error("the camera's {0} is not a finite number: correct it")]
    NotFinite(&'static str),
    /// There is no viewing direction.
    #[error("the camera's eye and target coincide: move one of them")]
    NoDirection,
    /// The direction upwards in the picture is not defined.
    #[error("the camera's up points along its viewing direction: give another direction")]
    NoUp,
    /// The field of view is too small or too large.
    #[error("a field of view of {0}° is not between 0.01° and 170°: choose one in between")]
    FieldOfView(f64),
    /// A picture has no such height.
    #[error("a picture cannot show a height of {0} µm: choose one above 0")]
    Height(f64),
}

/// A camera, perspective or orthographic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: DVec3,
    target: DVec3,
    /// Rotation from the world to the view. Its rows are the unit directions right, up and
    /// backward.
    pub(crate) view_from_world: DMat3,
    lens: Lens,
}

impl Camera {
    /// A camera at `eye` (µm) that looks at `target`; `up` is upwards in the picture. `lens`: a
    /// [`Lens`], or the vertical angle of view (radians) of a perspective one.
    ///
    /// # Errors
    /// A number is not finite, a direction is not defined, or the field of view is out of range.
    pub fn new(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        lens: impl Into<Lens>,
    ) -> Result<Self, CameraError> {
        let lens = lens.into();
        let fov = lens.fov;
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
            lens,
        })
    }

    /// The same camera, moved around its target by an angle (radians), to the right if positive.
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

    /// The point that it looks at (µm).
    pub fn target(&self) -> DVec3 {
        self.target
    }

    /// How it projects.
    pub fn lens(&self) -> Lens {
        self.lens
    }

    /// Vertical angle of view (radians), see [`Lens::fov`].
    pub fn fov(&self) -> f64 {
        self.lens.fov
    }

    /// Whether it has no perspective.
    pub fn is_orthographic(&self) -> bool {
        self.lens.projection == Projection::Orthographic
    }

    /// The same camera with another projection. What is at the target's depth keeps its size.
    #[must_use]
    pub fn with_projection(&self, projection: Projection) -> Self {
        let fov = self.lens.fov;
        let lens = Lens { fov, projection };
        Self { lens, ..*self }
    }

    /// Height (µm) of what the picture shows at the target's depth; of an orthographic camera, at
    /// every depth.
    pub fn height(&self) -> f64 {
        2.0 * self.lens.tan() * self.eye.distance(self.target)
    }

    /// Unit directions: right, up and backward.
    pub fn axes(&self) -> [DVec3; 3] {
        let world = self.view_from_world.transpose();
        [world.x_axis, world.y_axis, world.z_axis]
    }

    /// Depth (µm) of a point along the direction of view, negative behind the eye.
    pub fn depth(&self, point: DVec3) -> f64 {
        -(self.view_from_world * (point - self.eye)).z
    }

    /// Depth (µm) of a near plane for a scene of these spheres: a little before the nearest sphere,
    /// but not so near that precision is lost. Of an orthographic camera it is negative, so far
    /// behind the eye that no sphere is farther from it, neither behind nor before.
    pub fn near(&self, spheres: &[BoundingSphere]) -> f64 {
        let depths = spheres
            .iter()
            .map(|&(c, r)| (self.depth(c) - r, self.depth(c) + r));
        let (near, far) = depths.fold((f64::MAX, 1e-3_f64), |(n, f), (a, b)| (n.min(a), f.max(b)));
        if self.is_orthographic() {
            // Widened neurites and markers reach a little further than their spheres.
            return -(1.1 * far.max(-near) + self.height());
        }
        (0.9 * near.min(far)).max(1e-5 * far)
    }

    /// Depth (µm) of the nearest sphere in the picture, at least a thousandth of the target's; the
    /// target's if there is none. Spheres outside the picture or behind the eye do not count. That
    /// of the target for an orthographic camera, to which depths make no difference.
    pub fn nearest_seen(&self, aspect: f64, spheres: &[BoundingSphere]) -> f64 {
        let target = self.depth(self.target).abs();
        if self.is_orthographic() {
            return target;
        }
        let planes = self.frustum(aspect, 0.0);
        let seen = spheres.iter().filter(|&&(center, radius)| {
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

    /// The camera in the same direction with the same target that is as far away as makes the
    /// picture this high (µm) there.
    ///
    /// # Errors
    /// The height is not positive and finite.
    pub fn with_height(&self, height: f64) -> Result<Self, CameraError> {
        let [_, up, backward] = self.axes();
        let distance = height / 2.0 / self.lens.tan();
        if !(height > 0.0 && distance.is_finite()) {
            return Err(CameraError::Height(height));
        }
        let eye = self.target + backward * distance;
        Self::new(eye, self.target, up, self.lens)
    }

    /// Clip space from positions relative to the eye (world axes, µm): reversed depth; with
    /// perspective it has no far end.
    pub fn clip_from_relative(&self, aspect: f64, near: f64) -> Mat4 {
        let [right, up, backward] = self.axes().map(DVec3::as_vec3);
        let rows = if self.is_orthographic() {
            let (half_width, half_height) = self.half_sizes(aspect);
            let reach = near.abs() as f32;
            [
                (right / half_width as f32).extend(0.0),
                (up / half_height as f32).extend(0.0),
                (backward / (2.0 * reach)).extend(0.5),
                Vec4::W,
            ]
        } else {
            let (tan_x, tan_y) = self.tangents(aspect, 0.0);
            [
                (right / tan_x as f32).extend(0.0),
                (up / tan_y as f32).extend(0.0),
                Vec4::new(0.0, 0.0, 0.0, near as f32),
                (-backward).extend(0.0),
            ]
        };
        Mat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose()
    }

    /// Planes of the frustum relative to the eye, with unit normals inwards: left, right, bottom,
    /// top, near. A point p is inside if n·p + d ≥ 0 for all.
    pub fn frustum(&self, aspect: f64, near: f64) -> [Vec4; 5] {
        let [right, up, backward] = self.axes();
        let front = (-backward).as_vec3().extend(-near as f32);
        if self.is_orthographic() {
            let (half_width, half_height) = self.half_sizes(aspect);
            let side = |axis: DVec3, half: f64| axis.as_vec3().extend(half as f32);
            return [
                side(right, half_width),
                side(-right, half_width),
                side(up, half_height),
                side(-up, half_height),
                front,
            ];
        }
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
            front,
        ]
    }

    /// Position of a point in a picture of this size (pixels from the upper left corner); none if
    /// it is behind the eye of a perspective camera.
    pub fn pixel_of(&self, point: DVec3, size: [u32; 2]) -> Option<[f64; 2]> {
        let v = self.view_from_world * (point - self.eye);
        let [width, height] = size.map(f64::from);
        let pixel = self.pixel_size(height).at(-v.z);
        (pixel > 0.0).then(|| [width / 2.0 + v.x / pixel, height / 2.0 - v.y / pixel])
    }

    /// Size (µm) of a pixel by depth, in a picture of this height (pixels).
    pub fn pixel_size(&self, height: f64) -> PixelSize {
        let (slope, flat) = if self.is_orthographic() {
            (0.0, self.height() / height)
        } else {
            (2.0 * self.lens.tan() / height, 0.0)
        };
        PixelSize { slope, flat }
    }

    /// Size (µm) of a pixel at the target's depth, in a picture of this height (pixels).
    pub fn pixel_at_target(&self, height: f64) -> f64 {
        self.pixel_size(height).at(self.depth(self.target))
    }

    /// The view that levels are selected for, in coordinates relative to `origin` (µm).
    pub fn refine_view(&self, origin: DVec3, height: f64, near: f64) -> LodView {
        let pixel = self.pixel_size(height);
        LodView {
            eye: (self.eye - origin).as_vec3(),
            forward: -self.axes()[2].as_vec3(),
            slope: pixel.slope as f32,
            flat: pixel.flat as f32,
            near: near as f32,
        }
    }

    /// Tangents of half the angles of view, without the margins.
    pub(crate) fn tangents(&self, aspect: f64, margin: f64) -> (f64, f64) {
        let tan_y = self.lens.tan() * (1.0 - 2.0 * margin.clamp(0.0, 0.49));
        (tan_y * aspect, tan_y)
    }

    /// Half the width and height (µm) of what an orthographic camera shows.
    fn half_sizes(&self, aspect: f64) -> (f64, f64) {
        let half = self.height() / 2.0;
        (half * aspect, half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn without_perspective_sizes_are_those_at_the_target() {
        let perspective = Camera::new(
            DVec3::new(3.0, 4.0, 30.0),
            DVec3::new(1.0, 2.0, 0.0),
            DVec3::Y,
            0.6,
        );
        let perspective = perspective.expect("a camera");
        let camera = perspective.with_projection(Projection::Orthographic);
        let [right, up, backward] = camera.axes();
        let size = [400, 300];
        let at = |camera: &Camera, p: DVec3| camera.pixel_of(p, size).expect("seen");
        // Where both cameras show the same, and where only one of them keeps sizes.
        let place = camera.target() + right * 3.0 - up * 2.0;
        let [a, b] = [&perspective, &camera].map(|camera| at(camera, place));
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9, "{a:?} {b:?}");
        for depth in [-80.0, -10.0, 29.0, 500.0] {
            let [x, y] = at(&camera, place + backward * depth);
            assert!((x - b[0]).hypot(y - b[1]) < 1e-9, "{depth}: {x} {y}");
        }
        // What is nearer is in front, wherever it is, and what reaches out of the picture is culled.
        let spheres = [
            (camera.target() + backward * 300.0, 1.0),
            (camera.target() - backward * 4.0, 1.0),
        ];
        let near = camera.near(&spheres);
        let clip = camera.clip_from_relative(4.0 / 3.0, near);
        let depth = |p: DVec3| {
            let c = clip * (p - camera.eye()).as_vec3().extend(1.0);
            assert_eq!(c.w, 1.0);
            c.z
        };
        let [first, last] = spheres.map(|(center, _)| depth(center));
        assert!(0.0 < last && last < first && first < 1.0, "{first} {last}");
        let planes = camera.frustum(4.0 / 3.0, near);
        let half = camera.height() / 2.0;
        for (axis, half) in [(right, half * 4.0 / 3.0), (up, half)] {
            for (away, inside) in [(0.99, true), (1.01, false)] {
                for side in [axis, -axis] {
                    let p = camera.target() + side * half * away + backward * 200.0;
                    let p = (p - camera.eye()).as_vec3();
                    assert_eq!(shows(&planes, p, 0.0), inside, "{p}");
                }
            }
        }
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
}
