//! Culling of bounding spheres by the planes of a frustum.

use glam::{DVec3, Vec4};

/// A bounding sphere: center and radius (µm).
pub type BoundingSphere = (DVec3, f64);

/// Whether a sphere, relative to the eye, reaches into the frustum.
pub fn shows(planes: &[Vec4; 5], center: glam::Vec3, radius: f32) -> bool {
    let p = center.extend(1.0);
    planes.iter().all(|plane| plane.dot(p) >= -radius)
}
