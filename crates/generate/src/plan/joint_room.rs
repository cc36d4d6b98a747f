//! The way to a joint, cleared of rings that would lie within it.

use std::collections::BTreeSet;

use super::clearance::FREE_WAY;
use super::joint::{JointShape, Neighbor};
use super::path::{Path, PathEnd, Plan};
use crate::tracing::off_segment;
use crate::warning::Warnings;

/// Times that all joints are looked at: what is left out changes the directions of what is beside it. A guard.
const MAX_ROUNDS: usize = 8;

/// Leaves out rings that lie within the reach of a joint beside them.
pub(crate) fn clear_the_way(plan: &mut Plan, warnings: &mut Warnings) {
    let mut total = 0;
    let mut changed: BTreeSet<u32> = (0..plan.joints.len() as u32).collect();
    for _ in 0..MAX_ROUNDS {
        // By path and ring, from the highest of each path down.
        let mut dropped: BTreeSet<(u32, usize)> = BTreeSet::new();
        for &joint in &changed {
            within_reach(plan, joint, &mut dropped);
        }
        changed.clear();
        total += dropped.len();
        for (path, ring) in dropped.into_iter().rev() {
            let path = &mut plan.paths[path as usize];
            path.rings.remove(ring);
            changed.extend([path.start, path.end].into_iter().filter_map(joint_of));
        }
        if changed.is_empty() {
            break;
        }
    }
    warnings.add_many(
        "near_fork",
        total,
        "point within the reach of a fork beside it: left out of the mesh",
    );
}

/// Adds the rings next to a joint that it reaches, and that may be left out, to `dropped`.
fn within_reach(plan: &Plan, joint: u32, dropped: &mut BTreeSet<(u32, usize)>) {
    let joint = &plan.joints[joint as usize];
    let neighbors = plan.neighbors(joint);
    // Where the tubes would part if their rings left them room.
    let free: Vec<Neighbor> = neighbors.iter().map(|n| n.without_limit()).collect();
    let shape = JointShape::new(joint.radius, &free);
    for ((slot, &arm), neighbor) in joint.arms.iter().enumerate().zip(&neighbors) {
        let (path, ring) = (&plan.paths[arm.path as usize], plan.first_ring(arm));
        let planned = &path.rings[ring];
        let needed = shape.reach(slot, neighbor.direction) + FREE_WAY * planned.radius;
        let is_between = ring > 0 && ring < path.last();
        if is_between
            && !planned.is_of_zone()
            && neighbor.length < needed
            && sideways(path, ring) < joint.radius
        {
            dropped.insert((arm.path, ring));
        }
    }
}

/// How far a path moves if a ring between others is left out (µm).
fn sideways(path: &Path, ring: usize) -> f64 {
    let center = |ring: usize| path.rings[ring].center;
    off_segment(center(ring), center(ring - 1), center(ring + 1))
}

fn joint_of(end: PathEnd) -> Option<u32> {
    match end {
        PathEnd::Joint(joint) => Some(joint),
        PathEnd::Free | PathEnd::Soma(_) | PathEnd::Inset(_) => None,
    }
}
