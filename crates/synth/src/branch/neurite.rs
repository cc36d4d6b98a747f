//! Whole neurites: where they start, and where points go that found no room.

use glam::DVec3;

use super::{Branch, Grower, OfFork};
use crate::room::{Capsule, Way};
use crate::stems;

/// Directions for a stem that are looked at for room, and how often a stem without room is tried again.
const STEM_TRIES: u32 = 8;
/// Cosine of the greatest angle with an aim.
const ALL_SIDES: f64 = -1.0;
/// How many of the points that are left the end of one terminal gets at most: with 20, terminals became longer and
/// forks fewer (of Purkinje cells of 50,000 points 604 instead of 1,391), with 60 they fork (1,171).
const LENGTHENED: usize = 60;
/// How many ends are drawn, of which one is taken.
const ENDS_DRAWN: usize = 4;

impl Grower<'_> {
    /// One neurite, in a direction far from those taken; gives its own.
    pub(super) fn stem(&mut self, taken: &[DVec3], points: usize, size: f64) -> DVec3 {
        let before = self.grown.nodes.len();
        self.unspent += points;
        let mut heading = DVec3::Y;
        for attempt in 0..STEM_TRIES {
            heading = self.stem_heading(taken, attempt);
            self.grow_stem(heading, size);
            if self.grown.nodes.len() > before {
                break;
            }
        }
        heading
    }

    /// Where a stem may start, clear of the others: within its aim, or ever farther from it.
    fn stem_heading(&mut self, taken: &[DVec3], attempt: u32) -> DVec3 {
        let radius = 1.25 * self.tree.radius;
        let mut tree = self.tree.clone();
        let mut aim = tree.aim.1 - 0.1 * f64::from(attempt);
        tree.aim.1 = aim.max(ALL_SIDES);
        let mut heading = stems::direction(&tree, taken, self.random);
        for _ in 1..STEM_TRIES {
            let from = heading * (self.soma_radius + radius);
            let stem = Capsule {
                from,
                to: from + heading * self.spacing,
                radius,
                parent: None,
            };
            let room = self.grown.room.as_ref();
            if room.is_none_or(|room| room.way(&stem, 0.0) == Way::Free) {
                break;
            }
            aim -= 0.1;
            tree.aim.1 = aim.max(ALL_SIDES);
            heading = stems::direction(&tree, taken, self.random);
        }
        heading
    }

    /// A neurite that starts in a direction, with all points that are unspent, depth first.
    fn grow_stem(&mut self, heading: DVec3, size: f64) {
        let points = std::mem::take(&mut self.unspent);
        let radius = self.tree.radius * self.random.between((0.85, 1.15));
        let sides = self.tree.trunk.map(|trunk| self.sides(trunk, points, size));
        // The first step leads `spacing` further: out of the soma.
        let from = heading * (self.soma_radius + radius - self.spacing).max(0.5 * self.soma_radius);
        self.ends.clear();
        let mut stack = vec![Branch {
            parent: 0,
            from,
            heading,
            inside: 0.0,
            radius,
            points,
            sides,
            of_fork: OfFork::Not,
            goes_on: false,
        }];
        while let Some(mut branch) = stack.pop() {
            branch.points += std::mem::take(&mut self.unspent);
            self.branch(branch, &mut stack);
        }
        let middle = self.ends.iter().map(|end| end.from).sum::<DVec3>() / self.ends.len() as f64;
        while let Some(end) = self.drawn_end(middle) {
            self.all_of(end);
        }
    }

    /// A branch and what comes of it.
    fn all_of(&mut self, branch: Branch) {
        let mut stack = vec![branch];
        while let Some(branch) = stack.pop() {
            self.branch(branch, &mut stack);
        }
    }

    /// One of the ends of terminals, with some of the points that are left: of a few, the nearest to the middle of
    /// the neurite, so that it does not grow out of its usual reach.
    fn drawn_end(&mut self, middle: DVec3) -> Option<Branch> {
        if self.unspent == 0 || self.ends.is_empty() {
            return None;
        }
        let count = self.ends.len() as f64;
        let drawn = [(); ENDS_DRAWN].map(|()| (self.random.unit() * count) as usize);
        let reach = |end: usize| self.ends[end].from.distance_squared(middle);
        let nearest = drawn
            .into_iter()
            .min_by(|&a, &b| reach(a).total_cmp(&reach(b)))?;
        let mut end = self.ends.swap_remove(nearest);
        end.points = self.unspent.min(LENGTHENED);
        self.unspent -= end.points;
        Some(end)
    }

    /// Spends the points that are left where nothing is in the way: from the farthest point outwards.
    pub(super) fn outwards(&mut self) {
        while self.unspent > 0 {
            let before = self.grown.nodes.len();
            let parent = self.grown.farthest(self.tree.kind);
            let node = &self.grown.nodes[parent as usize];
            let from = node.position;
            let branch = Branch {
                parent,
                from,
                heading: from.normalize_or(DVec3::Y),
                inside: node.radius,
                radius: node.radius.min(self.tree.thinnest),
                points: std::mem::take(&mut self.unspent),
                sides: None,
                of_fork: OfFork::Not,
                goes_on: true,
            };
            self.all_of(branch);
            if self.grown.nodes.len() == before {
                self.grown.room = None; // rather a crossing than points that are missing
            }
        }
    }
}
