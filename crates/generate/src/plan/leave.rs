//! Where each branch of a path leaves it, and how it goes on from its inset.

use glam::DVec3;
use rayon::prelude::*;

use super::arrange::{Group, arrange};
use super::clearance::{CLEAR, FREE_WAY};
use super::cone::distance;
use super::joint::{JointShape, Neighbor};
use super::planner::{End, Planner, Start, Way};
use super::polyline::Polyline;
use super::shape::InsetShape;
use super::zone::{Beginning, Branch, NoZone, TRUNK_REACH, Zone};
use super::{ForkChoice, MAX_NEIGHBORS};
use crate::tracing::{NONE, Skeleton};

/// An inset stands across its branch up to this cosine of the angle between its direction and the branch's.
const ACROSS: f64 = 0.92;
/// Points of a branch that are looked at to find its way out. A guard.
const MAX_LOOKED_AT: usize = 40;

/// Branches of a path that are worth a thread.
const MIN_BRANCHES: usize = 8;

/// How a branch leaves its trunk.
enum Leaving {
    Through(Box<Zone>),
    /// It ends inside the trunk.
    Never,
    /// There is no room for its inset.
    Refused,
    /// Not through an inset.
    Joint,
}

impl Planner<'_> {
    pub(super) fn zones_of(
        &mut self,
        start: &Start,
        way: &Way,
        path: &Polyline,
    ) -> Result<Vec<Group>, Vec<u32>> {
        let room = self.room(start, way, path);
        let leaving: Vec<(u32, Leaving)> = way
            .branches
            .par_iter()
            .with_min_len(MIN_BRANCHES)
            .map(|&(index, child)| {
                (
                    child,
                    self.leaving(way.nodes[index], index, child, path, room),
                )
            })
            .collect();
        let (mut zones, mut refused) = (Vec::new(), Vec::new());
        let mut buried = Vec::new();
        for (&(index, _), (child, leaving)) in way.branches.iter().zip(leaving) {
            match leaving {
                Leaving::Through(zone) => zones.push(*zone),
                Leaving::Never => buried.push(child),
                Leaving::Refused => refused.push(way.nodes[index]),
                Leaving::Joint => {}
            }
        }
        if !refused.is_empty() {
            return Err(refused);
        }
        let groups = arrange(zones, path)?;
        self.plan.buried.extend(buried);
        Ok(groups)
    }

    /// How a branch leaves the path at a fork, one of its nodes.
    fn leaving(
        &self,
        fork: u32,
        index: usize,
        child: u32,
        path: &Polyline,
        room: [f64; 2],
    ) -> Leaving {
        let ForkChoice::Inset { lift, .. } = self.choices[fork as usize] else {
            return Leaving::Joint;
        };
        let upward = self.base.node(fork).parent == child;
        let (line, ends) = match upward {
            true => (self.line_up(fork), false),
            false => self.branch_line(fork, child),
        };
        let branch = Branch {
            fork,
            child,
            upward,
            path: &line,
            radius: self.base.node(child).radius,
            lift,
        };
        match branch.zone(path, path.arcs[index], room) {
            Ok(mut zone) => {
                zone.onward = self.goes_on(&zone, path);
                match zone.onward {
                    Some(_) => Leaving::Through(Box::new(zone)),
                    None => Leaving::Refused,
                }
            }
            Err(NoZone::Inside) if ends => Leaving::Never,
            Err(_) => Leaving::Refused,
        }
    }

    /// From a fork along a branch's main children, as thick as the branch's first point; and whether that
    /// is all of the branch.
    fn branch_line(&self, fork: u32, child: u32) -> (Polyline, bool) {
        let mut forks = false;
        let mut nodes = vec![fork, child];
        while nodes.len() < MAX_LOOKED_AT {
            let (before, here) = (nodes[nodes.len() - 2], nodes[nodes.len() - 1]);
            match self.children.of(here) {
                [] => break,
                [only] => nodes.push(*only),
                _ => {
                    forks = true;
                    nodes.push(self.main_child(before, here));
                }
            }
        }
        let ends = !forks && self.children.of(nodes[nodes.len() - 1]).is_empty();
        let radius = self.base.node(child).radius;
        let centers = nodes.iter().map(|&n| self.base.node(n).center).collect();
        (Polyline::new(centers, vec![radius; nodes.len()]), ends)
    }

    /// From a fork up its parents, as thick as the first of them.
    fn line_up(&self, fork: u32) -> Polyline {
        let nodes = self.parents(fork).take(MAX_LOOKED_AT);
        let centers: Vec<DVec3> = nodes.map(|n| self.base.node(n).center).collect();
        let radius = self.base.node(self.base.node(fork).parent).radius;
        let radii = vec![radius; centers.len()];
        Polyline::new(centers, radii)
    }

    /// A node, its parent, and so on up to the root.
    pub(super) fn parents(&self, node: u32) -> impl Iterator<Item = u32> {
        let parent = |&node: &u32| Some(self.base.node(node).parent).filter(|&p| p != NONE);
        std::iter::successors(Some(node), parent)
    }

    /// The inset's shape over the path as traced, and where the branch goes on from it. None if it forks
    /// before it is clear of its trunk.
    pub(super) fn goes_on(&self, zone: &Zone, path: &Polyline) -> Option<(InsetShape, Beginning)> {
        let cones = zone.cones(path);
        let shape = zone.site(path).shape(&cones);
        if zone.upward {
            let node = self.last_before(zone, &shape, &cones)?;
            return Some((shape, Beginning::At(node)));
        }
        let mut ahead = None;
        let mut here = zone.child;
        loop {
            let node = self.base.node(here);
            let beyond = (node.center - shape.center).dot(shape.direction);
            let near =
                node.center.distance(shape.center) <= TRUNK_REACH * zone.trunk_radius + shape.reach;
            if beyond > shape.reach + FREE_WAY * zone.radius.max(node.radius) {
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

    /// Way (µm) from the inset towards the first free node to where the branch is clear of its trunk; none where the
    /// inset stands across the branch.
    pub(super) fn clear_after(
        &self,
        zone: &Zone,
        shape: &InsetShape,
        node: u32,
        path: &Polyline,
    ) -> Option<f64> {
        let node = self.base.node(node);
        let way = node.center - shape.center;
        let length = way.length();
        if shape.direction.dot(way) > ACROSS * length {
            return None;
        }
        let cones = zone.cones(path);
        let is_clear = |arc: f64| {
            let center = shape.center + way * (arc / length);
            distance(&cones, center) > CLEAR * zone.radius
        };
        let (mut low, mut high) = (shape.reach + FREE_WAY * zone.radius, length);
        if low >= high || !is_clear(high) {
            return None;
        }
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            if is_clear(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(high)
    }

    /// Arc lengths that the path's own ends leave free for zones.
    pub(super) fn room(&mut self, start: &Start, way: &Way, path: &Polyline) -> [f64; 2] {
        let last = way.nodes.len() - 1;
        let low = match start {
            Start::Root(_) => 0.0,
            Start::Joint(fork, _, child) => {
                self.joint_reach(*fork, *child) + FREE_WAY * path.radii[1]
            }
            Start::Inset(inset) => inset.shape.reach + FREE_WAY * inset.radius,
        };
        let high = match way.end {
            End::Tip => 0.0,
            End::Joint => {
                let reach = self.joint_reach(way.nodes[last], way.nodes[last - 1]);
                reach + FREE_WAY * path.radii[last - 1]
            }
            End::Inset => {
                let inset = self.end_of(way);
                inset.map_or(0.0, |inset| inset.shape.reach + FREE_WAY * inset.radius)
            }
        };
        let high = path.length() - high;
        [low, high]
    }

    /// How far a joint reaches towards a neighbor, with room for all.
    fn joint_reach(&mut self, fork: u32, neighbor: u32) -> f64 {
        let base = self.base;
        let reaches = self.joint_reaches.entry(fork);
        let reaches = reaches.or_insert_with(|| joint_reaches(base, fork));
        // The node before a joint on its path may lie beyond an inset: then the parent stands for it.
        let reach = reaches.iter().find(|(node, _)| *node == neighbor);
        reach.or(reaches.first()).map_or(0.0, |(_, reach)| *reach)
    }
}

/// How far a joint reaches towards each of its neighbors.
fn joint_reaches(base: &Skeleton, fork: u32) -> Vec<(u32, f64)> {
    let around = base.neighbors(fork);
    let at = base.node(fork);
    // It will be several joints, none of which reaches far.
    if around.len() > MAX_NEIGHBORS {
        let reach = 2.0 * at.radius;
        return around.into_iter().map(|node| (node, reach)).collect();
    }
    let tube = |&node: &u32| {
        let node = base.node(node);
        Neighbor::new(at.center, node.center, node.radius, 1.0).without_limit()
    };
    let free: Vec<Neighbor> = around.iter().map(tube).collect();
    let joint = JointShape::new(at.radius, &free);
    let reaches = (0..).zip(&free);
    let reaches = reaches.map(|(slot, tube)| joint.reach(slot, tube.direction));
    around.into_iter().zip(reaches).collect()
}
