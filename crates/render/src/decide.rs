//! Who is drawn: balls against the frustum and against the smallest size. The levels themselves are
//! refine's.
//!
//! Twin of the decisions in decide.wgsl. The host uses it for whole parts of templates, before anything
//! reaches the device; tests, for every patch.

use glam::{Vec3, Vec4};
use neurotess_mesh::CoarseMesh;
use neurotess_refine::Refinement;

use crate::refining::{CLUSTER, FrameWords, Placed, Refining, SOMA_REACH, Sight, TUBE_REACH};
use crate::scene::Placement;
use crate::templates::{ball_of, cluster_balls};

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
    let refinement = Refinement::new(mesh, &choice.levels(view, values), &refining.options());
    let clusters = cluster_balls(mesh, &mesh.patches);
    let all = clusters.iter().copied();
    let whole = crate::templates::around(all);
    let in_sight = |ball: (Vec3, f32)| shows(&frame, &place, ball.0, ball.1);
    let visible = |i: usize| {
        in_sight(whole)
            && in_sight(clusters[i / CLUSTER])
            && in_sight(ball_of(mesh, &mesh.patches[i]))
    };
    let patches = 0..mesh.patches.len();
    patches
        .map(|i| visible(i).then(|| refinement.patch_levels(i)))
        .collect()
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

/// Ball around a patch at any level, from the position and the tracing point's centre of each corner.
pub(crate) fn patch_ball(soma: bool, corners: &[(Vec3, Vec3); 4]) -> (Vec3, f32) {
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
