//! Forks whose children are straighter to one another than to their parent: the children are the trunk, and the
//! parent's path ends in an inset on it.
//!
//! ```text
//!            ║ parent
//!         ╭──╨──╮           The trunk begins at an end of one child, runs back to the fork and on along the
//!   ══════╧══●══╧══════     other. It is laid out first, so that the parent's path finds the inset that it
//!    child  fork   child    ends in.
//! ```

use glam::DVec3;

use super::ForkChoice;
use super::clearance::{CLEAR, FREE_WAY};
use super::cone::{RoundCone, distance};
use super::planner::{End, PathInset, Planner, Start, Way};
use super::shape::InsetShape;
use super::zone::{MAX_RATIO, Zone};
use crate::tracing::{NONE, Skeleton};

/// Way that a parent needs between its inset and the fork before, in radii of either. With half of it 29 files have as
/// many pairs near forks, and at level 4 1 % more folds.
const MIN_WAY: f64 = 3.0;

/// Whether a fork of two children is to have them as its trunk: they are straighter to one another than either is to
/// the parent, and the fork is not much thinner than that.
pub(crate) fn is_straight_across(skeleton: &Skeleton, fork: u32) -> bool {
    let &[a, b] = skeleton.children().of(fork) else {
        return false;
    };
    let here = skeleton.node(fork);
    let Some(parent) = skeleton.nodes().get(here.parent as usize) else {
        return false;
    };
    let [a, b] = [a, b].map(|child| skeleton.node(child));
    let trunk = here.radius.min(MAX_RATIO * a.radius.min(b.radius));
    if parent.radius >= MAX_RATIO * trunk {
        return false;
    }
    let [a, b, up] = [a, b, parent].map(|node| (node.center - here.center).normalize_or_zero());
    // Cosines of the angles by which a path through the fork bends.
    let bend = |from: DVec3, to: DVec3| -from.dot(to);
    bend(a, b) > bend(up, a).max(bend(up, b))
}

impl Way {
    /// Ends the path in an inset, which takes the place of the nodes that are not clear of its trunk.
    pub(super) fn end_in(&mut self, inset: &PathInset, fork: u32) {
        self.end = End::Inset;
        let kept = self.nodes.iter().rposition(|&node| inset.way.is_at(node));
        self.nodes.truncate(kept.map_or(1, |kept| kept + 1));
        self.nodes.push(fork);
    }

    /// The same path from its end to its beginning. Branches keep their order along it.
    fn reversed(mut self) -> Self {
        self.nodes.reverse();
        self.branches.reverse();
        let last = self.nodes.len() - 1;
        for (index, _) in &mut self.branches {
            *index = last - *index;
        }
        self
    }
}

impl Planner<'_> {
    /// Lays out the trunk of a fork whose children are that. Without room for the parent's inset it becomes a joint.
    pub(super) fn lay_out_across(&mut self, fork: u32, starts: &mut Vec<Start>) {
        for tries in 0.. {
            if !self.choices[fork as usize].is_across() {
                return;
            }
            let Some((start, way)) = self.trunk_across(fork) else {
                self.choices[fork as usize] = ForkChoice::Joint;
                self.plan.refused.push(fork);
                return;
            };
            let path = self.polyline(&start, &way);
            match self.zones_of(&start, &way, &path) {
                Ok(groups) => {
                    let start = self.begun(start, starts);
                    return self.emit(&start, &way, &path, &groups, starts);
                }
                Err(forks) => self.refuse(&way, forks, tries),
            }
        }
    }

    /// From an end of one child through the fork along the other. None without a parent.
    fn trunk_across(&self, fork: u32) -> Option<(Start, Way)> {
        let &[a, b] = self.children.of(fork) else {
            return None;
        };
        let parent = Some(self.base.node(fork).parent).filter(|&parent| parent != NONE)?;
        let [a, b] = [a, b].map(|child| self.walk([fork, child]));
        // The fewer forks are seen from the other side, the better.
        let (back, on) = match b.branches.len() < a.branches.len() {
            true => (b, a),
            false => (a, b),
        };
        let &[.., before, end] = &back.nodes[..] else {
            return None;
        };
        let start = match (back.end, self.end_of(&back)) {
            (End::Joint, _) => Start::Joint(end, None, before),
            (_, Some(inset)) => Start::Inset(Box::new(*inset)),
            _ => Start::Root(end),
        };
        let mut way = back.reversed();
        let at = way.nodes.len() - 1;
        way.branches.push((at, parent));
        way.nodes.extend(&on.nodes[1..]);
        let branches = on.branches.iter();
        way.branches
            .extend(branches.map(|&(index, child)| (at + index, child)));
        way.end = on.end;
        Some((start, way))
    }

    /// Where a trunk begins, once it is known to: a joint is added with the paths of its children, and an inset that was
    /// to be a path's end becomes this one's beginning.
    fn begun(&mut self, start: Start, starts: &mut Vec<Start>) -> Start {
        match start {
            Start::Joint(fork, None, before) => {
                let joint = self.add_joint(fork);
                starts.extend(self.starts_from(fork, joint));
                Start::Joint(fork, Some(joint), before)
            }
            Start::Inset(inset) => {
                self.plan.insets[inset.inset as usize].at_end = false;
                self.ends.remove(&inset.fork);
                Start::Inset(inset)
            }
            start => start,
        }
    }

    /// The last node of a parent that is clear of the trunk that it ends on. None if it forks before, or soon before.
    pub(super) fn last_before(
        &self,
        zone: &Zone,
        shape: &InsetShape,
        cones: &[RoundCone],
    ) -> Option<u32> {
        let clear = |node: u32| {
            let node = self.base.node(node);
            let beyond = (node.center - shape.center).dot(shape.direction);
            beyond > shape.reach + FREE_WAY * zone.radius.max(node.radius)
                && distance(cones, node.center) > CLEAR * node.radius
        };
        let mut parents = self.parents(zone.child);
        let forks = |node: u32| self.children.of(node).len() > 1;
        let last = parents.find(|&node| forks(node) || clear(node))?;
        if forks(last) {
            return None;
        }
        match parents.find(|&node| forks(node)) {
            Some(before) => {
                let way = shape.center.distance(self.base.node(before).center);
                let radii = self.radius(before) + zone.radius;
                (way > shape.reach + MIN_WAY * radii).then_some(last)
            }
            None => Some(last),
        }
    }
}
