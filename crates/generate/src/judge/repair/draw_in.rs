//! Draws in the rings of one stretch until it has no faults, or no fewer.
//!
//! A ring is drawn in by making it thinner and moving its center away from what it is in the way of: the
//! far side of the tube stays about where it was, and less volume is lost than by thinning alone. Rounds
//! draw in all rings at fault a little, thin ones more than the thick ones that they are in the way of. The
//! round with the fewest faults is kept. Then each ring gets back what it need not have given.

use glam::Vec3;
use neurotess_mesh::CoarseMesh;

use super::ring::{Drawn, Ring};
use crate::judge::refined_patches::{Fault, RefinedPatches, count};

/// Rounds of a stretch, and those without fewer faults after which it is left as it was best. Chosen with
/// the example `forks`: twice as many find nothing more.
const MAX_ROUNDS: usize = 14;
const PATIENCE: usize = 4;
/// Share of its radius that a ring at fault keeps in a round.
const STEP: f32 = 0.84;
/// A ring beside much thinner ones gives at least this share of what they give.
const MIN_WEIGHT: f32 = 0.2;
/// Least share of its radius that a ring keeps for the sake of folds: thinner ones look like pinches.
const LEAST: f32 = 0.35;
/// The same for tubes that cross and do not fold. That is hardly seen, as where siblings leave a fork side
/// by side, and a tube much thinner than it was traced is.
const MIN_OF_CROSSING: f32 = 0.7;
/// The center moves by this many times what the radius loses, but no farther than these radii in all.
const PUSH: f32 = 2.0;
const FARTHEST: f32 = 0.7;
/// Of a move, what is along the path counts half: rings must not catch up with their neighbors.
const ALONG: f32 = 0.5;
/// Most by which the shares of rings differ that are a radius or less apart.
const UNEVEN: f32 = 0.3;
/// Shares that rings keep of what they gave, as they are tried in the end.
const KEPT: [f32; 2] = [0.0, 0.5];

/// What a ring is at fault with.
#[derive(Clone, Copy, Debug, Default)]
struct Blame {
    faults: f32,
    /// Whether facets fold there.
    folded: bool,
    /// Faults, those with thinner rings counting less.
    weight: f32,
    /// Sum of the directions away from the others.
    away: Vec3,
}

/// A stretch with its rings.
pub(super) struct DrawIn {
    stretch: RefinedPatches,
    rings: Vec<Ring>,
    drawn: Vec<Drawn>,
}

impl DrawIn {
    /// `is_free`: whether a tracing point of the whole may be drawn in.
    pub(super) fn new(stretch: RefinedPatches, is_free: impl Fn(u32) -> bool) -> Self {
        let rings = Ring::all(&stretch, is_free);
        Self {
            drawn: vec![Drawn::NOT; rings.len()],
            rings,
            stretch,
        }
    }

    /// Whether drawing rings in makes fewer faults than those that the stretch has.
    pub(super) fn run(&mut self, mut faults: Vec<Fault>) -> bool {
        let before = count(&faults);
        let mut best = (before, self.drawn.clone());
        let mut rounds_since = 0;
        for _ in 0..MAX_ROUNDS {
            if best.0 == 0 || rounds_since == PATIENCE {
                break;
            }
            let next = self.next(&faults);
            if next == self.drawn {
                break;
            }
            let changed = self.set(next);
            faults = self.stretch.faults_again(&faults, &changed);
            rounds_since += 1;
            if count(&faults) < best.0 {
                best = (count(&faults), self.drawn.clone());
                rounds_since = 0;
            }
        }
        if best.0 == before {
            return false;
        }
        let changed = self.set(best.1);
        if !changed.is_empty() {
            faults = self.stretch.faults_again(&faults, &changed);
        }
        self.give_back(faults);
        true
    }

    /// Rings at fault a little more drawn in.
    fn next(&self, faults: &[Fault]) -> Vec<Drawn> {
        let mut next = self.drawn.clone();
        for (number, blame) in self.blame(faults).into_iter().enumerate() {
            let ring = &self.rings[number];
            if blame.faults == 0.0 || !ring.free {
                continue;
            }
            let drawn = &mut next[number];
            let before = drawn.scale;
            let least = match blame.folded {
                true => LEAST,
                false => MIN_OF_CROSSING.min(before),
            };
            drawn.scale = (before * STEP.powf(blame.weight / blame.faults)).max(least);
            if ring.shifts() {
                let tangent = ring.point.tangent;
                let way = blame.away - tangent * (ALONG * blame.away.dot(tangent));
                let radius = ring.point.radius;
                let step = PUSH * (before - drawn.scale) * radius;
                let shift = drawn.shift + way.normalize_or_zero() * step;
                drawn.shift = shift.clamp_length_max(FARTHEST * radius);
            }
        }
        self.even_out(&mut next);
        next
    }

    fn blame(&self, faults: &[Fault]) -> Vec<Blame> {
        let mut blame = vec![Blame::default(); self.rings.len()];
        let mesh = &self.stretch.part.mesh;
        let ends = |patch: u32| {
            let corners = mesh.patches[patch as usize].corners;
            [corners[0], corners[2]].map(|v| mesh.vertices[v as usize].tracing)
        };
        for fault in faults {
            let [a, b] = fault.patches.map(ends);
            for (own, others) in [(a, b), (b, a)] {
                let [from, to] = others.map(|t| &mesh.tracing[t as usize]);
                let middle = 0.5 * (from.center + to.center);
                let thickest = from.radius.max(to.radius);
                for ring in own {
                    let point = &mesh.tracing[ring as usize];
                    let share = thickest / point.radius.max(f32::MIN_POSITIVE);
                    let slot = &mut blame[ring as usize];
                    let count = fault.count as f32;
                    slot.faults += count;
                    slot.folded |= fault.folded;
                    slot.weight += count * share.clamp(MIN_WEIGHT, 1.0);
                    let away = (point.center - middle).normalize_or_zero() * count;
                    if !others.contains(&ring) {
                        slot.away += away;
                    } else if fault.folded && a != b {
                        // The ring at which a path turns back moves towards its chord.
                        slot.away -= away;
                    }
                }
            }
        }
        blame
    }

    /// Draws in rings beside much thinner ones, so that none looks like a string around the tube.
    fn even_out(&self, drawn: &mut [Drawn]) {
        for number in (0..self.rings.len()).filter(|&number| self.rings[number].free) {
            drawn[number].scale = drawn[number].scale.min(self.most_even(number, drawn));
        }
    }

    /// Greatest share of its radius that a ring may have beside its neighbors.
    fn most_even(&self, number: usize, drawn: &[Drawn]) -> f32 {
        let ring = &self.rings[number];
        let most = |neighbor: usize| {
            let way = ring
                .point
                .center
                .distance(self.rings[neighbor].point.center);
            let far = way / ring.point.radius.max(f32::MIN_POSITIVE);
            drawn[neighbor].scale + UNEVEN * far.max(1.0)
        };
        ring.neighbors().map(most).fold(1.0, f32::min)
    }

    /// Restores rings as far as that makes no faults, the least drawn in first. `faults`: those that there are.
    fn give_back(&mut self, mut faults: Vec<Fault>) {
        for kept in KEPT {
            let drawn = |number: &usize| self.drawn[*number] != Drawn::NOT;
            let mut order: Vec<usize> = (0..self.rings.len()).filter(drawn).collect();
            let scale = |number: usize| self.drawn[number].scale;
            order.sort_by(|&a, &b| scale(b).total_cmp(&scale(a)).then(a.cmp(&b)));
            for number in order {
                let before = self.drawn[number];
                let even = self.most_even(number, &self.drawn).max(before.scale);
                let less = Drawn {
                    scale: (1.0 + kept * (before.scale - 1.0)).min(even),
                    shift: before.shift * kept,
                };
                if less != before {
                    self.try_one(number, less, &mut faults);
                }
            }
        }
    }

    /// Draws one ring in anew if that makes no faults.
    fn try_one(&mut self, number: usize, drawn: Drawn, faults: &mut Vec<Fault>) {
        let patches = &self.rings[number].patches;
        let concerned = |fault: &Fault| fault.patches.iter().any(|p| patches.contains(p));
        let of_others = |fault: &&Fault| !concerned(fault);
        let others: Vec<Fault> = faults.iter().filter(of_others).copied().collect();
        let most = count(faults) - count(&others);
        let saved = self.stretch.saved(patches);
        self.rings[number].draw(&drawn, &mut self.stretch.part.mesh, number);
        self.stretch.update(patches);
        match self.stretch.faults_of(patches, most) {
            Some(own) => {
                self.drawn[number] = drawn;
                *faults = others;
                faults.extend(own);
            }
            None => {
                let before = &self.drawn[number];
                self.rings[number].draw(before, &mut self.stretch.part.mesh, number);
                self.stretch.restore(patches, &saved);
            }
        }
    }

    /// Draws rings in; returns the patches that changed.
    fn set(&mut self, drawn: Vec<Drawn>) -> Vec<u32> {
        let mut patches: Vec<u32> = Vec::new();
        for (number, drawn) in drawn.into_iter().enumerate() {
            if drawn != self.drawn[number] {
                self.drawn[number] = drawn;
                self.rings[number].draw(&drawn, &mut self.stretch.part.mesh, number);
                patches.extend(&self.rings[number].patches);
            }
        }
        patches.sort_unstable();
        patches.dedup();
        self.stretch.update(&patches);
        patches
    }

    /// Writes the rings that are drawn in into the whole; returns their tracing points there.
    pub(super) fn write(mut self, whole: &mut CoarseMesh) -> Vec<u32> {
        let is_drawn = |number: usize| self.drawn[number] != Drawn::NOT;
        let mut written = Vec::new();
        for (number, ring) in self.rings.iter().enumerate() {
            if !ring.free || !is_drawn(number) && !ring.neighbors().any(is_drawn) {
                continue;
            }
            let part = &mut self.stretch.part;
            ring.lean(&mut part.mesh, number);
            let tracing = part.tracing[number];
            whole.tracing[tracing as usize] = part.mesh.tracing[number];
            for v in ring.vertices() {
                let vertex = &mut whole.vertices[part.vertices[v as usize] as usize];
                let drawn = &part.mesh.vertices[v as usize];
                (vertex.position, vertex.normal) = (drawn.position, drawn.normal);
            }
            if is_drawn(number) {
                written.push(tracing);
            }
        }
        written
    }
}
