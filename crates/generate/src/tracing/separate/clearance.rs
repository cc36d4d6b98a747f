//! Whether a point may be left out later: its branch then takes a shorter way, on which another may lie.

use std::ops::ControlFlow;

use glam::DVec3;

use super::boxes::{Bounds, Boxes};
use super::geometry::closest;
use super::paths::OnSegment;
use super::rods::Rods;
use super::search::{MAX_LOOKS, may_touch};
use crate::tracing::NONE;

/// The branches as they are, to be asked about shorter ways.
pub(crate) struct Clearance {
    rods: Rods,
    boxes: Boxes,
    /// The point of each node.
    points: Vec<u32>,
}

impl Clearance {
    pub(super) fn new(rods: Rods) -> Self {
        let bounds = (0..rods.count() as u32).map(|i| {
            let above = rods.parent(i).min(i);
            let ends = [above, i].map(|n| rods.points[n as usize].node.center);
            Bounds::around(ends, rods.radius(i).max(rods.radius(above)))
        });
        Self {
            boxes: Boxes::new(bounds.collect(), rods.segments().collect()),
            points: rods.nodes().collect(),
            rods,
        }
    }

    /// Whether a branch can go straight from a node to one below it and touch no other.
    pub(crate) fn allows(&self, from: u32, to: u32) -> bool {
        let [from, to] = [from, to].map(|node| self.points[node as usize]);
        let bounds = Bounds::around(
            [from, to].map(|i| self.center(i)),
            self.rods.radius(from).max(self.rods.radius(to)),
        );
        let (mut looks, mut free) = (0, true);
        self.boxes.overlapping(&bounds, |other| {
            looks += 1;
            free = self.passes(from, to, other);
            match free && looks < MAX_LOOKS {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        });
        free
    }

    fn center(&self, point: u32) -> DVec3 {
        self.rods.points[point as usize].node.center
    }

    /// Whether the straight way passes a segment that it has nothing to do with.
    fn passes(&self, from: u32, to: u32, other: u32) -> bool {
        let above = self.rods.parent(other);
        let beside = [from, to].iter().any(|&n| n == other || n == above);
        if beside || self.replaces(from, to, other) {
            return true;
        }
        let (p, q) = ([from, to], [above, other]);
        let (s, t) = closest(p.map(|n| self.center(n)), q.map(|n| self.center(n)));
        let between = |ends: [u32; 2], share: f64, value: &dyn Fn(u32) -> f64| {
            value(ends[0]) + share * (value(ends[1]) - value(ends[0]))
        };
        let radius = |n: u32| self.rods.radius(n);
        let radii = between(p, s, &radius) + between(q, t, &radius);
        let place =
            |ends: [u32; 2], share: f64| self.center(ends[0]).lerp(self.center(ends[1]), share);
        let arc = |n: u32| self.rods.paths.arc(n);
        let on = |ends: [u32; 2], share: f64| OnSegment {
            segment: ends[1],
            arc: between(ends, share, &arc),
        };
        place(p, s).distance(place(q, t)) >= radii
            || may_touch(&self.rods, on(p, s), on(q, t), radii)
    }

    /// Whether a segment is one of those that the straight way stands for.
    fn replaces(&self, from: u32, to: u32, segment: u32) -> bool {
        let mut here = to;
        // Parents come first, so that this ends at `from` at the latest.
        while here > from && here != NONE {
            if here == segment {
                return true;
            }
            here = self.rods.parent(here);
        }
        false
    }
}
