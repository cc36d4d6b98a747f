//! Two rings instead of one where a path turns back.
//!
//! ```text
//!   ──────────►╮ a        One ring cannot turn a tube by more than 120° without a fold: the tube's outer
//!              │          side is folded at the ring by as much as the path turns. Two rings, beside
//!   ◄──────────╯ b        the traced point along the bisector's normal, take half of the turn each.
//! ```
//!
//! The tip stays where it was traced, and the rings are so far apart that they do not cross.

use glam::DVec3;

use crate::skeleton::{NONE, Root, Skeleton, SkeletonNode};

/// Turns sharper than this get two rings: cosine of 105°.
const SHARP: f64 = -0.26;
/// Both neighbors are at least this many radii away, so that there is room for two rings; or so many if
/// they are sharp bends themselves: where a path goes to and fro, two rings would be in the way of the next
/// two.
const LEAST_WAY: f64 = 2.0;
const LEAST_WAY_BETWEEN: f64 = 3.2;
/// The two rings are this many times as far apart as rings that touch.
const CLEAR: f64 = 1.1;

/// Splits the nodes of sharp bends in two. `orientations`: one per node, before and after.
pub(crate) fn split_sharp_bends(skeleton: &mut Skeleton, orientations: &mut Vec<DVec3>) {
    let bends: Vec<Bend> = (0..skeleton.nodes().len() as u32)
        .filter_map(|node| Bend::new(skeleton, orientations, node))
        .collect();
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
                    center: node.center - bend.aside,
                    ..node
                });
                nodes.push(SkeletonNode {
                    center: node.center + bend.aside,
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

struct Bend {
    node: u32,
    /// From the traced point to the second ring, and back to the first.
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
        let around = [node.parent, skeleton.children().of(index)[0]];
        let near = |neighbor: u32| {
            let least = match sharp_turn(skeleton, neighbor) {
                Some(_) => LEAST_WAY_BETWEEN,
                None => LEAST_WAY,
            };
            node.center.distance(skeleton.node(neighbor).center) < least * node.radius
        };
        if around.into_iter().any(near) {
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
        let apart = CLEAR * node.radius * (0.5 * turn).sin() / (0.25 * turn).cos();
        let halfway = |a: DVec3, b: DVec3| (a + b).try_normalize().unwrap_or(along);
        Some(Self {
            node: index,
            aside: along * (0.5 * apart),
            orientations: [halfway(incoming, along), halfway(along, outgoing)],
        })
    }
}

/// Directions into and out of a node of a path that turns back there.
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
