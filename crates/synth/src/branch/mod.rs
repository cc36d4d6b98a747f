//! Branches: budgets, walks, radii and forks.
//!
//! ```text
//!  points: 100 ──section of 20──┬── 30: terminal
//!                               └── 50 ──section of 18──┬── 14: terminal
//!                                                       └── 18: terminal
//! ```
//!
//! A branch that finds no way ends early. Its points go to the next branches of the neurite, then to the ends of
//! its terminals, so that none is lost.

mod neurite;
mod walk;

use glam::DVec3;
use neurotess_morphology::random::Random;

use crate::grown::Grown;
use crate::spec::{Spec, Tree, Trunk};
use crate::stems;
use walk::State;

/// Fewest points of a section: two so that it has a direction of its own.
const SHORTEST: usize = 3;
/// Rall's exponent.
const RALL: f64 = 1.5;

/// A branch to come.
#[derive(Clone, Copy)]
struct Branch {
    parent: u32,
    from: DVec3,
    heading: DVec3,
    /// Radius of the point it comes from: its first point lies beyond.
    inside: f64,
    radius: f64,
    /// Points of it and of all that comes of it.
    points: usize,
    /// Side branches that the trunk still gives off; `None` off the trunk.
    sides: Option<Sides>,
    of_fork: OfFork,
    /// It goes on from the end of a terminal.
    goes_on: bool,
}

/// Which daughter of a fork a branch is; the greater one is grown first.
#[derive(Clone, Copy)]
enum OfFork {
    /// None, or of a fork like a T.
    Not,
    Greater,
    Lesser,
}

/// What is left of a trunk.
#[derive(Clone, Copy)]
struct Sides {
    left: u32,
    /// Points of each side branch.
    points: usize,
}

/// Grows the trees of a cell, one after the other.
struct Grower<'a> {
    tree: &'a Tree,
    soma_radius: f64,
    spacing: f64,
    /// Factor of lengths.
    stretch: f64,
    random: &'a mut Random,
    grown: &'a mut Grown,
    /// Points that had no room where they were meant to be.
    unspent: usize,
    /// Branches that would go on from the ends of a neurite's terminals.
    ends: Vec<Branch>,
    /// Numbers of the capsules near a step.
    near: Vec<u32>,
}

/// Mean distance of points (µm). Ten times the points: 4.6 times the branches, 1.7 times as long, samples 1.3
/// times denser.
pub(crate) fn spacing(spec: &Spec, points: usize) -> f64 {
    (spec.spacing * libm::pow(size(spec, points), -0.12)).clamp(1.0, 5.0)
}

/// 1 for a cell of the usual size.
fn size(spec: &Spec, points: usize) -> f64 {
    points as f64 / spec.points as f64
}

/// Appends the neurites of a cell to its soma: `points` in all.
pub(crate) fn grow_all(spec: &Spec, points: usize, random: &mut Random, grown: &mut Grown) {
    let Some(first) = spec.trees.first() else {
        return;
    };
    let size = size(spec, points);
    grown.nodes.reserve_exact(points);
    let mut grower = Grower {
        tree: first,
        soma_radius: grown.nodes[0].radius,
        spacing: spacing(spec, points),
        stretch: libm::pow(size, 0.22),
        random,
        grown,
        unspent: 0,
        ends: Vec::new(),
        near: Vec::new(),
    };
    let shares: Vec<f64> = spec.trees.iter().map(|tree| tree.share).collect();
    let mut taken = Vec::new();
    for (tree, points) in spec.trees.iter().zip(stems::shared(points, &shares)) {
        grower.tree = tree;
        let count = stems::count(tree, points, size, grower.random);
        let weights: Vec<f64> = (0..count)
            .map(|_| grower.random.between((0.7, 1.3)))
            .collect();
        for points in stems::shared(points, &weights) {
            let heading = grower.stem(&taken, points, size);
            taken.push(heading);
        }
    }
    grower.outwards();
}

impl Grower<'_> {
    fn sides(&self, trunk: Trunk, points: usize, size: f64) -> Sides {
        let left = (trunk.sides * libm::pow(size, 0.3)).round();
        let each = trunk.share * points as f64 / left.max(1.0);
        if each < (2 * SHORTEST) as f64 {
            return Sides { left: 0, points: 0 };
        }
        Sides {
            left: left as u32,
            points: each as usize,
        }
    }

    /// Walks one section and pushes its daughters, the greater one on top.
    fn branch(&mut self, branch: Branch, stack: &mut Vec<Branch>) {
        let spent = self.section_points(&branch);
        let first_step = if branch.parent == 0 {
            self.soma_radius
        } else {
            0.0
        };
        let before = self.grown.nodes.len();
        let end = self.walk(&branch, spent, first_step);
        let placed = self.grown.nodes.len() - before;
        if placed < SHORTEST.min(spent) && !branch.goes_on {
            self.grown.keep(before);
            self.unspent += branch.points;
            return;
        }
        let left = branch.points - placed;
        if placed == spent && left == 0 {
            self.ends.push(self.going_on(&end));
            return;
        }
        // Where there is no way, daughters may find one; not out of a hole at the section's start.
        if placed < spent && (left < 2 * SHORTEST || placed < SHORTEST.max(spent / 2)) {
            self.unspent += left;
            return;
        }
        let State {
            at: from,
            heading,
            radius: inside,
            ..
        } = end;
        let parent = self.grown.last();
        let lesser = self.lesser(&branch, left);
        let part = lesser as f64 / left as f64;
        let (thin, thick) = self.daughter_radii(inside, part);
        let (aside, ahead) = self.daughter_headings(&branch, from, heading, part);
        let sides = branch.sides.and_then(|s| {
            (s.left > 0).then(|| Sides {
                left: s.left - 1,
                ..s
            })
        });
        let daughter = |heading, radius, points, sides| Branch {
            parent,
            from,
            heading,
            inside,
            radius,
            points,
            sides,
            of_fork: OfFork::Not,
            goes_on: false,
        };
        let [mut aside, mut ahead] = [
            daughter(aside, thin, lesser, None),
            daughter(ahead, thick, left - lesser, sides),
        ];
        if !(self.is_tee() && branch.sides.is_some()) {
            (aside.of_fork, ahead.of_fork) = (OfFork::Lesser, OfFork::Greater);
        }
        stack.extend([aside, ahead]);
    }

    /// What would go on from the last point.
    fn going_on(&self, end: &State) -> Branch {
        Branch {
            parent: self.grown.last(),
            from: end.at,
            heading: end.heading,
            inside: end.radius,
            radius: end.radius,
            points: 0,
            sides: None,
            of_fork: OfFork::Not,
            goes_on: true,
        }
    }

    /// How many of the branch's points make its first section; all of a terminal's.
    fn section_points(&mut self, branch: &Branch) -> usize {
        let tree = self.tree;
        let (mean, terminal) = match (branch.sides, tree.trunk) {
            (Some(sides), Some(trunk)) if sides.left > 0 || trunk.tee => (trunk.section, 0.0),
            _ => (tree.section, tree.terminal),
        };
        let unit = self.stretch / self.spacing;
        let longest_terminal = terminal * unit * self.random.between((0.6, 1.4));
        // Gamma-like: few very short ones, some long.
        let spread = self.random.unit() + self.random.unit() + self.random.unit();
        let section = (mean * unit * (0.4 + 0.4 * spread)).round() as usize;
        let most = branch.points.saturating_sub(2 * SHORTEST);
        if most < SHORTEST || branch.points as f64 <= longest_terminal {
            return branch.points;
        }
        // A long first section in a small cell must leave something to its daughters.
        section.clamp(SHORTEST, most.min(SHORTEST.max(branch.points * 2 / 5)))
    }

    /// Points of the lesser daughter.
    fn lesser(&mut self, branch: &Branch, left: usize) -> usize {
        let part = self.random.between(self.tree.split);
        let asked = match branch.sides {
            Some(sides) if sides.left > 0 => {
                (sides.points as f64 * self.random.between((0.6, 1.4))) as usize
            }
            Some(_) if self.is_tee() => left / 2,
            _ => (part * left as f64) as usize,
        };
        asked.clamp(SHORTEST, left / 2)
    }

    fn is_tee(&self) -> bool {
        self.tree.trunk.is_some_and(|trunk| trunk.tee)
    }

    /// Rall's law for a daughter with `part` of the points, but none is thinner than the tree gets.
    fn daughter_radii(&self, radius: f64, part: f64) -> (f64, f64) {
        let (a, b) = (libm::pow(part, 0.6), libm::pow(1.0 - part, 0.6));
        let thin = radius * libm::pow(a / (a + b), 1.0 / RALL);
        let thick = radius * libm::pow(b / (a + b), 1.0 / RALL);
        (thin.max(self.tree.thinnest), thick.max(self.tree.thinnest))
    }

    /// The lesser daughter turns aside more.
    fn daughter_headings(
        &mut self,
        branch: &Branch,
        at: DVec3,
        heading: DVec3,
        part: f64,
    ) -> (DVec3, DVec3) {
        if self.is_tee() && branch.sides.is_some() {
            return (DVec3::X, DVec3::NEG_X);
        }
        let angle = self.random.between(self.tree.angle);
        let turn = std::f64::consts::TAU * self.random.unit();
        let (u, v) = heading.any_orthonormal_pair();
        let mut across = u * libm::cos(turn) + v * libm::sin(turn);
        if self.tree.flat {
            let side = if self.random.unit() < 0.5 {
                DVec3::Z
            } else {
                DVec3::NEG_Z
            };
            across = heading.cross(side).normalize_or(across);
        } else if across.dot(at) < -0.3 * at.length() {
            across = -across; // seldom back over the soma
        }
        let turned = |angle: f64| heading * libm::cos(angle) + across * libm::sin(angle);
        (turned(angle * (1.0 - part)), turned(-angle * part))
    }
}
