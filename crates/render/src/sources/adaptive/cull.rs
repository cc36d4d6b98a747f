//! What is drawn: culls bounding spheres by the frustum and by the smallest size. The levels
//! themselves are refine's.
//!
//! CPU twin of the decisions in cull.wgsl. The host culls whole parts of templates with it, before
//! anything reaches the device; tests cull every patch.

use glam::{Vec3, Vec4};
use neurotess_mesh::CoarseMesh;
use neurotess_refine::{
    Lod, PATCHES_OF_SPHERE, Refinement, dequantized, pack, patch_sphere, sphere_around,
};

use crate::scene::templates::MAX_PATCHES;
use crate::sources::adaptive::settings::{FlatIndices, FrameUniforms, Placed};
use neurotess_picture::Placement;
use neurotess_picture::{AdaptiveSettings, CullView};

/// What the device must decide for every patch of a mesh at a placement: nothing if it is culled,
/// else the levels of its four sides. `values`: a level per tracing point.
pub fn decide(
    mesh: &CoarseMesh,
    values: &[u8],
    placement: &Placement,
    view: &CullView,
    settings: &AdaptiveSettings,
) -> Vec<Option<[u32; 4]>> {
    let frame = FrameUniforms::new(view, settings, FlatIndices::default());
    let placed = Placed::new(view, placement, mesh.origin);
    let lod = Lod {
        criterion: settings.lod.scaled(placement.scale),
        view: view.local_view(placement, mesh.origin),
        point_levels: values,
        edges: None,
    };
    let parts = pack(mesh, &[], values, MAX_PATCHES);
    let mesh = dequantized(mesh, &parts);
    let refinement = Refinement::new(&mesh, lod, &settings.options());
    let in_view = |sphere: (Vec3, f32)| shows(&frame, &placed, sphere.0, sphere.1);
    let mut decided = vec![None; mesh.patches.len()];
    for part in &parts {
        if !in_view(sphere_around(part.spheres.iter().copied())) {
            continue;
        }
        for (patches, &sphere) in part.patches.chunks(PATCHES_OF_SPHERE).zip(&part.spheres) {
            let patches = patches.iter().map(|&patch| patch as usize);
            for patch in patches.filter(|&patch| patch < mesh.patches.len() && in_view(sphere)) {
                if in_view(patch_sphere(&mesh, &mesh.patches[patch])) {
                    decided[patch] = Some(refinement.patch_levels(patch));
                }
            }
        }
    }
    decided
}

/// Whether a sphere in a placed part's coordinates shows. It may reach a pixel further, since thin
/// tubes are drawn a pixel wide.
pub(crate) fn shows(frame: &FrameUniforms, placed: &Placed, center: Vec3, radius: f32) -> bool {
    let [eye, forward] = [placed.eye, placed.forward].map(Vec3::from_array);
    let depth = (forward.dot(center - eye) - radius).max(placed.near);
    let pixel = frame.slope * depth + frame.flat / placed.scale;
    let p = placed.relative(center);
    let reach = (radius + pixel) * placed.scale;
    for plane in frame.planes.map(Vec4::from_array) {
        // Written so that a position that is not a number is outside.
        let inside = plane.truncate().dot(p) + plane.w >= -reach;
        if !inside {
            return false;
        }
    }
    2.0 * radius >= frame.smallest * pixel
}
