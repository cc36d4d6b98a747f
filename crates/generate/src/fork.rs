//! Forks of the skeleton made ready for [`joint`](crate::joint): too many or too narrow branches
//! are split over two forks, and points in the way of the joint are left out.

use glam::DVec3;

use crate::joint::{Joint, Neighbour, plane};
use crate::skeleton::{Children, NONE, Node, Root, Skeleton};
use crate::warning::Warnings;

/// Least angle about the joint's normal between two of four or more neighbours (radians).
const LEAST_ANGLE: f64 = 0.35;
/// More neighbours than this are split over several joints.
const MOST_NEIGHBOURS: usize = 6;
/// Free way between a joint and a neighbour's ring, in radii of that ring.
const FREE_WAY: f64 = 0.35;

/// Neighbours of a fork, the parent first if there is one.
pub(crate) fn neighbours(children: &Children, skeleton: &Skeleton, fork: u32) -> Vec<u32> {
    let parent = Some(skeleton.node(fork).parent).filter(|&p| p != NONE);
    parent
        .into_iter()
        .chain(children.of(fork).iter().copied())
        .collect()
}

/// What a joint needs to know of each neighbour.
pub(crate) fn tubes(
    skeleton: &Skeleton,
    children: &Children,
    fork: u32,
    neighbours: &[u32],
) -> Vec<Neighbour> {
    let center = skeleton.node(fork).center;
    neighbours
        .iter()
        .map(|&n| {
            let way = skeleton.node(n).center - center;
            // Two joints share the way between them.
            let share = if children.of(n).len() > 1 { 0.5 } else { 1.0 };
            Neighbour {
                direction: way.try_normalize().unwrap_or(DVec3::Y),
                length: way.length() * share,
                radius: skeleton.node(n).radius,
            }
        })
        .collect()
}

/// Splits forks of four and more branches in two where two branches all but coincide as seen along
/// the joint's normal.
pub(crate) fn split_crowded(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    for _ in 0..64 {
        let children = skeleton.children();
        let mut changed = false;
        for fork in 0..skeleton.nodes.len() as u32 {
            if children.of(fork).len() < 3 {
                continue; // three neighbours at most
            }
            let around = neighbours(&children, skeleton, fork);
            if around.len() < 4 {
                continue;
            }
            let directions: Vec<DVec3> = tubes(skeleton, &children, fork, &around)
                .iter()
                .map(|t| t.direction)
                .collect();
            if around.len() <= MOST_NEIGHBOURS && plane(&directions).1 >= LEAST_ANGLE {
                continue;
            }
            split(skeleton, fork, &around, &directions);
            changed = true;
            warnings.add(
                "fork_split",
                Some(skeleton.node(fork).sample),
                "fork with branches too close to tell apart: split in two by a short segment",
            );
        }
        if !changed {
            return;
        }
        skeleton.reorder();
    }
}

/// Moves the nearest pair of neighbours to a new fork a little way towards them.
fn split(skeleton: &mut Skeleton, fork: u32, around: &[u32], directions: &[DVec3]) {
    let (mut first, mut second, mut nearest) = (0, 1, f64::NEG_INFINITY);
    for a in 0..around.len() {
        for b in a + 1..around.len() {
            let near = directions[a].dot(directions[b]);
            if near > nearest {
                (first, second, nearest) = (a, b, near);
            }
        }
    }
    let at = *skeleton.node(fork);
    let shortest = [first, second]
        .map(|i| skeleton.node(around[i]).center.distance(at.center))
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    let towards = (directions[first] + directions[second])
        .try_normalize()
        .unwrap_or(directions[first]);
    let new = skeleton.nodes.len() as u32;
    let center = at.center + towards * (1.2 * at.radius).min(0.4 * shortest);
    let node = Node {
        center,
        parent: fork,
        root: Root::Free,
        ..at
    };
    if around[first] == at.parent {
        // The new fork stands between the parent and the old one.
        skeleton.nodes.push(Node {
            parent: at.parent,
            ..node
        });
        skeleton.nodes[fork as usize].parent = new;
    } else {
        skeleton.nodes.push(node);
        skeleton.nodes[around[first] as usize].parent = new;
    }
    skeleton.nodes[around[second] as usize].parent = new;
}

/// Leaves out ordinary points that lie within the reach of a joint beside them.
pub(crate) fn clear_the_way(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let mut total = 0;
    // Forks around which something changed.
    let mut changed = vec![true; skeleton.nodes.len()];
    for _ in 0..8 {
        let children = skeleton.children();
        let mut keep = vec![true; skeleton.nodes.len()];
        let mut dropped = 0;
        for fork in 0..skeleton.nodes.len() as u32 {
            if children.of(fork).len() < 2 || !changed[fork as usize] {
                continue;
            }
            changed[fork as usize] = false;
            let around = neighbours(&children, skeleton, fork);
            let tubes = tubes(skeleton, &children, fork, &around);
            // Where the tubes would part if their rings left them room.
            let free: Vec<Neighbour> = tubes
                .iter()
                .map(|t| Neighbour {
                    length: f64::INFINITY,
                    ..*t
                })
                .collect();
            let joint = Joint::new(skeleton.node(fork).radius, &free);
            for (i, &n) in around.iter().enumerate() {
                let node = skeleton.node(n);
                let plain = node.parent != NONE && children.of(n).len() == 1;
                let needed = joint.reach(i, tubes[i].direction) + FREE_WAY * node.radius;
                let moves = if plain {
                    skeleton.sideways(&children, n)
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
