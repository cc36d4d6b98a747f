//! Bounding spheres that hold a patch at any level, for culling. Twin: `patch_sphere` in render's
//! cull.wgsl.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Patch, PatchKind};

/// Greatest distance of a tube's surface from the segment between its centers, in radii of the
/// larger ring: the ring itself, the sway of the center line (0.24), and the bulge of a quarter
/// ellipse.
pub(crate) const TUBE_REACH: f32 = 1.5;
/// Greatest distance of a soma's patch, or one around an inset, from its center, as a multiple of the
/// distance of its farthest corner.
pub(crate) const SOMA_REACH: f32 = 1.5;

/// Bounding sphere of a patch at any level: center and radius (µm).
pub fn patch_sphere(mesh: &CoarseMesh, patch: &Patch) -> (Vec3, f32) {
    let soma = matches!(patch.kind, PatchKind::Soma | PatchKind::Loft);
    let corners = patch.corners.map(|v| {
        let vertex = &mesh.vertices[v as usize];
        (
            vertex.position,
            mesh.tracing[vertex.tracing as usize].center,
        )
    });
    let points = corners.map(|(position, center)| if soma { position } else { center });
    let middle = (points[0] + points[1] + points[2] + points[3]) * 0.25;
    let reach = |k: usize| {
        let (position, center) = corners[k];
        if soma {
            (position - middle).length() * SOMA_REACH
        } else {
            (center - middle).length() + (position - center).length() * TUBE_REACH
        }
    };
    (middle, (0..4).map(reach).fold(0.0, f32::max))
}

/// A sphere that holds these spheres, around the center of their bounding box.
pub fn sphere_around(spheres: impl Iterator<Item = (Vec3, f32)> + Clone) -> (Vec3, f32) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for (center, radius) in spheres.clone() {
        low = low.min(center - radius);
        high = high.max(center + radius);
    }
    if low.x > high.x {
        return (Vec3::ZERO, 0.0);
    }
    let middle = (low + high) / 2.0;
    let reach = spheres.map(|(center, radius)| center.distance(middle) + radius);
    // A little more, since coordinates as large as the center's are rounded.
    let slack = 1e-6 * middle.abs().max_element();
    (middle, reach.fold(0.0, f32::max) * 1.000_01 + slack)
}
