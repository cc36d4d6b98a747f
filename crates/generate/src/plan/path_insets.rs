//! Insets that paths begin or end in.

use super::clearance::FREE_WAY;
use super::path::{Inset, Label, Path, PathEnd, PlannedRing, RingKind};
use super::planner::{End, PathInset, Planner, Start, Way};
use super::polyline::Polyline;
use super::trunk_rings::{PlaceKind, RingPlace};
use super::zone::{Beginning, Zone};

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
        rings: &mut Vec<RingPlace>,
        path: &Polyline,
        [start, end]: [Option<&PathInset>; 2],
    ) {
        let ring = |arc: f64| RingPlace {
            arc,
            kind: PlaceKind::Ring(RingKind::Upright),
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
        let inset = self.plan.insets.len() as u32;
        self.plan.insets.push(Inset {
            leaning: self.choices[zone.fork as usize].is_leaning(),
            at_end: zone.upward,
            fork: zone.fork,
            exit: zone.exit,
            direction: zone.direction,
            radius: zone.radius,
            lift: zone.lift,
            // Known once that is planned.
            path: u32::MAX,
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

    /// The ring that stands for an inset, with the label of a node.
    pub(super) fn inset_ring(&self, inset: &PathInset, labeled: u32) -> PlannedRing {
        PlannedRing {
            center: inset.shape.center,
            radius: inset.radius,
            label: Label::of(self.base.node(labeled)),
            ..PlannedRing::at(inset.fork, self.base.node(inset.fork))
        }
    }

    /// A branch too short for a ring of its own beyond its inset: one right ahead of it.
    pub(super) fn end_ahead(&mut self, start: &PathInset, last: u32) {
        let first = self.inset_ring(start, last);
        let ahead = start.shape.reach + FREE_WAY * start.radius;
        self.plan.insets[start.inset as usize].path = self.plan.paths.len() as u32;
        self.plan.paths.push(Path {
            start: PathEnd::Inset(start.inset),
            rings: vec![
                first,
                PlannedRing {
                    center: start.shape.center + start.shape.direction * ahead,
                    ..first
                },
            ],
            end: PathEnd::Free,
            changes: Vec::new(),
            zones: Vec::new(),
        });
    }
}
