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

mod walk;

use glam::DVec3;
use neurotess_morphology::random::Random;

use crate::grown::Grown;
use crate::room::{Capsule, Way};
use crate::spec::{Spec, Tree, Trunk};
use crate::stems;
use walk::State;

/// Fewest points of a section: two so that it has a direction of its own.
const SHORTEST: usize = 3;
/// Rall's exponent.
const RALL: f64 = 1.5;

/// Directions for a stem that are looked at for room.
const STEM_TRIES: u32 = 8;
/// How many of the points that are left one terminal gets at most: about as many as it has.
const LENGTHENED: usize = 60;

/// How many ends of terminals are drawn for it.
const ENDS_DRAWN: usize = 4;

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
    /// One neurite, in a direction far from those taken; gives its own.
    fn stem(&mut self, taken: &[DVec3], points: usize, size: f64) -> DVec3 {
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
        tree.aim.1 -= 0.1 * f64::from(attempt);
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
            tree.aim.1 = (tree.aim.1 - 0.1).max(-1.0);
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
    fn outwards(&mut self) {
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
