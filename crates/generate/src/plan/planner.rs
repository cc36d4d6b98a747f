//! Paths: from a root, a joint or an inset along main children to an end, a joint or an inset, with the branches
//! that leave them.

use std::collections::HashMap;

use glam::DVec3;

use super::ForkChoice;
use super::arrange::Group;
use super::path::{Arm, Joint, Label, Origin, Path, PathEnd, Plan, PlannedRing};
use super::polyline::Polyline;
use super::shape::InsetShape;
use super::trunk_rings::{PlaceKind, RingPlace, nearest, rings};
use super::zone::Beginning;
use crate::tracing::{Children, NONE, Root, Skeleton};

/// Tries to lay out a path before all forks left on it become joints. A guard.
const MAX_TRIES: usize = 6;

/// A path yet to be laid out.
pub(super) enum Start {
    /// A root of the skeleton.
    Root(u32),
    /// A joint: its fork, its number once it is planned, and the child that the path leads to.
    Joint(u32, Option<u32>, u32),
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
    pub(super) plan: Plan,
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
            plan: Plan::default(),
            joint_reaches: HashMap::new(),
            ends: HashMap::new(),
        }
    }

    pub(crate) fn plan(mut self) -> Plan {
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
        self.plan
    }

    fn lay_out_all(&mut self, starts: &mut Vec<Start>) {
        while let Some(start) = starts.pop() {
            self.lay_out(&start, starts);
        }
    }

    fn lay_out(&mut self, start: &Start, starts: &mut Vec<Start>) {
        let first = match start {
            Start::Root(root) => match self.children.of(*root) {
                [] => return,
                [only] => [*root, *only],
                _ => {
                    let joint = self.add_joint(*root);
                    starts.extend(self.starts_from(*root, joint));
                    return;
                }
            },
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
        let failed = if tries < MAX_TRIES {
            forks
        } else {
            all.collect()
        };
        for fork in failed {
            self.choices[fork as usize] = ForkChoice::Joint;
            self.plan.refused.push(fork);
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

    /// Adds a path, and what starts from it to `starts`.
    pub(super) fn emit(
        &mut self,
        start: &Start,
        way: &Way,
        line: &Polyline,
        groups: &[Group],
        starts: &mut Vec<Start>,
    ) {
        let room = self.room(start, way, line);
        self.note_thickened(way, line);
        let number = self.plan.paths.len() as u32;
        let begins = match start {
            Start::Inset(inset) => Some(&**inset),
            Start::Root(_) | Start::Joint(..) => None,
        };
        let mut places = rings(line, groups, room, way.end != End::Tip);
        Self::add_upright(&mut places, line, [begins, self.end_of(way)]);
        let (start, first) = self.begin(start, way, number);
        let (end, last) = self.end(way, number);
        let mut planned = Vec::with_capacity(places.len() + 1);
        planned.push(first);
        planned.extend(places.iter().map(|place| self.ring(way, line, place)));
        // The last place is that of the way's last node: a joint or an inset stands for it.
        if let (Some(slot), Some(last)) = (planned.last_mut(), last) {
            *slot = last;
        }
        if let PathEnd::Joint(joint) = end {
            starts.extend(self.starts_from(way.nodes[way.nodes.len() - 1], joint));
        }
        let members = |group: &Group| {
            let zones = group.zones.iter();
            zones
                .map(|zone| self.begin_inset(zone, line, starts))
                .collect()
        };
        let zones = groups.iter().map(members).collect();
        self.plan.paths.push(Path {
            start,
            rings: planned,
            end,
            changes: self.section_changes(way, line),
            zones,
        });
    }

    /// What a path begins in, and the ring that stands for it.
    fn begin(&mut self, start: &Start, way: &Way, path: u32) -> (PathEnd, PlannedRing) {
        match start {
            Start::Root(root) => {
                self.plan.origins.push(Origin::Root(path));
                let end = match self.base.node(*root).root {
                    Root::Insertion(soma) => PathEnd::Soma(soma),
                    Root::Free | Root::Soma(_) => PathEnd::Free,
                };
                (end, self.traced(*root))
            }
            Start::Joint(fork, joint, _) => {
                let joint = joint.unwrap_or_else(|| self.add_joint(*fork));
                let at = &mut self.plan.joints[joint as usize];
                at.arms.push(Arm {
                    path,
                    at_end: false,
                });
                (PathEnd::Joint(joint), at.ring())
            }
            Start::Inset(inset) => {
                self.plan.insets[inset.inset as usize].path = path;
                let ring = self.inset_ring(inset, way.nodes[1]);
                (PathEnd::Inset(inset.inset), ring)
            }
        }
    }

    /// What a path ends in, and the ring that stands for it; none for that of its last node.
    fn end(&mut self, way: &Way, path: u32) -> (PathEnd, Option<PlannedRing>) {
        match (way.end, self.end_of(way).copied()) {
            (End::Joint, _) => {
                let joint = self.add_joint(way.nodes[way.nodes.len() - 1]);
                let at = &mut self.plan.joints[joint as usize];
                at.arms.push(Arm { path, at_end: true });
                (PathEnd::Joint(joint), Some(at.ring()))
            }
            (End::Inset, Some(inset)) => {
                self.plan.insets[inset.inset as usize].path = path;
                // Of a path without nodes of its own the fork stands for it.
                let labeled = match way.nodes[..] {
                    [_, .., before, _] => before,
                    _ => inset.fork,
                };
                let ring = self.inset_ring(&inset, labeled);
                (PathEnd::Inset(inset.inset), Some(ring))
            }
            (End::Tip | End::Inset, _) => (PathEnd::Free, None),
        }
    }

    /// The ring at a place of a way.
    fn ring(&self, way: &Way, line: &Polyline, place: &RingPlace) -> PlannedRing {
        let arc = place.arc;
        let kind = match place.kind {
            PlaceKind::Point(index) => {
                return PlannedRing {
                    arc,
                    ..self.traced(way.nodes[index])
                };
            }
            PlaceKind::Ring(kind) => kind,
        };
        let last = way.nodes.len() - 1;
        let node = way.nodes[nearest(line, arc).clamp(1.min(last), last)];
        let ring = self.traced(node);
        // The section and type are those of the segment that it lies on, which belongs to its lower node.
        let after = line.arcs.partition_point(|&at| at < arc).clamp(1, last);
        let lower = Label::of(self.base.node(self.lower(way, after)));
        PlannedRing {
            center: line.at(arc),
            radius: line.radius(arc),
            arc,
            kind,
            label: match ring.label.section == lower.section {
                true => ring.label,
                false => lower,
            },
            ..ring
        }
    }

    /// The lower node of a way's segment, to whose section the segment belongs; `after`: index of the segment's second node.
    fn lower(&self, way: &Way, after: usize) -> u32 {
        let [before, after] = [after - 1, after].map(|index| way.nodes[index]);
        match self.base.node(before).parent == after {
            true => before,
            false => after,
        }
    }

    /// Arc lengths at which the section of a way changes.
    fn section_changes(&self, way: &Way, line: &Polyline) -> Vec<f64> {
        let section = |after: usize| self.base.node(self.lower(way, after)).section;
        let inner = 1..way.nodes.len() - 1;
        let changes = inner.filter(|&node| section(node) != section(node + 1));
        changes.map(|node| line.arcs[node]).collect()
    }

    /// The ring of a node, as thick as its choice has it.
    fn traced(&self, node: u32) -> PlannedRing {
        PlannedRing {
            radius: self.radius(node),
            ..PlannedRing::at(node, self.base.node(node))
        }
    }

    /// Adds the joint of a fork.
    pub(super) fn add_joint(&mut self, fork: u32) -> u32 {
        let number = self.plan.joints.len() as u32;
        let node = self.base.node(fork);
        self.plan.origins.push(Origin::Joint(number));
        self.plan.joints.push(Joint {
            center: node.center,
            radius: self.radius(fork),
            normal: DVec3::Y,
            label: Label::of(node),
            fork,
            arms: Vec::new(),
        });
        number
    }

    /// The paths of a joint's children, the first one last.
    pub(super) fn starts_from(&self, fork: u32, joint: u32) -> impl Iterator<Item = Start> + use<> {
        let children = self.children.of(fork).to_vec();
        let children = children.into_iter().rev();
        children.map(move |child| Start::Joint(fork, Some(joint), child))
    }

    /// Notes which forks on a way are thicker than they were traced.
    fn note_thickened(&mut self, way: &Way, line: &Polyline) {
        for &(index, _) in &way.branches {
            let fork = way.nodes[index];
            let known = self.plan.thickened.last() == Some(&fork);
            if !known && line.radii[index] > self.base.node(fork).radius {
                self.plan.thickened.push(fork);
            }
        }
    }
}
