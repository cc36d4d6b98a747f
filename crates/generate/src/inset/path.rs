//! Paths: from a root, a joint or an inset along main children to an end or a joint, with the branches
//! that leave them.

use glam::DVec3;

use super::arrange::{Group, arrange};
use super::cone::distance;
use super::polyline::Polyline;
use super::shape::{InsetShape, InsetSite};
use super::zone::{Branch, NoZone, Zone};
use super::{ForkChoice, Inset, Layout};
use crate::fork;
use crate::joint::{Joint, Neighbor};
use crate::skeleton::{Children, Marks, NONE, Root, Skeleton, SkeletonNode};

/// Weight of a child's direction beside its relative radius when the trunk's continuation is chosen.
const STRAIGHTNESS: f64 = 0.5;
/// A branch may be this much thicker than its trunk.
const MOST_THICK: f64 = 1.05;
/// Free way beside a zone's rings, in radii of the trunk.
const BESIDE_ZONE: f64 = 0.35;
/// Free way between the inset's corners and the branch's next ring, in radii.
const AHEAD: f64 = 0.35;
/// The branch's rings begin outside the trunk by this share of their radius.
const CLEAR: f64 = 1.05;
/// Points of a branch that are looked at to find its way out.
const MOST_LOOKED_AT: usize = 40;
/// A fork of more children becomes joints: branches of one point need a side of the trunk each.
const MOST_CHILDREN: usize = 4;
/// A fork of more neighbors is split into several joints, none of which reaches far.
const MOST_NEIGHBORS: usize = 6;
/// Tries to lay out a path before all forks left on it become joints.
const MOST_TRIES: usize = 6;

/// A path yet to be laid out.
enum Start {
    /// A root of the skeleton.
    Root(u32),
    /// A joint: its node, that in the new skeleton, and the child that the path leads to.
    Joint(u32, u32, u32),
    /// An inset with its first node.
    Inset(Box<InsetStart>),
}

struct InsetStart {
    inset: u32,
    shape: InsetShape,
    fork: u32,
    way: Beginning,
    radius: f64,
}

/// How a branch goes on from its inset.
enum Beginning {
    /// At a node that is clear of the trunk.
    At(u32),
    /// It ends before: at a ring right ahead, with the last node's attributes.
    Ends(u32),
}

pub(crate) struct Planner<'a> {
    base: &'a Skeleton,
    children: &'a Children,
    choices: Vec<ForkChoice>,
    nodes: Vec<SkeletonNode>,
    insets: Vec<Inset>,
    zones: Vec<Vec<u32>>,
    refused: Vec<u32>,
    buried: Vec<u32>,
}

/// A path's nodes and where branches leave it.
struct Way {
    /// Nodes of the skeleton from the start to the end, both included.
    nodes: Vec<u32>,
    /// Index in `nodes` of the fork, the child, by branch.
    branches: Vec<(usize, u32)>,
    ends_at_joint: bool,
}

/// A ring on a path.
#[derive(Clone, Copy, Debug)]
struct Ring {
    arc: f64,
    what: RingKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum RingKind {
    /// A point of the path, by its index.
    Point(usize),
    /// A zone's ring: the group that begins with it, and the one that ends.
    Zone(Option<usize>, Option<usize>),
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
            buried: Vec::new(),
        }
    }

    pub(crate) fn plan(mut self) -> Layout {
        let mut starts = Vec::new();
        for (root, node) in (0..).zip(self.base.nodes()) {
            if node.parent == NONE {
                starts.push(Start::Root(root));
            }
            while let Some(start) = starts.pop() {
                self.lay_out(start, &mut starts);
            }
        }
        Layout {
            skeleton: Skeleton::from_nodes(self.nodes),
            insets: self.insets,
            zones: self.zones,
            refused: self.refused,
            buried: self.buried,
        }
    }

    fn lay_out(&mut self, start: Start, starts: &mut Vec<Start>) {
        let first = match &start {
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
            let path = self.polyline(&start, &way);
            match self.zones_of(&start, &way, &path) {
                Ok(groups) => return self.emit(&start, &way, &path, &groups, starts),
                Err(forks) => {
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
            }
        }
    }

    /// Main children from the first two nodes on, up to an end or a joint.
    fn walk(&self, first: [u32; 2]) -> Way {
        let mut way = Way {
            nodes: first.to_vec(),
            branches: Vec::new(),
            ends_at_joint: false,
        };
        loop {
            let last = way.nodes.len() - 1;
            let here = way.nodes[last];
            let children = self.children.of(here);
            match children {
                [] => return way,
                [only] => way.nodes.push(*only),
                _ if self.choices[here as usize] == ForkChoice::Joint => {
                    way.ends_at_joint = true;
                    return way;
                }
                _ => {
                    let main = self.main_child(way.nodes[last - 1], here);
                    if !self.leaves_through_insets(here, main) {
                        way.ends_at_joint = true;
                        return way;
                    }
                    let rest = children.iter().filter(|&&child| child != main);
                    way.branches.extend(rest.map(|&child| (last, child)));
                    way.nodes.push(main);
                }
            }
        }
    }

    /// The child that continues the trunk: thick and straight on.
    fn main_child(&self, before: u32, fork: u32) -> u32 {
        let direction = |a: u32, b: u32| {
            let way = self.base.node(b).center - self.base.node(a).center;
            way.normalize_or_zero()
        };
        let (incoming, radius) = (direction(before, fork), self.radius(fork));
        let score = |&child: &u32| {
            let relative = self.base.node(child).radius / radius;
            relative + STRAIGHTNESS * incoming.dot(direction(fork, child))
        };
        let children = self.children.of(fork).iter().copied();
        let best = children.reduce(|best, c| if score(&c) > score(&best) { c } else { best });
        best.expect("a fork has children")
    }

    /// Radius of a node; of a fork, as its choice has it.
    fn radius(&self, node: u32) -> f64 {
        let own = self.base.node(node).radius;
        let thickened = matches!(
            self.choices[node as usize],
            ForkChoice::Inset {
                thickened: true,
                ..
            }
        );
        if !thickened || self.children.of(node).len() < 2 {
            return own;
        }
        let around = fork::neighbors(self.children, self.base, node).into_iter();
        let mut radii: Vec<f64> = around.map(|n| self.base.node(n).radius).collect();
        radii.sort_by(f64::total_cmp);
        own.max(radii[radii.len() - 2])
    }

    fn leaves_through_insets(&self, fork: u32, main: u32) -> bool {
        let [here, main_radius] = [fork, main].map(|n| self.radius(n));
        let trunk = if main_radius > 0.3 * here {
            here.min(main_radius)
        } else {
            here
        };
        if self.children.of(fork).len() > MOST_CHILDREN {
            return false;
        }
        let mut others = self.children.of(fork).iter().filter(|&&c| c != main);
        others.all(|&child| self.base.node(child).radius < MOST_THICK * trunk)
    }

    fn polyline(&self, start: &Start, way: &Way) -> Polyline {
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
        Polyline::new(centers, radii)
    }

    /// Arc lengths that the path's own ends leave free for zones.
    fn room(&self, start: &Start, way: &Way, path: &Polyline) -> [f64; 2] {
        let last = way.nodes.len() - 1;
        let low = match start {
            Start::Root(_) => 0.0,
            Start::Joint(fork, _, child) => self.joint_reach(*fork, *child) + 0.35 * path.radii[1],
            Start::Inset(inset) => inset.shape.reach + 0.35 * inset.radius,
        };
        let high = if way.ends_at_joint {
            let reach = self.joint_reach(way.nodes[last], way.nodes[last - 1]);
            path.length() - reach - 0.35 * path.radii[last - 1]
        } else {
            path.length()
        };
        [low, high]
    }

    /// How far a joint reaches towards a neighbor, with room for all.
    fn joint_reach(&self, fork: u32, neighbor: u32) -> f64 {
        if self.children.of(fork).len() >= MOST_NEIGHBORS {
            return 2.0 * self.base.node(fork).radius;
        }
        let around = fork::neighbors(self.children, self.base, fork);
        let tubes = fork::tubes(self.base, self.children, fork, &around);
        let free: Vec<Neighbor> = tubes
            .iter()
            .map(|tube| Neighbor {
                length: f64::INFINITY,
                ..*tube
            })
            .collect();
        let joint = Joint::new(self.base.node(fork).radius, &free);
        // The node before a joint on its path may lie beyond an inset: then the parent stands for it.
        let slot = around.iter().position(|&n| n == neighbor).unwrap_or(0);
        joint.reach(slot, free[slot].direction)
    }

    fn zones_of(
        &mut self,
        start: &Start,
        way: &Way,
        path: &Polyline,
    ) -> Result<Vec<Group>, Vec<u32>> {
        let room = self.room(start, way, path);
        let (mut zones, mut refused) = (Vec::new(), Vec::new());
        let mut buried = Vec::new();
        for &(index, child) in &way.branches {
            let fork = way.nodes[index];
            let ForkChoice::Inset { lift, .. } = self.choices[fork as usize] else {
                continue;
            };
            let line = self.branch_line(fork, child);
            let branch = Branch {
                fork,
                child,
                path: &line,
                radius: self.base.node(child).radius,
                lift,
            };
            match branch.zone(path, path.arcs[index], room) {
                Ok(zone) if self.goes_on(&zone, path).is_some() => zones.push(zone),
                Err(NoZone::Inside) if self.is_twig(child) => buried.push(child),
                Ok(_) | Err(_) => refused.push(fork),
            }
        }
        if !refused.is_empty() {
            return Err(refused);
        }
        let groups = arrange(zones, path)?;
        self.buried.extend(buried);
        Ok(groups)
    }

    /// From a fork along a branch's main children, as thick as the branch's first point.
    fn branch_line(&self, fork: u32, child: u32) -> Polyline {
        let mut nodes = vec![fork, child];
        while nodes.len() < MOST_LOOKED_AT {
            let (before, here) = (nodes[nodes.len() - 2], nodes[nodes.len() - 1]);
            match self.children.of(here) {
                [] => break,
                [only] => nodes.push(*only),
                _ => nodes.push(self.main_child(before, here)),
            }
        }
        let radius = self.base.node(child).radius;
        let centers = nodes.iter().map(|&n| self.base.node(n).center).collect();
        Polyline::new(centers, vec![radius; nodes.len()])
    }

    /// Whether nothing branches off.
    fn is_twig(&self, mut node: u32) -> bool {
        while let [only] = self.children.of(node) {
            node = *only;
        }
        self.children.of(node).is_empty()
    }

    /// The inset's shape over the path as traced, and where the branch goes on from it. None if it forks
    /// before it is clear of its trunk.
    fn goes_on(&self, zone: &Zone, path: &Polyline) -> Option<(InsetShape, Beginning)> {
        let reach = 8.0 * zone.trunk_radius;
        let cones = path.cones([zone.foot - reach, zone.foot + reach]);
        let site = InsetSite {
            exit: zone.exit,
            direction: zone.direction,
            radius: zone.radius,
            lift: zone.lift,
            along: path.tangent(zone.foot, 0.5 * zone.trunk_radius),
        };
        let shape = site.shape(&cones);
        let mut ahead = None;
        let mut here = zone.child;
        loop {
            let node = self.base.node(here);
            let beyond = (node.center - shape.center).dot(shape.direction);
            let near = node.center.distance(shape.center) <= 6.0 * zone.trunk_radius + shape.reach;
            if beyond > shape.reach + AHEAD * zone.radius.max(node.radius) {
                if distance(&cones, node.center) > CLEAR * node.radius {
                    return Some((shape, Beginning::At(here)));
                }
                ahead = ahead.or(Some(here));
            }
            match self.children.of(here) {
                [only] if near => here = *only,
                [_] => break,
                [] => return Some((shape, ahead.map_or(Beginning::Ends(here), Beginning::At))),
                _ => return ahead.map(|node| (shape, Beginning::At(node))),
            }
        }
        ahead.map(|node| (shape, Beginning::At(node)))
    }

    /// Adds a path's nodes, and what starts from it to `starts`.
    fn emit(
        &mut self,
        start: &Start,
        way: &Way,
        path: &Polyline,
        groups: &[Group],
        starts: &mut Vec<Start>,
    ) {
        let room = self.room(start, way, path);
        let first_zone = self.zones.len() as u32;
        let last = way.nodes.len() - 1;
        let mut parent = match start {
            Start::Root(root) => self.copy(*root, NONE, self.base.node(*root).root),
            Start::Joint(_, joint, _) => *joint,
            Start::Inset(inset) => self.inset_root(inset, way.nodes[1]),
        };
        for ring in rings(path, groups, room, way.ends_at_joint) {
            parent = match ring.what {
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
        if way.ends_at_joint {
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

    fn begin_inset(&mut self, zone: &Zone, path: &Polyline, starts: &mut Vec<Start>) -> u32 {
        let inset = self.insets.len() as u32;
        self.insets.push(Inset {
            fork: zone.fork,
            exit: zone.exit,
            direction: zone.direction,
            radius: zone.radius,
            lift: zone.lift,
        });
        let (shape, way) = self
            .goes_on(zone, path)
            // Pushed along the trunk it may not be clear any more.
            .unwrap_or_else(|| {
                let site = InsetSite {
                    exit: zone.exit,
                    direction: zone.direction,
                    radius: zone.radius,
                    lift: zone.lift,
                    along: path.tangent(zone.foot, 0.5 * zone.trunk_radius),
                };
                let reach = 8.0 * zone.trunk_radius;
                let cones = path.cones([zone.foot - reach, zone.foot + reach]);
                (site.shape(&cones), Beginning::At(zone.child))
            });
        starts.push(Start::Inset(Box::new(InsetStart {
            inset,
            shape,
            fork: zone.fork,
            way,
            radius: zone.radius,
        })));
        inset
    }

    /// Copies a node; forks remember which they are.
    fn copy(&mut self, node: u32, parent: u32, root: Root) -> u32 {
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

    fn inset_root(&mut self, start: &InsetStart, first: u32) -> u32 {
        self.nodes.push(SkeletonNode {
            center: start.shape.center,
            radius: start.radius,
            parent: NONE,
            root: Root::Inset(start.inset),
            marks: Marks {
                base: start.fork,
                ..Marks::default()
            },
            ..*self.base.node(first)
        });
        self.nodes.len() as u32 - 1
    }

    /// A branch too short for a ring of its own beyond its inset: one right ahead of it.
    fn end_ahead(&mut self, start: &InsetStart, last: u32) {
        let parent = self.inset_root(start, last);
        let ahead = start.shape.reach + 0.6 * start.radius;
        self.nodes.push(SkeletonNode {
            center: start.shape.center + start.shape.direction * ahead,
            radius: start.radius,
            parent,
            root: Root::Free,
            marks: Marks::default(),
            ..*self.base.node(last)
        });
    }
}

/// Point of a path nearest to an arc length.
fn nearest(path: &Polyline, arc: f64) -> usize {
    let after = path
        .arcs
        .partition_point(|&a| a < arc)
        .min(path.arcs.len() - 1);
    let before = after.saturating_sub(1);
    if arc - path.arcs[before] < path.arcs[after] - arc {
        before
    } else {
        after
    }
}

/// Rings along a path after its start: its own points where they are far enough from zones and from
/// one another, and two for each zone.
fn rings(path: &Polyline, groups: &[Group], room: [f64; 2], ends_at_joint: bool) -> Vec<Ring> {
    let last = path.arcs.len() - 1;
    let mut zones = zone_rings(path, groups).into_iter().peekable();
    let mut rings: Vec<Ring> = Vec::with_capacity(last + 2 * groups.len());
    for index in 1..=last {
        let arc = path.arcs[index];
        while let Some(zone) = zones.next_if(|zone| zone.arc <= arc || index == last) {
            give_way(&mut rings, path, zone.arc, BESIDE_ZONE);
            rings.push(zone);
        }
        let end = index == last;
        if !end {
            let in_room = arc >= room[0] && arc <= room[1];
            let beside = BESIDE_ZONE * path.radius(arc);
            let next = groups.partition_point(|g| g.high + beside <= arc);
            let within = groups.get(next).is_some_and(|g| arc > g.low - beside);
            // Points of a path without zones stay as they are: later steps see to them.
            if !groups.is_empty() && (!in_room || within) {
                continue;
            }
        } else if !groups.is_empty() && !ends_at_joint {
            give_way(&mut rings, path, arc, 0.5);
        }
        rings.push(Ring {
            arc,
            what: RingKind::Point(index),
        });
    }
    rings
}

/// Two rings for each group, or one where the next begins right behind it.
fn zone_rings(path: &Polyline, groups: &[Group]) -> Vec<Ring> {
    let mut rings: Vec<Ring> = Vec::with_capacity(2 * groups.len());
    for (g, group) in groups.iter().enumerate() {
        let near = 0.3 * path.radius(group.low);
        match rings.last_mut() {
            Some(before) if group.low - before.arc < near => {
                before.arc = 0.5 * (before.arc + group.low);
                if let RingKind::Zone(begins, _) = &mut before.what {
                    *begins = Some(g);
                }
            }
            _ => rings.push(Ring {
                arc: group.low,
                what: RingKind::Zone(Some(g), None),
            }),
        }
        rings.push(Ring {
            arc: group.high,
            what: RingKind::Zone(None, Some(g)),
        });
    }
    rings
}

/// Drops a path's own points that lie too near before a ring that must stay.
fn give_way(rings: &mut Vec<Ring>, path: &Polyline, arc: f64, share: f64) {
    let near = share * path.radius(arc);
    while let Some(Ring {
        arc: before,
        what: RingKind::Point(_),
    }) = rings.last()
        && arc - before < near
    {
        rings.pop();
    }
}
