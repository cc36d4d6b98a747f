//! Moves branches until none runs through another: one static step of XPBD (Macklin, Müller,
//! Chentanez, XPBD, 2016), in sweeps over elastic constraints and contacts.

use glam::DVec3;
use neurotess_mesh::Watch;

use super::elastic::Elastic;
use super::geometry::{closest, direction};
use super::rods::Rods;
use super::search::{Found, Margin, SOMA_REACH, SomaContact, deepest, search};
use super::side::{self, CROSSED, DEEP, Pair, Sides};
use super::spread::{GAP, Spread};

/// Searches for contacts, at most. A guard.
const MAX_SEARCHES: usize = 30;
/// The same in a crowd, of which each search sees a part only. A guard.
const MAX_IN_CROWD: usize = 4;
/// Sweeps between two searches.
const SWEEPS: usize = 12;
/// What may come into contact between two searches.
const MARGIN: Margin = Margin {
    thin: 1.2,
    thick: 0.2,
};
/// From this search on, normals are taken as they are: that frees bends that hold one another.
const WITHOUT_MEMORY: usize = 6;
/// A contact counts if its line stands across both branches: largest cosine to an axis.
const SLANT: f64 = 0.6;
/// Farthest that one sweep pushes a pair: so many radii of the thinner, and of the thicker one.
const STEP: (f64, f64) = (0.5, 0.1);
/// The same at a soma: radii of the branch, and of the soma.
const SOMA_STEP: (f64, f64) = (0.5, 0.02);
/// After so many searches without a better state there is no hope for one. A guard.
const MAX_WAITING: usize = 10;

/// Moves the points of the rods. Returns whether each search saw all contacts.
pub(super) fn solve(rods: &mut Rods, spread: &Spread, watch: &Watch<'_>) -> bool {
    let mut solver = Solver {
        elastic: Elastic::new(rods, spread),
        pairs: Vec::new(),
        somata: Vec::new(),
        strict: true,
    };
    let moving = solver.elastic.moving();
    let mut sides = Sides::new();
    let mut best = Best::default();
    let mut complete = true;
    for round in 0..=MAX_SEARCHES {
        let found = search(rods, &solver.elastic.centers, MARGIN, Some(&moving));
        complete &= found.complete;
        let most = if complete { MAX_SEARCHES } else { MAX_IN_CROWD };
        let improves = best.improves(rods, &found, &solver.elastic.centers);
        if !improves || round >= most || watch.is_stopped() {
            break;
        }
        solver.strict = round < WITHOUT_MEMORY;
        solver.pairs = side::recall(rods, &sides, &found.contacts);
        solver.somata = found.somata;
        if solver.strict {
            side::complete(rods, &solver.elastic.centers, &mut solver.pairs);
        }
        for sweep in 0..SWEEPS {
            solver.sweep(sweep % 2 == 1);
        }
        let known = solver.pairs.iter().filter(|p| p.side != DVec3::ZERO);
        sides.extend(known.map(|p| ((p.contact.a, p.contact.b), p.side)));
    }
    for (point, center) in rods.points.iter_mut().zip(best.centers) {
        point.node.center = center;
    }
    complete
}

/// The best state so far.
#[derive(Default)]
struct Best {
    /// Sum of depths, each in radii.
    depth: f64,
    centers: Vec<DVec3>,
    /// Searches since.
    waiting: usize,
}

impl Best {
    /// Keeps a state if it is the best; false where it is free of contacts or there is no hope.
    fn improves(&mut self, rods: &Rods, found: &Found, centers: &[DVec3]) -> bool {
        let depth = depth_in_radii(rods, found);
        self.waiting += 1;
        if self.centers.is_empty() || depth < self.depth {
            *self = Self {
                depth,
                centers: centers.to_vec(),
                waiting: 0,
            };
        }
        self.depth > 0.0 && self.waiting < MAX_WAITING
    }
}

fn depth_in_radii(rods: &Rods, found: &Found) -> f64 {
    let thinner = |a: u32, b: u32| rods.radius(a).min(rods.radius(b));
    let pairs = found.contacts.iter();
    let pairs = pairs.map(|c| c.depth.max(0.0) / thinner(c.a, c.b));
    let somata = found.somata.iter();
    let somata = somata.map(|c| c.depth.max(0.0) / rods.radius(c.segment));
    pairs.chain(somata).sum()
}

struct Solver<'a> {
    elastic: Elastic<'a>,
    pairs: Vec<Pair>,
    somata: Vec<SomaContact>,
    /// Whether a contact's line must stand across its branches, on the side that is remembered.
    strict: bool,
}

impl Solver<'_> {
    /// Contacts come last: they hold at the end.
    fn sweep(&mut self, backwards: bool) {
        self.elastic.sweep(backwards);
        for k in 0..self.somata.len() {
            self.leave_soma(self.somata[k]);
        }
        for k in 0..self.pairs.len() {
            self.part(if backwards {
                self.pairs.len() - 1 - k
            } else {
                k
            });
        }
    }

    fn leave_soma(&mut self, contact: SomaContact) {
        let rods = self.elastic.rods;
        let Some(sphere) = &rods.somata[contact.soma as usize] else {
            return;
        };
        let segment = Segment::new(&self.elastic, contact.segment);
        let s = deepest(sphere, segment.ends(&self.elastic));
        let out = segment.at(&self.elastic, s) - sphere.center;
        let surface = sphere.surface(direction(out));
        let radius = segment.radius(rods, s);
        let lack = SOMA_REACH * surface + radius * (1.0 + GAP) - out.length();
        let weight = segment.weight(&self.elastic, s);
        if lack > 0.0 && weight > 0.0 {
            let most = SOMA_STEP.0 * radius + SOMA_STEP.1 * surface;
            let push = direction(out) * (lack.min(most) / weight);
            segment.push(&mut self.elastic, s, push);
        }
    }

    /// Pushes the two of a pair apart.
    fn part(&mut self, k: usize) {
        let Pair { contact, side } = self.pairs[k];
        let rods = self.elastic.rods;
        let elastic = &mut self.elastic;
        let [a, b] = [contact.a, contact.b].map(|i| Segment::new(elastic, i));
        let (s, t) = closest(a.ends(elastic), b.ends(elastic));
        let (ra, rb) = (a.radius(rods, s), b.radius(rods, t));
        let thinner = ra.min(rb);
        let between = a.at(elastic, s) - b.at(elastic, t);
        let (distance, needed) = (between.length(), ra + rb + GAP * thinner);
        if distance >= needed || distance.is_nan() {
            return;
        }
        let meet = distance <= 0.0;
        let line = if meet {
            DVec3::ZERO
        } else {
            direction(between)
        };
        let (along_a, along_b) = (a.along(elastic), b.along(elastic));
        let across = |along: DVec3, free: bool| free || line.dot(along).abs() <= SLANT;
        let stands_across =
            across(along_a, a.free_at(rods, s)) && across(along_b, b.free_at(rods, t));
        if self.strict && !meet && !stands_across {
            return;
        }
        let turned = distance < DEEP * thinner || line.dot(side) < 0.0;
        let (normal, depth) = if meet || (self.strict && turned) {
            let side = if side == DVec3::ZERO {
                side::from_course(rods, &elastic.centers, &contact)
            } else {
                side
            };
            self.pairs[k].side = side;
            let normal = normal_on(side, along_a, along_b);
            (normal, needed - normal.dot(between))
        } else {
            self.pairs[k].side = line;
            (line, needed - distance)
        };
        let weight = a.weight(elastic, s) + b.weight(elastic, t);
        if weight > 0.0 {
            let most = STEP.0 * thinner + STEP.1 * ra.max(rb);
            let push = normal * (depth.min(most) / weight);
            a.push(elastic, s, push);
            b.push(elastic, t, -push);
        }
    }
}

/// The normal of two axes on a side: common to both where they cross.
fn normal_on(side: DVec3, along_a: DVec3, along_b: DVec3) -> DVec3 {
    let common = along_a.cross(along_b);
    if common.length() > CROSSED {
        let common = direction(common);
        return if common.dot(side) >= 0.0 {
            common
        } else {
            -common
        };
    }
    direction(side - side.dot(along_a) * along_a)
}

/// A segment by the numbers of its ends.
#[derive(Clone, Copy)]
struct Segment {
    above: u32,
    below: u32,
}

impl Segment {
    fn new(elastic: &Elastic<'_>, below: u32) -> Self {
        let above = elastic.rods.parent(below);
        Self { above, below }
    }

    fn ends(self, elastic: &Elastic<'_>) -> [DVec3; 2] {
        [self.above, self.below].map(|n| elastic.centers[n as usize])
    }

    fn at(self, elastic: &Elastic<'_>, share: f64) -> DVec3 {
        let [above, below] = self.ends(elastic);
        above.lerp(below, share)
    }

    fn along(self, elastic: &Elastic<'_>) -> DVec3 {
        let [above, below] = self.ends(elastic);
        direction(below - above)
    }

    fn radius(self, rods: &Rods, share: f64) -> f64 {
        let above = rods.radius(self.above);
        above + share * (rods.radius(self.below) - above)
    }

    /// Whether a place is at a free end, where a push may come from any side.
    fn free_at(self, rods: &Rods, share: f64) -> bool {
        (share >= 1.0 && rods.free_end(self.below)) || (share <= 0.0 && rods.free_end(self.above))
    }

    /// How easily a place moves.
    fn weight(self, elastic: &Elastic<'_>, share: f64) -> f64 {
        let weight = |n: u32, share: f64| share * share * elastic.mobility[n as usize];
        weight(self.above, 1.0 - share) + weight(self.below, share)
    }

    fn push(self, elastic: &mut Elastic<'_>, share: f64, push: DVec3) {
        for (n, share) in [(self.above, 1.0 - share), (self.below, share)] {
            elastic.centers[n as usize] += share * elastic.mobility[n as usize] * push;
        }
    }
}
