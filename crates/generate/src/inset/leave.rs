//! Where each branch of a path leaves it, and how it goes on from its inset.

use super::ForkChoice;
use super::arrange::{Group, arrange};
use super::cone::distance;
use super::path::{Beginning, Planner, Start, Way};
use super::polyline::Polyline;
use super::shape::InsetShape;
use super::zone::{Branch, NoZone, Zone};
use crate::fork;
use crate::joint::{Joint, Neighbor};

/// Free way between the inset's corners and the branch's next ring, in radii.
const AHEAD: f64 = 0.35;
/// The branch's rings begin outside the trunk by this share of their radius.
const CLEAR: f64 = 1.05;
/// Points of a branch that are looked at to find its way out.
const MOST_LOOKED_AT: usize = 40;
/// A fork of more neighbors is split into several joints, none of which reaches far.
const MOST_NEIGHBORS: usize = 6;

impl Planner<'_> {
    pub(super) fn zones_of(
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
            let (line, ends) = self.branch_line(fork, child);
            let branch = Branch {
                fork,
                child,
                path: &line,
                radius: self.base.node(child).radius,
                lift,
            };
            match branch.zone(path, path.arcs[index], room) {
                Ok(zone) if self.goes_on(&zone, path).is_some() => zones.push(zone),
                Err(NoZone::Inside) if ends => buried.push(child),
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

    /// From a fork along a branch's main children, as thick as the branch's first point; and whether that
    /// is all of the branch.
    fn branch_line(&self, fork: u32, child: u32) -> (Polyline, bool) {
        let mut forks = false;
        let mut nodes = vec![fork, child];
        while nodes.len() < MOST_LOOKED_AT {
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

    /// The inset's shape over the path as traced, and where the branch goes on from it. None if it forks
    /// before it is clear of its trunk.
    pub(super) fn goes_on(&self, zone: &Zone, path: &Polyline) -> Option<(InsetShape, Beginning)> {
        let cones = zone.cones(path);
        let shape = zone.site(path).shape(&cones);
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

    /// Arc lengths that the path's own ends leave free for zones.
    pub(super) fn room(&self, start: &Start, way: &Way, path: &Polyline) -> [f64; 2] {
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
}
