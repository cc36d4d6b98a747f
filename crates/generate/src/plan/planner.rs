//! Paths: from a root, a joint or an inset along main children to an end, a joint or an inset, with the branches
//! that leave them.

use std::collections::HashMap;

use glam::DVec3;

use super::arrange::Group;
use super::polyline::Polyline;
use super::shape::InsetShape;
use super::trunk_rings::{RingKind, nearest, rings};
use super::zone::Beginning;
use super::{ForkChoice, Inset, Layout};
use crate::tracing::{Children, Marks, NONE, Root, Skeleton, SkeletonNode};

/// Tries to lay out a path before all forks left on it become joints.
const MOST_TRIES: usize = 6;

/// A path yet to be laid out.
pub(super) enum Start {
    /// A root of the skeleton.
    Root(u32),
    /// A joint: its node, that in the new skeleton, and the child that the path leads to.
    Joint(u32, u32, u32),
    /// An inset.
    Inset(Box<PathInset>),
}

/// An inset that a path begins or ends in.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathInset {
    pub(super) inset: u32,
    pub(super) shape: InsetShape,
    pub(super) fork: u32,
    /// The path's next node, or at its end the last one before the inset.
    pub(super) way: Beginning,
    pub(super) radius: f64,
    /// Way from the inset to where a branch is clear that leaves its trunk side by side with it (µm).
    pub(super) clear: Option<f64>,
}

pub(crate) struct Planner<'a> {
    pub(super) base: &'a Skeleton,
    pub(super) children: &'a Children,
    pub(super) choices: Vec<ForkChoice>,
    pub(super) nodes: Vec<SkeletonNode>,
    pub(super) insets: Vec<Inset>,
    zones: Vec<Vec<u32>>,
    pub(super) refused: Vec<u32>,
    thickened: Vec<u32>,
    pub(super) buried: Vec<u32>,
    /// By fork, once asked for: its neighbors, and how far its joint reaches towards them.
    pub(super) joint_reaches: HashMap<u32, Vec<(u32, f64)>>,
    /// By fork whose children are the trunk, once that is laid out: how the parent ends.
    pub(super) ends: HashMap<u32, PathInset>,
}

/// A path's nodes and where branches leave it.
pub(super) struct Way {
    /// Nodes of the skeleton from the start to the end, both included.
    pub(super) nodes: Vec<u32>,
    /// Index in `nodes` of the fork, the child, by branch.
    pub(super) branches: Vec<(usize, u32)>,
    pub(super) end: End,
}

/// What a path ends in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Tip,
    Joint,
    /// The inset of its last node's fork.
    Inset,
}

impl<'a> Planner<'a> {
    pub(crate) fn new(base: &'a Skeleton, choices: &[ForkChoice]) -> Self {
        Self {
            base,
            children: base.children(),
            choices: choices.to_vec(),
            nodes: Vec::with_capacity(base.nodes().len() + 64),
            insets: Vec::new(),
            zones: Vec::new(),
            refused: Vec::new(),
            thickened: Vec::new(),
            buried: Vec::new(),
            joint_reaches: HashMap::new(),
            ends: HashMap::new(),
        }
    }

    pub(crate) fn plan(mut self) -> Layout {
        let mut starts = Vec::new();
        // Trunks first, so that the paths that end on them find them; those farthest from the root first of all.
        for fork in (0..self.choices.len() as u32).rev() {
            if self.choices[fork as usize].is_across() {
                self.lay_out_across(fork, &mut starts);
                self.lay_out_all(&mut starts);
            }
        }
        for (root, node) in (0..).zip(self.base.nodes()) {
            if node.parent == NONE {
                starts.push(Start::Root(root));
            }
            self.lay_out_all(&mut starts);
        }
        Layout {
            skeleton: Skeleton::from_nodes(self.nodes),
            insets: self.insets,
            zones: self.zones,
            refused: self.refused,
            thickened: self.thickened,
            buried: self.buried,
        }
    }

    fn lay_out_all(&mut self, starts: &mut Vec<Start>) {
        while let Some(start) = starts.pop() {
            self.lay_out(&start, starts);
        }
    }

    fn lay_out(&mut self, start: &Start, starts: &mut Vec<Start>) {
        let first = match start {
            Start::Root(root) => {
                let children = self.children.of(*root);
                let node = *self.base.node(*root);
                if children.len() != 1 {
                    // A joint at the very beginning, or a single point.
                    let joint = self.copy(*root, NONE, node.root);
                    starts.extend(
                        children
                            .iter()
                            .rev()
                            .map(|&c| Start::Joint(*root, joint, c)),
                    );
                    return;
                }
                [*root, children[0]]
            }
            Start::Joint(fork, _, child) => [*fork, *child],
            Start::Inset(inset) => match inset.way {
                Beginning::At(node) => [inset.fork, node],
                Beginning::Ends(node) => return self.end_ahead(inset, node),
            },
        };
        for tries in 0.. {
            let way = self.walk(first);
            let path = self.polyline(start, &way);
            match self.zones_of(start, &way, &path) {
                Ok(groups) => return self.emit(start, &way, &path, &groups, starts),
                Err(forks) => self.refuse(&way, forks, tries),
            }
        }
    }

    /// Makes joints of forks that have no room for their insets; of all on the path after many tries.
    pub(super) fn refuse(&mut self, way: &Way, forks: Vec<u32>, tries: usize) {
        let all = way.branches.iter().map(|&(i, _)| way.nodes[i]);
        let failed = if tries < MOST_TRIES {
            forks
        } else {
            all.collect()
        };
        for fork in failed {
            self.choices[fork as usize] = ForkChoice::Joint;
            self.refused.push(fork);
        }
    }

    /// Main children from the first two nodes on, up to an end, a joint or an inset.
    pub(super) fn walk(&self, first: [u32; 2]) -> Way {
        let mut way = Way {
            nodes: first.to_vec(),
            branches: Vec::new(),
            end: End::Tip,
        };
        loop {
            let last = way.nodes.len() - 1;
            let here = way.nodes[last];
            let children = self.children.of(here);
            match children {
                [] => return way,
                [only] => way.nodes.push(*only),
                _ if self.choices[here as usize] == ForkChoice::Joint => {
                    way.end = End::Joint;
                    return way;
                }
                _ if let Some(inset) = self.ends.get(&here) => {
                    way.end_in(inset, here);
                    return way;
                }
                _ => {
                    let Some(main) = self.trunk_child(way.nodes[last - 1], here) else {
                        way.end = End::Joint;
                        return way;
                    };
                    let rest = children.iter().filter(|&&child| child != main);
                    way.branches.extend(rest.map(|&child| (last, child)));
                    way.nodes.push(main);
                }
            }
        }
    }

    pub(super) fn polyline(&self, start: &Start, way: &Way) -> Polyline {
        let nodes = way.nodes.iter();
        let mut centers: Vec<DVec3> = nodes.clone().map(|&n| self.base.node(n).center).collect();
        let mut radii: Vec<f64> = nodes.map(|&n| self.radius(n)).collect();
        match start {
            Start::Root(_) => {}
            Start::Joint(..) => radii[0] = radii[0].min(radii[1]),
            Start::Inset(inset) => {
                centers[0] = inset.shape.center;
                radii[0] = inset.radius;
            }
        }
        if let Some(inset) = self.end_of(way) {
            let last = centers.len() - 1;
            centers[last] = inset.shape.center;
            radii[last] = inset.radius;
        }
        Polyline::new(centers, radii)
    }

    /// Adds a path's nodes, and what starts from it to `starts`.
    pub(super) fn emit(
        &mut self,
        start: &Start,
        way: &Way,
        path: &Polyline,
        groups: &[Group],
        starts: &mut Vec<Start>,
    ) {
        let room = self.room(start, way, path);
        for &(index, _) in &way.branches {
            let fork = way.nodes[index];
            let known = self.thickened.last() == Some(&fork);
            if !known && path.radii[index] > self.base.node(fork).radius {
                self.thickened.push(fork);
            }
        }
        let first_zone = self.zones.len() as u32;
        let last = way.nodes.len() - 1;
        let mut parent = match start {
            Start::Root(root) => self.copy(*root, NONE, self.base.node(*root).root),
            Start::Joint(_, joint, _) => *joint,
            Start::Inset(inset) => self.inset_root(inset, way.nodes[1]),
        };
        let mut rings = rings(path, groups, room, way.end != End::Tip);
        let begins = match start {
            Start::Inset(inset) => Some(&**inset),
            Start::Root(_) | Start::Joint(..) => None,
        };
        Self::add_upright(&mut rings, path, [begins, self.end_of(way)]);
        for ring in rings {
            parent = match ring.what {
                RingKind::Point(index) if index == last && way.end == End::Inset => {
                    self.end_in_inset(way, parent)
                }
                RingKind::Point(index) => self.copy(way.nodes[index], parent, Root::Free),
                RingKind::Zone(begins, ends) => {
                    let number =
                        |group: Option<usize>| group.map_or(NONE, |g| first_zone + g as u32);
                    let nearest = nearest(path, ring.arc);
                    let base = way.nodes[nearest.clamp(1.min(last), last)];
                    let node = self.base.node(base);
                    self.nodes.push(SkeletonNode {
                        center: path.at(ring.arc),
                        radius: path.radius(ring.arc),
                        parent,
                        root: Root::Free,
                        marks: Marks {
                            zone_begins: number(begins),
                            zone_ends: number(ends),
                            base,
                            ..Marks::default()
                        },
                        ..*node
                    });
                    self.nodes.len() as u32 - 1
                }
            };
        }
        if way.end == End::Joint {
            let (joint, fork) = (parent, way.nodes[last]);
            self.nodes[joint as usize].marks.fork = fork;
            let children = self.children.of(fork).iter().rev();
            starts.extend(children.map(|&child| Start::Joint(fork, joint, child)));
        }
        for group in groups {
            let members = group
                .zones
                .iter()
                .map(|zone| self.begin_inset(zone, path, starts));
            let members = members.collect();
            self.zones.push(members);
        }
    }

    /// Copies a node; forks remember which they are.
    pub(super) fn copy(&mut self, node: u32, parent: u32, root: Root) -> u32 {
        let fork = if self.children.of(node).len() > 1 {
            node
        } else {
            NONE
        };
        self.nodes.push(SkeletonNode {
            radius: self.radius(node),
            parent,
            root,
            marks: Marks {
                fork,
                base: node,
                on_soma: self.base.node(node).marks.on_soma,
                ..Marks::default()
            },
            ..*self.base.node(node)
        });
        self.nodes.len() as u32 - 1
    }
}
