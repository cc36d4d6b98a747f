//! What holds branches to their traced course: inertia, bending, length.
//!
//! Inertia is the anchor: a point of mass m = r² · length costs m u²/2 for a move of u, so that thin
//! gives way to thick. Bending is that of the *move*, not of the branch: C = uᵢ − β uₚ − (1 − β) u_c with
//! β = h_c/(hₚ + h_c) is zero where the move is linear, and its compliance
//! (hₚ h_c)² / (r² λ⁴ (hₚ + h_c)/2) spreads a push over the length λ.

use glam::DVec3;

use super::rods::Rods;
use super::spread::Spread;
use crate::tracing::NONE;

/// Points within this many spread lengths of a contact move.
const MOVING: f64 = 4.0;
/// Change of a segment's length, at most: as a share.
const STRETCH: f64 = 0.015;

/// Bending at a point between two others.
struct Bend {
    above: usize,
    here: usize,
    below: usize,
    /// β.
    share: f64,
    compliance: f64,
    multiplier: DVec3,
}

/// Inverse masses and elastic constraints; `centers` change.
pub(super) struct Elastic<'a> {
    pub(super) rods: &'a Rods,
    pub(super) centers: Vec<DVec3>,
    /// Inverse mass by point; 0: it stays.
    pub(super) mobility: Vec<f64>,
    bends: Vec<Bend>,
    /// Segments of which an end moves.
    stretched: Vec<u32>,
}

impl<'a> Elastic<'a> {
    pub(super) fn new(rods: &'a Rods, spread: &Spread) -> Self {
        let mobility = mobility(rods, spread);
        let moves = |i: u32| mobility[i as usize] > 0.0;
        let stretched = rods
            .segments()
            .filter(|&i| moves(i) || moves(rods.parent(i)));
        Self {
            stretched: stretched.collect(),
            bends: bends(rods, spread, &mobility),
            centers: rods.centers(),
            mobility,
            rods,
        }
    }

    pub(super) fn moving(&self) -> Vec<bool> {
        self.mobility.iter().map(|&w| w > 0.0).collect()
    }

    /// One sweep over bending and length, from the roots or from the ends.
    pub(super) fn sweep(&mut self, from_ends: bool) {
        for k in 0..self.bends.len() {
            self.bend(if from_ends {
                self.bends.len() - 1 - k
            } else {
                k
            });
        }
        for k in 0..self.stretched.len() {
            let last = self.stretched.len() - 1;
            self.keep_length(self.stretched[if from_ends { last - k } else { k }]);
        }
    }

    fn bend(&mut self, k: usize) {
        let bend = &mut self.bends[k];
        let (above, here, below, share) = (bend.above, bend.here, bend.below, bend.share);
        let centers = &mut self.centers;
        let moved = |n: usize| centers[n] - self.rods.points[n].rest;
        let lack = moved(here) - share * moved(above) - (1.0 - share) * moved(below);
        let weights = [above, here, below].map(|n| self.mobility[n]);
        let sum = weights[1]
            + share * share * weights[0]
            + (1.0 - share) * (1.0 - share) * weights[2]
            + bend.compliance;
        if sum <= 0.0 {
            return;
        }
        let step = -(lack + bend.compliance * bend.multiplier) / sum;
        bend.multiplier += step;
        centers[here] += weights[1] * step;
        centers[above] -= share * weights[0] * step;
        centers[below] -= (1.0 - share) * weights[2] * step;
    }

    fn keep_length(&mut self, segment: u32) {
        let (i, above) = (segment as usize, self.rods.parent(segment) as usize);
        let (weight, weight_above) = (self.mobility[i], self.mobility[above]);
        let way = self.centers[i] - self.centers[above];
        let (length, traced) = (way.length(), self.rods.length[i]);
        let allowed = length.clamp(traced * (1.0 - STRETCH), traced * (1.0 + STRETCH));
        if length <= 0.0 || allowed == length {
            return;
        }
        let step = way * ((length - allowed) / (length * (weight + weight_above)));
        self.centers[i] -= weight * step;
        self.centers[above] += weight_above * step;
    }
}

fn mobility(rods: &Rods, spread: &Spread) -> Vec<f64> {
    let mut half = vec![0.0; rods.count()];
    for i in rods.segments() {
        for end in [i, rods.parent(i)] {
            half[end as usize] += 0.5 * rods.length[i as usize];
        }
    }
    let mobility = |i: u32| {
        if rods.fixed(i) || spread.distance[i as usize] >= MOVING {
            return 0.0;
        }
        let (radius, length) = (rods.radius(i), half[i as usize]);
        // A point with no length about it weighs as if it had a little.
        let mass = radius * radius * length.max(1e-6 * radius);
        let weight = 1.0 / mass;
        if weight.is_finite() { weight } else { 0.0 }
    };
    (0..rods.count() as u32).map(mobility).collect()
}

fn bends(rods: &Rods, spread: &Spread, mobility: &[f64]) -> Vec<Bend> {
    let bend = |below: u32| {
        let here = rods.parent(below);
        let above = rods.parent(here);
        let length = |i: u32| rods.length[i as usize];
        // A ring on a soma is clamped: as if the branch went on within the soma and did not move there.
        let (above, before) = match above {
            NONE if rods.fixed(here) => (here, length(below)),
            NONE => return None,
            above => (above, length(here)),
        };
        if [above, here, below]
            .iter()
            .all(|&n| mobility[n as usize] == 0.0)
        {
            return None;
        }
        let (after, spread) = (length(below), spread.length[here as usize]);
        let stiffness = rods.radius(here).powi(2) * spread.powi(4) * 0.5 * (before + after);
        Some(Bend {
            above: above as usize,
            here: here as usize,
            below: below as usize,
            share: after / (before + after).max(f64::MIN_POSITIVE),
            compliance: (before * after).powi(2) / stiffness.max(1e-30),
            multiplier: DVec3::ZERO,
        })
    };
    rods.segments().filter_map(bend).collect()
}
