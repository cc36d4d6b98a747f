//! Cameras that have a whole scene in the picture.

use glam::DVec3;

use crate::view::camera::{Camera, CameraError};
use crate::view::frustum::BoundingSphere;
use crate::view::lens::{Lens, Projection};

/// Sides to look from. Cells are upright along y; x points right, z towards the front.
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
    /// From the right, above and the front.
    Iso,
}

/// Field of view (radians) by default: little distortion, as through a long lens.
pub const DEFAULT_FOV: f64 = 20.0 * std::f64::consts::PI / 180.0;

impl Side {
    /// Directions from the target to the eye, and upwards.
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
    /// The nearest camera on this side that has all spheres in the picture, with a `margin` (share
    /// of its width and height) free on each side. `lens`: a [`Lens`], or the vertical angle of view
    /// (radians) of a perspective one. `aspect` is width by height. Without spheres it looks at the
    /// origin from 100 µm away.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn fit(
        side: Side,
        lens: impl Into<Lens>,
        aspect: f64,
        margin: f64,
        spheres: &[BoundingSphere],
    ) -> Result<Self, CameraError> {
        Self::fit_within(side, lens, aspect, [margin; 4], spheres)
    }

    /// Like [`Camera::fit`], with a margin for each side: left, right, top, bottom.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn fit_within(
        side: Side,
        lens: impl Into<Lens>,
        aspect: f64,
        margins: [f64; 4],
        spheres: &[BoundingSphere],
    ) -> Result<Self, CameraError> {
        let lens = lens.into();
        let (backward, up) = side.axes();
        let start = Self::new(backward, DVec3::ZERO, up, lens)?;
        if spheres.is_empty() {
            return Self::new(backward * 100.0, DVec3::ZERO, up, lens);
        }
        let (tan_x, tan_y) = start.tangents(aspect, 0.0);
        let [left, right, top, bottom] = margins.map(|m| 1.0 - 2.0 * m.clamp(0.0, 0.45));
        if lens.projection == Projection::Orthographic {
            let (low, high) = start.extent(spheres);
            let size = high - low;
            let height =
                (2.0 * size.y / (top + bottom)).max(2.0 * size.x / (left + right) / aspect);
            let middle = (low + high) / 2.0
                - DVec3::new((right - left) * aspect, top - bottom, 0.0) * height / 4.0;
            return start.at(middle, height);
        }
        // Position of the eye along an axis, and its distance, at which the planes on both sides
        // touch the spheres.
        let touch = |axis: usize, low_tan: f64, high_tan: f64| {
            let (mut low, mut high) = (f64::MAX, f64::MIN);
            let (low_slant, high_slant) = (low_tan.hypot(1.0), high_tan.hypot(1.0));
            for &(center, radius) in spheres {
                let v = start.view_from_world * center;
                high = high.max(v[axis] + high_tan * v.z + radius * high_slant);
                low = low.min(v[axis] - low_tan * v.z - radius * low_slant);
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
        // If the other axis needs a larger distance, the spheres are centered between the margins.
        let x = x + (depth - depth_x) * tan_x * (left - right) / 2.0;
        let y = y + (depth - depth_y) * tan_y * (bottom - top) / 2.0;
        let nearest = spheres
            .iter()
            .map(|&(center, radius)| (start.view_from_world * center).z + radius)
            .fold(f64::MIN, f64::max);
        let middle = start.view_from_world * mean(spheres);
        // At some distance also from a scene without extent, and never inside the nearest sphere.
        let depth = depth.max(nearest + 1e-3 * (nearest - middle.z).abs().max(1e-3));
        let eye = DVec3::new(x, y, depth);
        let target = DVec3::new(x, y, middle.z.min(nearest - 1e-6).min(depth - 1e-3));
        let world = start.view_from_world.transpose();
        Self::new(world * eye, world * target, up, lens)
    }

    /// The nearest camera that has all spheres in the picture at any angle of [`Camera::turned`].
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn fit_turning(
        side: Side,
        lens: impl Into<Lens>,
        aspect: f64,
        margin: f64,
        spheres: &[BoundingSphere],
    ) -> Result<Self, CameraError> {
        let lens = lens.into();
        let still = Self::fit(side, lens, aspect, margin, spheres)?;
        let (tan_x, tan_y) = still.tangents(aspect, margin);
        let [right, up, backward] = still.axes();
        if spheres.is_empty() {
            return Ok(still);
        }
        let (low, high) = still.extent(spheres);
        let middle = (low + high) / 2.0;
        if lens.projection == Projection::Orthographic {
            let mut half: f64 = 0.0;
            for &(center, radius) in spheres {
                let v = still.view_from_world * center - middle;
                half = half
                    .max((v.x.hypot(v.z) + radius) / aspect)
                    .max(v.y.abs() + radius);
            }
            let free = 1.0 - 2.0 * margin.clamp(0.0, 0.49);
            return still.at(middle, 2.0 * half / free);
        }
        let mut distance: f64 = 0.0;
        for &(center, radius) in spheres {
            let v = still.view_from_world * center - middle;
            let around = v.x.hypot(v.z);
            // ρ (sin θ + t cos θ) is at most ρ √(1 + t²).
            distance = distance
                .max((around + radius) * tan_x.hypot(1.0) / tan_x)
                .max(around + (v.y.abs() + radius * tan_y.hypot(1.0)) / tan_y);
        }
        let target = right * middle.x + up * middle.y + backward * middle.z;
        Self::new(target + backward * distance.max(1e-3), target, up, lens)
    }

    /// The least and the greatest coordinates of spheres in the view: right, up, backward.
    fn extent(&self, spheres: &[BoundingSphere]) -> (DVec3, DVec3) {
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for &(center, radius) in spheres {
            let v = self.view_from_world * center;
            low = low.min(v - radius);
            high = high.max(v + radius);
        }
        (low, high)
    }

    /// A camera in the same direction with a target (in the view) that is as far away as makes the
    /// picture this high (µm) there.
    fn at(&self, target: DVec3, height: f64) -> Result<Self, CameraError> {
        let distance = (height / 2.0).max(1e-3) / self.lens().tan();
        let [_, up, backward] = self.axes();
        let target = self.view_from_world.transpose() * target;
        Self::new(target + backward * distance, target, up, self.lens())
    }
}

fn mean(spheres: &[BoundingSphere]) -> DVec3 {
    let sum: DVec3 = spheres.iter().map(|&(center, _)| center).sum();
    sum / spheres.len().max(1) as f64
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

    const LENSES: [Lens; 2] = [
        Lens {
            fov: 0.5,
            projection: Projection::Perspective,
        },
        Lens {
            fov: 0.5,
            projection: Projection::Orthographic,
        },
    ];

    fn spheres() -> Vec<BoundingSphere> {
        (0..40)
            .map(|i| {
                let t = f64::from(i);
                let center = DVec3::new(t.sin() * 300.0, t * 7.0 - 1e4, (2.0 * t).cos() * 50.0);
                (center, 1.0 + t / 4.0)
            })
            .collect()
    }

    /// Greatest coordinate that a sphere reaches in the picture, whose borders are at −1 and 1.
    fn reach(camera: &Camera, aspect: f64, spheres: &[BoundingSphere]) -> f64 {
        let planes = camera.frustum(aspect, 1e-3);
        let mut most = f64::MIN;
        for &(center, radius) in spheres {
            let p = (center - camera.eye()).as_vec3().extend(1.0);
            for plane in &planes[..4] {
                most = most.max(radius - f64::from(plane.dot(p)));
            }
        }
        most
    }

    #[test]
    fn fitted_spheres_touch_the_frustum_from_within() {
        for side in SIDES {
            for aspect in [0.3, 1.0, 2.5] {
                for lens in LENSES {
                    let camera = Camera::fit(side, lens, aspect, 0.0, &spheres()).expect("fits");
                    let most = reach(&camera, aspect, &spheres());
                    assert!(most.abs() < 0.01, "{side:?} {aspect}: {most}");
                }
            }
        }
    }

    #[test]
    fn margins_stay_free() {
        let margins = [0.3, 0.05, 0.02, 0.1];
        for (aspect, lens) in [0.5, 2.0].into_iter().flat_map(|a| LENSES.map(|l| (a, l))) {
            let camera = Camera::fit_within(Side::Iso, lens, aspect, margins, &spheres());
            let camera = camera.expect("fits");
            let size = [(4000.0 * aspect) as u32, 4000];
            let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
            for (center, _) in spheres() {
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
        for (side, lens) in SIDES.into_iter().flat_map(|s| LENSES.map(|l| (s, l))) {
            let camera = Camera::fit_turning(side, lens, 1.5, 0.0, &spheres()).expect("fits");
            for step in 0..24 {
                let turned = camera.turned(f64::from(step) * 0.3);
                assert!(reach(&turned, 1.5, &spheres()) < 0.01, "{side:?} {step}");
            }
            let whole = camera.turned(std::f64::consts::TAU);
            assert!(whole.eye().distance(camera.eye()) < 1e-6);
        }
    }

    #[test]
    fn scenes_without_extent_have_a_camera() {
        for side in SIDES {
            let point = [(DVec3::new(1.0, 2.0, 3.0), 0.0)];
            for lens in LENSES {
                assert!(Camera::fit(side, lens, 1.0, 0.1, &[]).is_ok());
                assert!(Camera::fit(side, lens, 1.0, 0.1, &point).is_ok());
                assert!(Camera::fit_turning(side, lens, 1.0, 0.1, &point).is_ok());
            }
        }
    }
}
