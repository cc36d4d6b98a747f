//! The planes of rings: rings that would cross are turned, or left out.
//!
//! Work is local: a pair is looked at again only when one of its rings was turned or got a new neighbor, so the cost
//! follows the number of bad bends and not the size of the cell.

use glam::DVec3;

use super::MayJoin;
use super::clearance::Disk;
use super::path::{Arm, Inset, Path, PathEnd, Plan, PlannedRing, RingKind};
use super::shape::{TURNED_BACK, is_straight_back, unit_across};
use crate::tracing::{SomaSphere, off_segment};
use crate::warning::Warnings;

/// Times that a ring is turned before it is left out. A guard.
const MAX_TURNS: u8 = 3;
/// A ring is left out only if the path moves by less than this many of its radii. With 1 the axon 172993 has half as many
/// crossings again near forks, and more than twice as many folds.
const MAX_MOVED: f64 = 2.0;
/// Rings are left out only where they are nearer to those that crossed, along the path, than this many radii: half way
/// around the tightest bend and a bit. What lies farther off does not untangle a path that turns back.
const FARTHEST: f64 = 4.0;

/// Gives each ring of a plan its plane, and leaves rings out, until those that follow one another do not cross. A ring is
/// left out only if the path `may_join` its two neighbors, upper and lower.
pub(crate) fn set_planes(
    plan: &mut Plan,
    soma_spheres: &[Option<SomaSphere>],
    may_join: &MayJoin<'_>,
    warnings: &mut Warnings,
) {
    let (mut left_out, mut accepted) = (0, 0);
    for path in &mut plan.paths {
        let mut planes = Planes::new(path, &plan.insets, soma_spheres, may_join);
        planes.uncross();
        let Planes { normals, keep, .. } = planes;
        accepted += planes.accepted;
        left_out += keep.iter().filter(|keep| !**keep).count();
        path.set_planes(&normals, &keep);
    }
    warnings.add_many(
        "sharp_bend",
        left_out,
        "bend tighter than the radius: point left out of the mesh",
    );
    warnings.add_many(
        "rings_cross",
        accepted,
        "path folds back more sharply than its radius allows: the surface crosses itself",
    );
    for number in 0..plan.joints.len() {
        plan.joints[number].normal = joint_normal(plan, number);
    }
}

/// Unit direction of a joint: the sum of its children's, or that from its parent.
fn joint_normal(plan: &Plan, number: usize) -> DVec3 {
    let joint = &plan.joints[number];
    let way = |arm: &Arm| {
        let ring = &plan.paths[arm.path as usize].rings[plan.first_ring(*arm)];
        (ring.center - joint.center).try_normalize()
    };
    let children = joint.arms.iter().filter(|arm| !arm.at_end);
    let sum: DVec3 = children.filter_map(way).sum();
    let parent = joint.arms.first().filter(|arm| arm.at_end).and_then(way);
    match parent {
        Some(parent) if is_straight_back(sum) => -parent,
        _ => sum.try_normalize().unwrap_or(DVec3::Y),
    }
}

impl Path {
    fn set_planes(&mut self, normals: &[DVec3], keep: &[bool]) {
        for (ring, &normal) in self.rings.iter_mut().zip(normals) {
            ring.normal = normal;
        }
        let mut keep = keep.iter();
        self.rings.retain(|_| keep.next() == Some(&true));
    }
}

/// The rings of a path, linked, with their normals as they change.
struct Planes<'a> {
    rings: &'a [PlannedRing],
    path: &'a Path,
    insets: &'a [Inset],
    soma_spheres: &'a [Option<SomaSphere>],
    may_join: &'a MayJoin<'a>,
    normals: Vec<DVec3>,
    keep: Vec<bool>,
    before: Vec<Option<usize>>,
    after: Vec<Option<usize>>,
    turns: Vec<u8>,
    /// How far (µm) each ring is along the path.
    along: Vec<f64>,
    /// Where the rings stood, along the path, that a ring's pair with the one before it stands for.
    crossed: Vec<[f64; 2]>,
    /// Pairs that cross, and for which nothing could be done.
    accepted: usize,
}

impl<'a> Planes<'a> {
    fn new(
        path: &'a Path,
        insets: &'a [Inset],
        soma_spheres: &'a [Option<SomaSphere>],
        may_join: &'a MayJoin<'a>,
    ) -> Self {
        let rings = &path.rings[..];
        let count = rings.len();
        let mut along = vec![0.0; count];
        for i in 1..count {
            along[i] = along[i - 1] + rings[i].center.distance(rings[i - 1].center);
        }
        let mut planes = Self {
            rings,
            path,
            insets,
            soma_spheres,
            may_join,
            normals: Vec::new(),
            keep: vec![true; count],
            before: (0..count).map(|i| i.checked_sub(1)).collect(),
            after: (1..count).map(Some).chain([None]).collect(),
            turns: vec![0; count],
            crossed: (0..count)
                .map(|i| [along[i.saturating_sub(1)], along[i]])
                .collect(),
            along,
            accepted: 0,
        };
        planes.normals = (0..count).map(|i| planes.normal(i)).collect();
        planes
    }

    /// Turns rings, and leaves rings out, until none cross that need not.
    fn uncross(&mut self) {
        let crossing = (0..self.rings.len()).rev().filter(|&j| self.crosses(j));
        let mut pending: Vec<usize> = crossing.collect();
        while let Some(j) = pending.pop() {
            let Some(i) = self.before[j].filter(|_| self.keep[j] && self.crosses(j)) else {
                continue;
            };
            if self.turn(i, j) {
                pending.extend(self.after[j].into_iter().chain([i, j]));
                continue;
            }
            // Where the path turns back twice, the turn beside these may be what is in the way.
            let beside = [self.before[i], self.after[j]].into_iter().flatten();
            let beside = beside.filter(|&n| self.turns_back(n));
            let (cost, ring) = [i, j]
                .into_iter()
                .chain(beside)
                .map(|n| (self.cost(n, [i, j]), n))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap_or((f64::INFINITY, i));
            if cost < MAX_MOVED * self.rings[ring].radius {
                pending.extend(self.leave_out(ring, j));
            } else {
                self.accepted += 1;
            }
        }
    }

    fn direction(&self, from: usize, to: usize) -> Option<DVec3> {
        (self.rings[to].center - self.rings[from].center).try_normalize()
    }

    /// The paper's orientation (García-Cantero et al. 2017): the sum of the unit directions in and out; at an end the
    /// one there is; at a soma that of its first ring, at an inset that of the branch. Rings of a zone may lean towards it,
    /// twice as much as to the other side ([`ForkChoice`](super::ForkChoice)).
    fn normal(&self, i: usize) -> DVec3 {
        let ring = &self.rings[i];
        match self.path.end_at(i) {
            PathEnd::Soma(soma) => {
                if let Some(soma) = &self.soma_spheres[soma as usize] {
                    return soma.axis(ring.center);
                }
            }
            PathEnd::Inset(inset) => {
                let inset = &self.insets[inset as usize];
                return inset.tangent(inset.direction);
            }
            PathEnd::Free | PathEnd::Joint(_) => {}
        }
        let incoming = self.before[i].and_then(|before| self.direction(before, i));
        let Some(after) = self.after[i] else {
            return incoming.unwrap_or(DVec3::Y);
        };
        let outgoing = self.direction(i, after).unwrap_or(DVec3::ZERO);
        let [into, out] = self.weights(ring.kind);
        let sum = outgoing * out + incoming.unwrap_or(DVec3::ZERO) * into;
        match incoming {
            // Straight back: across the path, to the side that is left between the two legs, or to any.
            Some(incoming) if is_straight_back(sum) => {
                // Of a sum that is but rounding no part is.
                let side = Some(sum).filter(|sum| sum.length() > 1e-9);
                let side = side.and_then(|sum| unit_across(sum, incoming));
                side.unwrap_or_else(|| incoming.any_orthonormal_vector())
            }
            _ => sum.try_normalize().unwrap_or(DVec3::Y),
        }
    }

    /// Weights of the directions into a ring and out of it.
    fn weights(&self, kind: RingKind) -> [f64; 2] {
        let RingKind::Zone { begins, ends } = kind else {
            return [1.0; 2];
        };
        let is_leaning = |&inset: &u32| self.insets[inset as usize].leaning;
        let leans = |zone: u32| self.path.zones[zone as usize].iter().any(is_leaning);
        [ends, begins].map(|zone| if zone.is_some_and(leans) { 2.0 } else { 1.0 })
    }

    /// Whether the rings of a pair cross, by the second; joints have no ring of their own.
    fn crosses(&self, j: usize) -> bool {
        let Some(i) = self.before[j] else {
            return false;
        };
        if [i, j].into_iter().any(|n| self.path.end_at(n).is_joint()) {
            return false;
        }
        let disk = |n: usize| Disk {
            center: self.rings[n].center,
            normal: self.normals[n],
            radius: self.rings[n].radius,
        };
        !disk(i).is_clear_of(&disk(j))
    }

    /// Turns the rings of a pair half-way towards the segment between them; false if neither may.
    fn turn(&mut self, i: usize, j: usize) -> bool {
        let Some(way) = self.direction(i, j) else {
            return false;
        };
        let mut turned = false;
        for n in [i, j] {
            let is_fixed = n == 0 || self.path.end_at(n) != PathEnd::Free;
            if !is_fixed && self.turns[n] < MAX_TURNS {
                self.normals[n] = (self.normals[n] + way).try_normalize().unwrap_or(way);
                self.turns[n] += 1;
                turned = true;
            }
        }
        turned
    }

    /// How far the path moves if a ring is left out (µm), since those of `pair` cross; infinite for rings that must stay.
    fn cost(&self, n: usize, pair: [usize; 2]) -> f64 {
        let (Some(before), Some(after)) = (self.before[n], self.after[n]) else {
            return f64::INFINITY;
        };
        let ring = &self.rings[n];
        let turns_back = self.turns_back(n);
        // Where a path turns back, it does so in the tube of the pair.
        let radius = match turns_back {
            true => pair
                .map(|n| self.rings[n].radius)
                .into_iter()
                .fold(ring.radius, f64::max),
            false => ring.radius,
        };
        let [first, last] = self.crossed[pair[1]];
        let farthest = FARTHEST * radius;
        let is_far = self.along[n] < first - farthest || self.along[n] > last + farthest;
        if ring.is_of_zone() || is_far || !self.may_join(before, after) {
            return f64::INFINITY;
        }
        let center = |n: usize| self.rings[n].center;
        let off = off_segment(center(n), center(before), center(after));
        if !turns_back {
            return off;
        }
        off.min(self.off_tube(n, self.before[before], before))
            .min(self.off_tube(n, Some(after), self.after[after].unwrap_or(after)))
    }

    /// Whether the path may go straight from one ring to another.
    fn may_join(&self, from: usize, to: usize) -> bool {
        let [from, to] = [from, to].map(|n| self.rings[n].node);
        // Trunks across forks begin at an end: there the upper node, of the lower number, comes second.
        (self.may_join)(from.min(to), from.max(to))
    }

    /// Whether the path turns back at a ring.
    fn turns_back(&self, n: usize) -> bool {
        let (Some(before), Some(after)) = (self.before[n], self.after[n]) else {
            return false;
        };
        let directions = self.direction(before, n).zip(self.direction(n, after));
        directions.is_none_or(|(incoming, outgoing)| incoming.dot(outgoing) < TURNED_BACK)
    }

    /// How far (µm) a ring is from a segment of its path, before or after it, and by how much it is thicker: where a path
    /// turns back, what is left of it without the ring passes by there once more. Infinite without such a segment.
    fn off_tube(&self, n: usize, from: Option<usize>, to: usize) -> f64 {
        let Some(from) = from.filter(|&from| from != to) else {
            return f64::INFINITY;
        };
        let [ring, from, to] = [n, from, to].map(|n| &self.rings[n]);
        let (way, offset) = (to.center - from.center, ring.center - from.center);
        let share = (offset.dot(way) / way.length_squared()).clamp(0.0, 1.0);
        // Of a segment without a length.
        let share = if share.is_nan() { 0.0 } else { share };
        let radius = from.radius + share * (to.radius - from.radius);
        offset.distance(way * share) + (ring.radius - radius).max(0.0)
    }

    /// Leaves a ring out, since a pair crosses, by its second; returns the rings whose pair with the one before has
    /// changed, the last to be looked at first.
    fn leave_out(&mut self, n: usize, pair: usize) -> Vec<usize> {
        let (Some(before), Some(after)) = (self.before[n], self.after[n]) else {
            return Vec::new();
        };
        self.keep[n] = false;
        self.crossed[after] = self.crossed[pair];
        (self.before[after], self.after[before]) = (Some(before), Some(after));
        for around in [before, after] {
            self.turns[around] = 0;
            self.normals[around] = self.normal(around);
        }
        self.after[after]
            .into_iter()
            .chain([before, after])
            .collect()
    }
}
