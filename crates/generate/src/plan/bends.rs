//! Two rings instead of one where a path turns sharply.
//!
//! ```text
//!   ──────────►╮ a        One ring, across the bisector, narrows the tube by the cosine of half the turn,
//!              │          and beyond 120° folds it on the outer side. Two rings, beside the traced point
//!   ◄──────────╯ b        along the bisector's normal, take half of the turn each.
//! ```
//!
//! The rings are so far apart that they do not cross. Where the path turns back, the tip stays where it was traced.
//! Where it turns by less, rings beside the traced point are outside of both legs, and the tube would be too thick
//! there; on the legs they would cut the corner. So they move a part of the way inwards.

use std::collections::HashMap;

use glam::DVec3;

use crate::tracing::{NONE, Root, Skeleton, SkeletonNode};

/// Turns sharper than this get two rings: cosine of 60°, where one ring would narrow the tube by 13 %.
const SHARP: f64 = 0.5;
/// At turns by more than this (radians; 105°) one ring narrows the tube by two fifths, and soon folds it. They are given
/// room even if there is none for two rings: in a zigzag, every other bend with two rings would be in the way of the
/// others.
const VERY_SHARP: f64 = 1.83;
/// The two rings are this many times as far apart as rings that touch.
const CLEAR: f64 = 1.1;
/// A neighbor is at least this many radii away, and this many times as far as rings that stand between are from their
/// traced points: where a path goes to and fro, the rings of two sharp bends would be in the way of each other.
const LEAST_WAY: f64 = 1.0;
const LEAST_WAY_PER_ASIDE: f64 = 1.4;

/// Splits the nodes of sharp bends in two. `orientations`: one per node, before and after.
pub(crate) fn split_sharp_bends(skeleton: &mut Skeleton, orientations: &mut Vec<DVec3>) {
    let bends = (0..skeleton.nodes().len() as u32)
        .filter_map(|node| Bend::new(skeleton, orientations, node))
        .collect();
    let bends = with_room(skeleton, bends);
    if bends.is_empty() {
        return;
    }
    let mut bends = bends.into_iter().peekable();
    let mut new_index = Vec::with_capacity(orientations.len());
    let (mut nodes, mut turned) = (Vec::new(), Vec::new());
    for (index, node) in (0_u32..).zip(skeleton.nodes()) {
        let parent = match node.parent {
            NONE => NONE,
            parent => new_index[parent as usize],
        };
        let node = SkeletonNode { parent, ..*node };
        match bends.next_if(|bend| bend.node == index) {
            Some(bend) => {
                nodes.push(SkeletonNode {
                    center: node.center + bend.inward - bend.aside,
                    ..node
                });
                nodes.push(SkeletonNode {
                    center: node.center + bend.inward + bend.aside,
                    parent: nodes.len() as u32 - 1,
                    ..node
                });
                turned.extend(bend.orientations);
            }
            None => {
                nodes.push(node);
                turned.push(orientations[index as usize]);
            }
        }
        // Children follow the second of two.
        new_index.push(nodes.len() as u32 - 1);
    }
    *skeleton = Skeleton::from_nodes(nodes);
    *orientations = turned;
}

/// The bends whose rings have room beside their neighbors and those of sharper bends, by node.
fn with_room(skeleton: &Skeleton, mut bends: Vec<Bend>) -> Vec<Bend> {
    bends.sort_by(|a, b| b.turn.total_cmp(&a.turn).then(a.node.cmp(&b.node)));
    // How much room bends take: those that get two rings, and the very sharp ones.
    let very_sharp = bends.iter().filter(|bend| bend.turn > VERY_SHARP);
    let mut asides: HashMap<u32, f64> = very_sharp
        .map(|bend| (bend.node, bend.aside.length()))
        .collect();
    bends.retain(|bend| {
        let node = skeleton.node(bend.node);
        let own = bend.aside.length();
        let near = |neighbor: u32| {
            let asides = own + asides.get(&neighbor).unwrap_or(&0.0);
            let least = LEAST_WAY * node.radius + LEAST_WAY_PER_ASIDE * asides;
            node.center.distance(skeleton.node(neighbor).center) < least
        };
        let has_room = !near(node.parent) && !near(skeleton.children().of(bend.node)[0]);
        if has_room {
            asides.insert(bend.node, own);
        }
        has_room
    });
    bends.sort_by_key(|bend| bend.node);
    bends
}

struct Bend {
    node: u32,
    /// By which angle the path turns (radians).
    turn: f64,
    /// From the traced point to halfway between both rings.
    inward: DVec3,
    /// From there to the second ring, and back to the first.
    aside: DVec3,
    orientations: [DVec3; 2],
}

impl Bend {
    fn new(skeleton: &Skeleton, orientations: &[DVec3], index: u32) -> Option<Self> {
        let (incoming, outgoing) = sharp_turn(skeleton, index)?;
        let node = skeleton.node(index);
        if node.root != Root::Free || node.marks.of_zone() {
            return None;
        }
        let tip = (incoming - outgoing).try_normalize()?;
        let along = incoming + outgoing;
        let along = match along.length() > 0.1 {
            true => along,
            false => orientations[index as usize],
        };
        let along = (along - tip * along.dot(tip)).try_normalize()?;
        let turn = incoming.angle_between(outgoing);
        // Rings r sin γ / cos(γ / 2) apart, γ = turn / 2 the angle between them, touch: uncross.rs.
        let aside = 0.5 * CLEAR * node.radius * (0.5 * turn).sin() / (0.25 * turn).cos();
        // With β, half the turn, the angle between `along` and the leg, the ring is `aside` sin β off the leg, of which
        // cos β is inwards.
        let inward = 0.5 * turn.sin() * aside;
        let halfway = |a: DVec3, b: DVec3| (a + b).try_normalize().unwrap_or(along);
        Some(Self {
            node: index,
            turn,
            inward: tip * -inward,
            aside: along * aside,
            orientations: [halfway(incoming, along), halfway(along, outgoing)],
        })
    }
}

/// Directions into and out of a node of a path that turns sharply there.
fn sharp_turn(skeleton: &Skeleton, index: u32) -> Option<(DVec3, DVec3)> {
    let node = skeleton.node(index);
    let &[child] = skeleton.children().of(index) else {
        return None;
    };
    if node.parent == NONE {
        return None;
    }
    let [before, after] = [node.parent, child].map(|n| skeleton.node(n).center);
    let incoming = (node.center - before).try_normalize()?;
    let outgoing = (after - node.center).try_normalize()?;
    (incoming.dot(outgoing) < SHARP).then_some((incoming, outgoing))
}
