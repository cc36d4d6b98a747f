//! Where a spine leaves its dendrite, and in which direction.

use std::f64::consts::{FRAC_PI_8, TAU};

use glam::DVec3;

use super::line::Site;
use super::room::Room;
use super::shape::Spine;
use crate::random::Random;

/// Directions that are tried.
const TRIES: usize = 8;

/// A spine's place on the way from a node's parent to the node.
pub(super) struct Base {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    /// Unit vector away from the dendrite.
    pub(super) outwards: DVec3,
    pub(super) spine: Spine,
}

impl Base {
    /// The spine in a direction in which it touches nothing, if one of a few is: `towards` (across the axis) or near
    /// it, or any. Its room is taken then.
    pub(super) fn new(
        site: &Site,
        mut spine: Spine,
        towards: Option<DVec3>,
        random: &mut Random,
        room: &mut Room,
    ) -> Option<Self> {
        // As thick as the way is where it is thickest, so that necks begin outside.
        spine.begin_outside(site.widest);
        let spheres = spine.spheres();
        for attempt in 0..TRIES {
            let outwards = direction(site.axis, towards, attempt, random);
            let there =
                |&(distance, radius): &(f64, f64)| (site.center + distance * outwards, radius);
            let is_free = |sphere| {
                let (center, radius) = there(sphere);
                room.is_free(center, radius)
            };
            if !spheres.iter().all(is_free) {
                continue;
            }
            for (center, radius) in spheres.iter().map(there) {
                room.take(center, radius);
            }
            return Some(Self {
                center: site.center,
                radius: site.radius,
                outwards,
                spine,
            });
        }
        None
    }
}

/// A unit vector across the axis. The first is the one that is wanted, the next ones lie beside it on either side in
/// turn; where none is wanted, each is random.
fn direction(axis: DVec3, towards: Option<DVec3>, attempt: usize, random: &mut Random) -> DVec3 {
    let (aside, angle) = match towards {
        Some(towards) => {
            let steps = attempt.div_ceil(2) as f64;
            let side = if attempt % 2 == 1 { 1.0 } else { -1.0 };
            (towards, side * steps * FRAC_PI_8)
        }
        None => (axis.any_orthonormal_vector(), TAU * random.unit()),
    };
    libm::cos(angle) * aside + libm::sin(angle) * axis.cross(aside)
}
