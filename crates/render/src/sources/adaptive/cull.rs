//! What is drawn: bounding spheres against the frustum and against the smallest size. The levels themselves are
//! refine's.
//!
//! Twin of the decisions in cull.wgsl. The host uses it for whole parts of templates, before anything
//! reaches the device; tests, for every patch.

use glam::{Vec3, Vec4};
use neurotess_mesh::CoarseMesh;
use neurotess_refine::{
    Lod, PATCHES_OF_SPHERE, Refinement, dequantized, pack, patch_sphere, sphere_around,
};

use crate::scene::Placement;
use crate::scene::templates::MOST_PATCHES;
use crate::sources::adaptive::settings::{AdaptiveSettings, CullView, FrameUniforms, Placed};

/// What the device must decide on every patch of a mesh at a placement: nothing where it is culled,
/// else the levels of its four sides. `values`: a level per tracing point.
pub fn decide(
    mesh: &CoarseMesh,
    values: &[u8],
    placement: &Placement,
    sight: &CullView,
    settings: &AdaptiveSettings,
) -> Vec<Option<[u32; 4]>> {
    let frame = FrameUniforms::new(sight, settings);
    let place = Placed::new(sight, placement, mesh.origin);
    let view = sight.local_view(placement, mesh.origin);
    let lod = Lod {
        criterion: settings.lod.scaled(placement.scale),
        view,
        point_levels: values,
    };
    let parts = pack(mesh, &[], values, MOST_PATCHES);
    let mesh = dequantized(mesh, &parts);
    let refinement = Refinement::new(&mesh, lod, &settings.options());
    let in_sight = |sphere: (Vec3, f32)| shows(&frame, &place, sphere.0, sphere.1);
    let mut decided = vec![None; mesh.patches.len()];
    for part in &parts {
        if !in_sight(sphere_around(part.spheres.iter().copied())) {
            continue;
        }
        for (places, &sphere) in part.patches.chunks(PATCHES_OF_SPHERE).zip(&part.spheres) {
            let there = places.iter().map(|&patch| patch as usize);
            for patch in there.filter(|&patch| patch < mesh.patches.len() && in_sight(sphere)) {
                if in_sight(patch_sphere(&mesh, &mesh.patches[patch])) {
                    decided[patch] = Some(refinement.patch_levels(patch));
                }
            }
        }
    }
    decided
}

/// Whether a sphere in a placed part's coordinates shows. What is thinner than a pixel is drawn a pixel
/// wide.
pub(crate) fn shows(frame: &FrameUniforms, place: &Placed, center: Vec3, radius: f32) -> bool {
    let [eye, forward] = [place.eye, place.forward].map(Vec3::from_array);
    let depth = (forward.dot(center - eye) - radius).max(place.near);
    let pixel = frame.slope * depth + frame.flat / place.scale;
    let p = place.relative(center);
    let reach = (radius + pixel) * place.scale;
    for plane in frame.planes.map(Vec4::from_array) {
        // Also where it is not a number.
        let inside = plane.truncate().dot(p) + plane.w >= -reach;
        if !inside {
            return false;
        }
    }
    2.0 * radius >= frame.smallest * pixel
}
