//! Branches: budgets, walks, radii and forks.
//!
//! ```text
//!  points: 100 ──section of 20──┬── 30: terminal
//!                               └── 50 ──section of 18──┬── 14: terminal
//!                                                       └── 18: terminal
//! ```

use glam::DVec3;
use neurotess_morphology::Node;

use crate::spec::{Spec, Tree, Tropism, Trunk};
use crate::stems;
use neurotess_morphology::random::Random;

/// Fewest points of a section: two so that it has a direction of its own.
const SHORTEST: usize = 3;
/// Length (µm) over which the wobble forgets itself: between the 2 µm of jitter in tracings and
/// the 50 µm of bends. By eye.
const MEMORY: f64 = 9.0;
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
}

/// What is left of a trunk.
#[derive(Clone, Copy)]
struct Sides {
    left: u32,
    /// Points of each side branch.
    points: usize,
}

/// How a tree of the cell differs from its spec by the cell's size.
struct Grower<'a> {
    tree: &'a Tree,
    soma_radius: f64,
    spacing: f64,
    /// Factor of lengths.
    stretch: f64,
    random: &'a mut Random,
    nodes: &'a mut Vec<Node>,
}

/// Appends the neurites of a cell to its soma's samples: `points` in all.
pub(crate) fn grow_all(spec: &Spec, points: usize, random: &mut Random, nodes: &mut Vec<Node>) {
    let size = points as f64 / spec.points as f64;
    // Ten times the points: 4.6 times the branches, 1.7 times as long, samples 1.3 times denser.
    let spacing = (spec.spacing * libm::pow(size, -0.12)).clamp(1.0, 5.0);
    let stretch = libm::pow(size, 0.22);
    let soma_radius = nodes[0].radius;
    nodes.reserve_exact(points);
    let shares: Vec<f64> = spec.trees.iter().map(|tree| tree.share).collect();
    let mut taken = Vec::new();
    for (tree, points) in spec.trees.iter().zip(stems::shared(points, &shares)) {
        let count = stems::count(tree, points, size, random);
        let weights: Vec<f64> = (0..count).map(|_| random.between((0.7, 1.3))).collect();
        for points in stems::shared(points, &weights) {
            let heading = stems::direction(tree, &taken, random);
            taken.push(heading);
            Grower {
                tree,
                soma_radius,
                spacing,
                stretch,
                random,
                nodes,
            }
            .stem(heading, points, size);
        }
    }
}

impl Grower<'_> {
    /// One neurite, depth first.
    fn stem(&mut self, heading: DVec3, points: usize, size: f64) {
        let radius = self.tree.radius * self.random.between((0.85, 1.15));
        let sides = self.tree.trunk.map(|trunk| self.sides(trunk, points, size));
        // The first step leads `spacing` further: out of the soma.
        let from = heading * (self.soma_radius + radius - self.spacing).max(0.5 * self.soma_radius);
        let mut stack = vec![Branch {
            parent: 0,
            from,
            heading,
            inside: 0.0,
            radius,
            points,
            sides,
        }];
        while let Some(branch) = stack.pop() {
            self.branch(branch, &mut stack);
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
        let left = branch.points - spent;
        let first_step = if branch.parent == 0 {
            self.soma_radius
        } else {
            0.0
        };
        let (from, heading, inside) = self.walk(&branch, spent, first_step);
        if left == 0 {
            return;
        }
        let parent = (self.nodes.len() - 1) as u32;
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
        };
        stack.push(daughter(aside, thin, lesser, None));
        stack.push(daughter(ahead, thick, left - lesser, sides));
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

    /// Appends the points of one section; gives its last position, heading and radius.
    fn walk(&mut self, branch: &Branch, points: usize, clear_of: f64) -> (DVec3, DVec3, f64) {
        let thinnest = self.tree.thinnest.min(branch.radius);
        let mut at = branch.from;
        let mut heading = branch.heading;
        let mut wobble = DVec3::ZERO;
        let (mut parent, mut taper) = (branch.parent, 1.0);
        let mut radius = branch.radius;
        for i in 0..points {
            let widest = if i == 0 {
                radius.max(branch.inside)
            } else {
                radius
            };
            let step = (self.spacing * self.random.between((0.8, 1.2))).max(1.1 * widest);
            heading = self.bent(heading, at, step);
            wobble = self.wobbled(wobble, step);
            let mut sideways = wobble - heading * wobble.dot(heading);
            if self.tree.flat {
                sideways.z *= 0.2;
            }
            at += (heading + sideways).normalize_or(heading) * step;
            if i == 0 && at.length() < clear_of + radius {
                at = at.normalize_or(heading) * (clear_of + radius);
            }
            if i > 0 {
                taper *= libm::exp(-step / (self.tree.taper * self.stretch));
            }
            radius = thinnest + (branch.radius - thinnest) * taper;
            let inner = i > 0 && i + 1 < points;
            let swell = if inner {
                self.random.between((0.92, 1.08))
            } else {
                1.0
            };
            parent = self.push(parent, at, radius * swell);
        }
        (at, heading, radius)
    }

    /// The heading after tropism, what keeps a flat tree flat, and what keeps it out of the soma.
    fn bent(&self, heading: DVec3, at: DVec3, step: f64) -> DVec3 {
        let away = at.normalize_or(heading);
        let (to, strength) = match self.tree.tropism {
            Tropism::Away(strength) => (away, strength),
            Tropism::To(to, strength) => (to, strength),
        };
        let mut bent = heading + to * (strength / self.stretch * step);
        if at.length() < 1.5 * self.soma_radius {
            bent += away * 0.3;
        }
        if self.tree.flat {
            bent.z = 0.5 * bent.z - 0.01 * at.z;
        }
        bent.normalize_or(heading)
    }

    /// One step of an Ornstein-Uhlenbeck process in space.
    fn wobbled(&mut self, wobble: DVec3, step: f64) -> DVec3 {
        let keep = libm::exp(-step / MEMORY);
        let ((x, y), (z, _)) = (self.random.normal_pair(), self.random.normal_pair());
        let kick = self.tree.wobble * (1.0 - keep * keep).sqrt();
        wobble * keep + DVec3::new(x, y, z) * kick
    }

    /// Appends a point, rounded as files have it: thousandths, radii to a tenth of that.
    fn push(&mut self, parent: u32, at: DVec3, radius: f64) -> u32 {
        let index = self.nodes.len() as u32;
        self.nodes.push(Node {
            id: i64::from(index) + 1,
            kind: self.tree.kind,
            position: (at * 1e3).round() / 1e3,
            radius: (radius * 1e4).round() / 1e4,
            parent: Some(parent),
        });
        index
    }
}
