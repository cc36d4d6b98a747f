//! Which child of a fork continues the trunk.

use super::MAX_NEIGHBORS;
use super::planner::Planner;

/// A branch may be this much thicker than its trunk.
const MAX_THICK: f64 = 1.05;
/// A branch that forks again within this many of its radii is not clear of its trunk by then.
const SOON: f64 = 4.0;

impl Planner<'_> {
    /// The child that continues the trunk, so that all others can leave it through insets: the
    /// [main child](Self::main_child), or else the next thick and straight one. None where one of the others
    /// is always too thick.
    ///
    /// A branch that forks again before it is clear of the trunk had no room for its own branches: it is the trunk,
    /// if it may be.
    pub(super) fn trunk_child(&self, before: u32, fork: u32) -> Option<u32> {
        let main = self.main_child(before, fork);
        let children = self.children.of(fork).iter().copied();
        let able = children.filter(|&c| self.leaves_through_insets(fork, c));
        let mut soon = able.clone().filter(|&c| self.forks_soon(fork, c));
        match (soon.next(), soon.next()) {
            (Some(only), None) => Some(only),
            _ if self.leaves_through_insets(fork, main) => Some(main),
            _ => self.best_child(before, fork, able),
        }
    }

    /// Whether a branch forks again within [`SOON`] radii of its fork.
    fn forks_soon(&self, fork: u32, child: u32) -> bool {
        let most = SOON * self.base.node(child).radius;
        let (mut before, mut here) = (fork, child);
        let mut way = 0.0;
        loop {
            way += (self.base.node(before).center).distance(self.base.node(here).center);
            match self.children.of(here) {
                _ if way > most => return false,
                [] => return false,
                [only] => (before, here) = (here, *only),
                _ => return true,
            }
        }
    }

    /// Of all children, the one that is thick and goes straight on.
    pub(super) fn main_child(&self, before: u32, fork: u32) -> u32 {
        let children = self.children.of(fork).iter().copied();
        let best = self.best_child(before, fork, children);
        best.expect("a fork has children")
    }

    /// Of some children, the one that is thick and goes straight on.
    fn best_child(
        &self,
        before: u32,
        fork: u32,
        children: impl Iterator<Item = u32>,
    ) -> Option<u32> {
        let direction = |a: u32, b: u32| {
            let way = self.base.node(b).center - self.base.node(a).center;
            way.normalize_or_zero()
        };
        let (incoming, radius) = (direction(before, fork), self.radius(fork));
        let score = |&child: &u32| {
            let relative = self.base.node(child).radius / radius;
            relative + incoming.dot(direction(fork, child))
        };
        children.reduce(|best, c| if score(&c) > score(&best) { c } else { best })
    }

    /// Radius of a node; of a fork, as its choice has it.
    pub(super) fn radius(&self, node: u32) -> f64 {
        let own = self.base.node(node).radius;
        if !self.choices[node as usize].is_thickened() || self.children.of(node).len() < 2 {
            return own;
        }
        let around = self.base.neighbors(node).into_iter();
        let mut radii: Vec<f64> = around.map(|n| self.base.node(n).radius).collect();
        radii.sort_by(f64::total_cmp);
        own.max(radii[radii.len() - 2])
    }

    fn leaves_through_insets(&self, fork: u32, main: u32) -> bool {
        let trunk = self.radius(fork).min(self.radius(main));
        if self.children.of(fork).len() >= MAX_NEIGHBORS {
            return false;
        }
        let mut others = self.children.of(fork).iter().filter(|&&c| c != main);
        others.all(|&child| self.base.node(child).radius < MAX_THICK * trunk)
    }
}
