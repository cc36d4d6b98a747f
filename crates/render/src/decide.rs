//! Who is drawn: balls against the frustum and against the smallest size. The levels themselves are
//! refine's.
//!
//! Twin of the decisions in decide.wgsl. The host uses it for whole parts of templates, before anything
//! reaches the device; tests, for every patch.

use glam::{Vec3, Vec4};
use neurotess_mesh::CoarseMesh;
use neurotess_refine::{PLACES_OF_BALL, Refinement, ball_around, dequantized, pack, patch_ball};

use crate::refining::{FrameWords, Placed, Refining, Sight};
use crate::scene::Placement;
use crate::templates::MOST_PATCHES;

/// What the device must decide on every patch of a mesh at a placement: nothing where it is culled,
/// else the levels of its four sides. `values`: a level per tracing point.
pub fn decide(
    mesh: &CoarseMesh,
    values: &[u8],
    placement: &Placement,
    sight: &Sight,
    refining: &Refining,
) -> Vec<Option<[u32; 4]>> {
    let frame = FrameWords::new(sight, refining);
    let place = Placed::new(sight, placement, mesh.origin);
    let view = sight.local_view(placement, mesh.origin);
    let choice = refining.choice.scaled(placement.scale);
    let parts = pack(mesh, &[], values, MOST_PATCHES);
    let mesh = dequantized(mesh, &parts);
    let refinement = Refinement::new(&mesh, &choice.levels(view, values), &refining.options());
    let in_sight = |ball: (Vec3, f32)| shows(&frame, &place, ball.0, ball.1);
    let mut decided = vec![None; mesh.patches.len()];
    for part in &parts {
        if !in_sight(ball_around(part.balls.iter().copied())) {
            continue;
        }
        for (places, &ball) in part.patches.chunks(PLACES_OF_BALL).zip(&part.balls) {
            let there = places.iter().map(|&patch| patch as usize);
            for patch in there.filter(|&patch| patch < mesh.patches.len() && in_sight(ball)) {
                if in_sight(patch_ball(&mesh, &mesh.patches[patch])) {
                    decided[patch] = Some(refinement.patch_levels(patch));
                }
            }
        }
    }
    decided
}

/// Whether a ball in a placed part's coordinates shows. What is thinner than a pixel is drawn a pixel
/// wide.
pub(crate) fn shows(frame: &FrameWords, place: &Placed, center: Vec3, radius: f32) -> bool {
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
