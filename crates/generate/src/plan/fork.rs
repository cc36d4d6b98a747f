//! Forks of the skeleton as [`joint`](crate::plan::joint) needs them: their neighbors, and the way to these
//! cleared of points that would lie within the joint.

use glam::DVec3;

use super::joint::{Joint, Neighbor};
use crate::tracing::{Children, NONE, Skeleton};
use crate::warning::Warnings;

/// Free way between a joint and a neighbor's ring, in radii of that ring.
const FREE_WAY: f64 = 0.35;

/// A fork of more children will be split over several joints; as one, it would take the cube of them.
const MOST_CHILDREN: usize = 8;

/// Neighbors of a fork, the parent first if there is one.
pub(crate) fn neighbors(children: &Children, skeleton: &Skeleton, fork: u32) -> Vec<u32> {
    let parent = Some(skeleton.node(fork).parent).filter(|&p| p != NONE);
    parent
        .into_iter()
        .chain(children.of(fork).iter().copied())
        .collect()
}

/// What a joint needs to know of each neighbor.
pub(crate) fn tubes(
    skeleton: &Skeleton,
    children: &Children,
    fork: u32,
    neighbors: &[u32],
) -> Vec<Neighbor> {
    let center = skeleton.node(fork).center;
    neighbors
        .iter()
        .map(|&n| {
            let way = skeleton.node(n).center - center;
            // Two joints share the way between them.
            let share = if children.of(n).len() > 1 { 0.5 } else { 1.0 };
            Neighbor {
                direction: way.try_normalize().unwrap_or(DVec3::Y),
                length: way.length() * share,
                radius: skeleton.node(n).radius,
            }
        })
        .collect()
}

/// Leaves out ordinary points that lie within the reach of a joint beside them.
pub(crate) fn clear_the_way(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let mut total = 0;
    // Forks around which something changed.
    let mut changed = vec![true; skeleton.nodes().len()];
    for _ in 0..8 {
        let children = skeleton.children();
        let mut keep = vec![true; skeleton.nodes().len()];
        let mut dropped = 0;
        for fork in 0..skeleton.nodes().len() as u32 {
            let joins = 2..=MOST_CHILDREN;
            if !joins.contains(&children.of(fork).len()) || !changed[fork as usize] {
                continue;
            }
            changed[fork as usize] = false;
            let around = neighbors(children, skeleton, fork);
            let tubes = tubes(skeleton, children, fork, &around);
            // Where the tubes would part if their rings left them room.
            let free: Vec<Neighbor> = tubes
                .iter()
                .map(|t| Neighbor {
                    length: f64::INFINITY,
                    ..*t
                })
                .collect();
            let joint = Joint::new(skeleton.node(fork).radius, &free);
            for (i, &n) in around.iter().enumerate() {
                let node = skeleton.node(n);
                let passing = node.parent != NONE && children.of(n).len() == 1;
                let plain = passing && !node.marks.of_zone();
                let needed = joint.reach(i, tubes[i].direction) + FREE_WAY * node.radius;
                let moves = if plain {
                    skeleton.sideways(children, n)
                } else {
                    f64::INFINITY
                };
                let free = keep[n as usize] && tubes[i].length < needed;
                if free && moves < skeleton.node(fork).radius {
                    keep[n as usize] = false;
                    dropped += 1;
                    // Forks up to two nodes away see another way now.
                    let only = |n: u32| children.of(n).first().copied().unwrap_or(n);
                    let above = node.parent;
                    let above_that = Some(skeleton.node(above).parent).filter(|&p| p != NONE);
                    let below = only(n);
                    for near in [above, above_that.unwrap_or(above), below, only(below)] {
                        changed[near as usize] = true;
                    }
                }
            }
        }
        total += dropped;
        let mut kept = keep.iter();
        changed.retain(|_| kept.next() == Some(&true));
        skeleton.retain(&keep);
        if dropped == 0 {
            break;
        }
    }
    warnings.add_many(
        "near_fork",
        total,
        "point within the reach of a fork beside it: left out of the mesh",
    );
}
