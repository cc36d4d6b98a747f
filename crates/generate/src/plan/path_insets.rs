//! Insets that paths begin or end in.

use super::Inset;
use super::planner::{End, PathInset, Planner, Start, Way};
use super::polyline::Polyline;
use super::trunk_rings::{Ring, RingKind};
use super::zone::{Beginning, Zone};
use crate::tracing::{Marks, NONE, Root, SkeletonNode};

impl PathInset {
    /// Way (µm) from the inset to a ring across the branch, where that is clear of its trunk; `next`: to the next ring.
    /// Leant over its trunk, the inset's own ring is narrower across the branch than the branch is, which then stayed a
    /// ribbon up to a far first point.
    fn upright(&self, next: f64) -> Option<f64> {
        self.clear.filter(|clear| next > clear + 2.0 * self.radius)
    }
}

impl Planner<'_> {
    /// Adds rings that stand upright where a path is clear of the trunks that it begins or ends on.
    pub(super) fn add_upright(
        rings: &mut Vec<Ring>,
        path: &Polyline,
        [start, end]: [Option<&PathInset>; 2],
    ) {
        let ring = |arc: f64| Ring {
            arc,
            what: RingKind::Zone(None, None),
        };
        let first = rings.first().map_or(0.0, |ring| ring.arc);
        if let Some(arc) = start.and_then(|inset| inset.upright(first)) {
            rings.insert(0, ring(arc));
        }
        let before = rings
            .len()
            .checked_sub(2)
            .map_or(0.0, |before| rings[before].arc);
        let length = path.length();
        if let Some(arc) = end.and_then(|inset| inset.upright(length - before)) {
            rings.insert(rings.len() - 1, ring(length - arc));
        }
    }

    /// Adds a branch's inset; the path that begins there goes to `starts`.
    pub(super) fn begin_inset(
        &mut self,
        zone: &Zone,
        path: &Polyline,
        starts: &mut Vec<Start>,
    ) -> u32 {
        let inset = self.insets.len() as u32;
        self.insets.push(Inset {
            leaning: self.choices[zone.fork as usize].is_leaning(),
            at_end: zone.upward,
            fork: zone.fork,
            exit: zone.exit,
            direction: zone.direction,
            radius: zone.radius,
            lift: zone.lift,
        });
        let (shape, way) = zone
            .onward
            .or_else(|| self.goes_on(zone, path))
            // Pushed along the trunk it may not be clear any more.
            .unwrap_or_else(|| {
                let cones = zone.cones(path);
                (zone.site(path).shape(&cones), Beginning::At(zone.child))
            });
        let clear = match way {
            Beginning::At(node) => self.clear_after(zone, &shape, node, path),
            Beginning::Ends(_) => None,
        };
        let of_path = PathInset {
            inset,
            clear,
            shape,
            fork: zone.fork,
            way,
            radius: zone.radius,
        };
        if zone.upward {
            self.ends.insert(zone.fork, of_path);
        } else {
            starts.push(Start::Inset(Box::new(of_path)));
        }
        inset
    }

    /// The inset that a path ends in.
    pub(super) fn end_of(&self, way: &Way) -> Option<&PathInset> {
        match way.end {
            End::Inset => self.ends.get(&way.nodes[way.nodes.len() - 1]),
            End::Tip | End::Joint => None,
        }
    }

    pub(super) fn inset_root(&mut self, start: &PathInset, first: u32) -> u32 {
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

    /// Adds the last node of a path that ends in an inset.
    pub(super) fn end_in_inset(&mut self, way: &Way, parent: u32) -> u32 {
        let Some(end) = self.end_of(way) else {
            return parent;
        };
        // Of a path without nodes of its own the fork stands for it.
        let last = match way.nodes[..] {
            [_, .., before, _] => before,
            _ => end.fork,
        };
        let node = SkeletonNode {
            center: end.shape.center,
            radius: end.radius,
            parent,
            root: Root::Free,
            marks: Marks {
                ends_in: end.inset,
                base: end.fork,
                ..Marks::default()
            },
            ..*self.base.node(last)
        };
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// A branch too short for a ring of its own beyond its inset: one right ahead of it.
    pub(super) fn end_ahead(&mut self, start: &PathInset, last: u32) {
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
