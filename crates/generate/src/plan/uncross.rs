//! Rings that would cross are turned, or their points left out.
//!
//! Ring j must lie in front of ring i's plane and ring i behind ring j's. For circles in planes
//! across oᵢ and oⱼ, with L·e the way from i to j, that is `L e·oⱼ > rᵢ sin γ` and
//! `L e·oᵢ > rⱼ sin γ`, γ the angle between the two orientations.
//!
//! Work is local: a pair is looked at again only when one of its rings was turned or got a new
//! neighbor, so the cost follows the number of bad bends and not the size of the cell.

use glam::DVec3;

use crate::plan::{Inset, Layout};
use crate::tracing::SomaSphere;
use crate::tracing::{Children, NONE, Root, Skeleton};
use crate::warning::Warnings;

/// Times that a ring is turned before its point is left out.
const MOST_TURNS: u8 = 3;
/// A point is left out only if the path moves by less than this share of its radius.
const MOST_MOVED: f64 = 2.0;
/// Points are left out only where they are nearer to the rings that crossed, along the path, than this many radii: half
/// way around the tightest bend and a bit. What lies farther off does not untangle a path that turns back.
const FARTHEST: f64 = 4.0;

/// A path that turns by more than 150° turns back: cosine of that.
const TURNED_BACK: f64 = -0.866;

/// Turns rings, or leaves points out, until consecutive rings do not cross. Returns the orientation
/// of every node that is left, along the path. A point is left out only if the path `may_join` its two
/// neighbors, upper and lower, by their nodes in the skeleton that was laid out.
pub(crate) fn uncross_rings(
    layout: &mut Layout,
    soma_spheres: &[Option<SomaSphere>],
    may_join: &dyn Fn(u32, u32) -> bool,
    warnings: &mut Warnings,
) -> Vec<DVec3> {
    let Layout {
        skeleton,
        insets,
        zones,
        ..
    } = layout;
    let is_leaning = |zone: &Vec<u32>| zone.iter().any(|&inset| insets[inset as usize].leaning);
    let leaning: Vec<bool> = zones.iter().map(is_leaning).collect();
    let children = skeleton.children();
    let may_join = |from: u32, to: u32| {
        let base = |n: u32| skeleton.node(n).marks.base;
        // Trunks across forks begin at an end: there the upper node, of the lower number, comes second.
        let [upper, lower] = [base(from).min(base(to)), base(from).max(base(to))];
        lower == NONE || may_join(upper, lower)
    };
    let mut work = Work::new(
        skeleton,
        children,
        soma_spheres,
        insets,
        &leaning,
        &may_join,
    );
    let mut pending: Vec<u32> = (0..work.parent.len() as u32)
        .rev()
        .filter(|&j| work.crosses(j))
        .collect();
    let (mut left_out, mut accepted) = (0, 0);
    while let Some(j) = pending.pop() {
        if !work.keep[j as usize] || !work.crosses(j) {
            continue;
        }
        let i = work.parent[j as usize];
        if work.turn(i, j) {
            pending.extend(
                [work.child[j as usize], i, j]
                    .into_iter()
                    .filter(|&n| n != NONE),
            );
            continue;
        }
        // Where the path turns back twice, the turn beside these may be what is in the way.
        let beside = [work.parent[i as usize], work.child[j as usize]];
        let beside = beside
            .into_iter()
            .filter(|&n| n != NONE && work.turns_back(n));
        let (cost, node) = [i, j]
            .into_iter()
            .chain(beside)
            .map(|n| (work.cost(n, j), n))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((f64::INFINITY, i));
        if cost < MOST_MOVED * work.skeleton.node(node).radius {
            left_out += 1;
            pending.extend(work.leave_out(node, j).into_iter().filter(|&n| n != NONE));
        } else {
            accepted += 1;
        }
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
    let Work {
        keep, orientations, ..
    } = work;
    skeleton.retain(&keep);
    orientations
        .into_iter()
        .zip(keep)
        .filter_map(|(o, keep)| keep.then_some(o))
        .collect()
}

/// Links and orientations as they change.
struct Work<'a> {
    skeleton: &'a Skeleton,
    children: &'a Children,
    soma_spheres: &'a [Option<SomaSphere>],
    insets: &'a [Inset],
    /// By zone: whether its rings lean towards it.
    leaning: &'a [bool],
    may_join: &'a dyn Fn(u32, u32) -> bool,
    keep: Vec<bool>,
    parent: Vec<u32>,
    /// The only child, or [`NONE`] at forks and ends.
    child: Vec<u32>,
    orientations: Vec<DVec3>,
    turns: Vec<u8>,
    /// How far (µm) each node is along the path from its root.
    along: Vec<f64>,
    /// Where the rings stood, along the path, that a node's pair with its parent stands for.
    crossed: Vec<[f64; 2]>,
}

impl<'a> Work<'a> {
    fn new(
        skeleton: &'a Skeleton,
        children: &'a Children,
        soma_spheres: &'a [Option<SomaSphere>],
        insets: &'a [Inset],
        leaning: &'a [bool],
        may_join: &'a dyn Fn(u32, u32) -> bool,
    ) -> Self {
        let count = skeleton.nodes().len();
        let only = |i: u32| match children.of(i) {
            [only] => *only,
            _ => NONE,
        };
        let mut work = Self {
            skeleton,
            children,
            soma_spheres,
            insets,
            leaning,
            may_join,
            keep: vec![true; count],
            parent: skeleton.nodes().iter().map(|n| n.parent).collect(),
            child: (0..count as u32).map(only).collect(),
            orientations: Vec::new(),
            turns: vec![0; count],
            along: vec![0.0; count],
            crossed: vec![[0.0; 2]; count],
        };
        for (i, node) in skeleton.nodes().iter().enumerate() {
            if let Some(parent) = skeleton.nodes().get(node.parent as usize) {
                let before = work.along[node.parent as usize];
                work.along[i] = before + node.center.distance(parent.center);
                work.crossed[i] = [before, work.along[i]];
            }
        }
        work.orientations = (0..count as u32).map(|i| work.orientation(i)).collect();
        work
    }

    fn direction(&self, from: u32, to: u32) -> Option<DVec3> {
        (self.skeleton.node(to).center - self.skeleton.node(from).center).try_normalize()
    }

    /// Paper's orientation: the sum of the unit directions in and out; at an end the one there is;
    /// at a fork the sum of the children's directions; at a soma's ring that away from the soma, at an
    /// inset's that of the branch. Rings of a zone may lean towards it, twice as much as to the other
    /// side ([`ForkChoice`](crate::plan::ForkChoice)).
    fn orientation(&self, i: u32) -> DVec3 {
        let node = self.skeleton.node(i);
        if let Root::Insertion(soma) = node.root
            && let Some(soma_sphere) = self.soma_spheres[soma as usize]
            && let Some(outwards) = (node.center - soma_sphere.center).try_normalize()
        {
            return outwards;
        }
        if let Some(inset) = node.inset() {
            let inset = self.insets[inset as usize];
            return inset.tangent(inset.direction);
        }
        let parent = Some(self.parent[i as usize]).filter(|&p| p != NONE);
        let incoming = parent.and_then(|p| self.direction(p, i));
        let sum = match self.child[i as usize] {
            NONE => self
                .children
                .of(i)
                .iter()
                .filter_map(|&c| self.direction(i, c))
                .sum(),
            child => {
                let leaning = |zone: u32| zone != NONE && self.leaning[zone as usize];
                let weight = |zone: u32| if leaning(zone) { 2.0 } else { 1.0 };
                let outgoing = self.direction(i, child).unwrap_or(DVec3::ZERO);
                outgoing * weight(node.marks.zone_begins)
                    + incoming.unwrap_or(DVec3::ZERO) * weight(node.marks.zone_ends)
            }
        };
        let sum: DVec3 = sum;
        if sum.length() > 0.1 {
            return sum.try_normalize().unwrap_or(DVec3::Y);
        }
        match incoming {
            Some(incoming) if self.child[i as usize] == NONE => incoming,
            // Straight back: across the path, to the side that is left between the two legs, or to any.
            Some(incoming) => {
                let side = sum - incoming * sum.dot(incoming);
                side.try_normalize()
                    .unwrap_or_else(|| incoming.any_orthonormal_vector())
            }
            None => sum.try_normalize().unwrap_or(DVec3::Y),
        }
    }

    fn fork(&self, i: u32) -> bool {
        self.children.of(i).len() > 1
    }

    /// Whether the rings of a node and its parent cross; forks have no ring of their own.
    fn crosses(&self, j: u32) -> bool {
        let i = self.parent[j as usize];
        if i == NONE || self.fork(i) || self.fork(j) {
            return false;
        }
        let (a, b) = (self.skeleton.node(i), self.skeleton.node(j));
        let (oi, oj) = (self.orientations[i as usize], self.orientations[j as usize]);
        let way = b.center - a.center;
        let sin = if oi.dot(oj) < 0.0 {
            1.0
        } else {
            oi.cross(oj).length()
        };
        let clear = |ahead: f64, radius: f64| ahead > 1.05 * radius * sin;
        !clear(way.dot(oj), a.radius) || !clear(way.dot(oi), b.radius)
    }

    /// Turns the rings of a pair half-way towards the segment between them; false if neither may.
    fn turn(&mut self, i: u32, j: u32) -> bool {
        let Some(way) = self.direction(i, j) else {
            return false;
        };
        let mut turned = false;
        for n in [i, j] {
            let slot = n as usize;
            let fixed = self.parent[slot] == NONE || self.skeleton.node(n).marks.ends_in != NONE;
            if !fixed && !self.fork(n) && self.turns[slot] < MOST_TURNS {
                self.orientations[slot] = (self.orientations[slot] + way)
                    .try_normalize()
                    .unwrap_or(way);
                self.turns[slot] += 1;
                turned = true;
            }
        }
        turned
    }

    /// How far the path moves if a node is left out (µm), since the rings of `pair` and its parent cross; infinite for
    /// those that may not be.
    fn cost(&self, n: u32, pair: u32) -> f64 {
        let (parent, child) = (self.parent[n as usize], self.child[n as usize]);
        let fixed = parent == NONE || child == NONE || self.skeleton.node(n).marks.of_zone();
        let [first, last] = self.crossed[pair as usize];
        let along = self.along[n as usize];
        let turns_back = self.turns_back(n);
        // Where a path turns back, it does so in the tube of the pair.
        let radius = match turns_back {
            true => self
                .skeleton
                .node(pair)
                .radius
                .max(self.skeleton.node(self.parent[pair as usize]).radius),
            false => self.skeleton.node(n).radius,
        };
        let farthest = FARTHEST * radius.max(self.skeleton.node(n).radius);
        let far = along < first - farthest || along > last + farthest;
        if fixed || far || !(self.may_join)(parent, child) {
            return f64::INFINITY;
        }
        let center = |n: u32| self.skeleton.node(n).center;
        let off = crate::tracing::off_segment(center(n), center(parent), center(child));
        if !turns_back {
            return off;
        }
        off.min(self.off_tube(n, self.parent[parent as usize], parent))
            .min(self.off_tube(n, child, self.child[child as usize]))
    }

    /// Whether the path turns back at a node.
    fn turns_back(&self, n: u32) -> bool {
        let (parent, child) = (self.parent[n as usize], self.child[n as usize]);
        if parent == NONE || child == NONE {
            return false;
        }
        let directions = self.direction(parent, n).zip(self.direction(n, child));
        directions.is_none_or(|(incoming, outgoing)| incoming.dot(outgoing) < TURNED_BACK)
    }

    /// How far (µm) a node is from a segment of its path, before or after it, and by how much it is thicker: where a path
    /// turns back, what is left of it without the node passes by there once more. Infinite without such a segment.
    fn off_tube(&self, n: u32, from: u32, to: u32) -> f64 {
        if from == NONE || to == NONE {
            return f64::INFINITY;
        }
        let [node, from, to] = [n, from, to].map(|n| self.skeleton.node(n));
        let (way, offset) = (to.center - from.center, node.center - from.center);
        let share = (offset.dot(way) / way.length_squared()).clamp(0.0, 1.0);
        // Of a segment without a length.
        let share = if share.is_nan() { 0.0 } else { share };
        let radius = from.radius + share * (to.radius - from.radius);
        offset.distance(way * share) + (node.radius - radius).max(0.0)
    }

    /// Leaves an ordinary node of a pair out; returns the nodes whose pair with their parent has changed.
    fn leave_out(&mut self, n: u32, pair: u32) -> [u32; 4] {
        let (parent, child) = (self.parent[n as usize], self.child[n as usize]);
        self.keep[n as usize] = false;
        self.crossed[child as usize] = self.crossed[pair as usize];
        self.parent[child as usize] = parent;
        if self.child[parent as usize] == n {
            self.child[parent as usize] = child;
        }
        for around in [parent, child] {
            self.turns[around as usize] = 0;
            self.orientations[around as usize] = self.orientation(around);
        }
        [self.child[child as usize], parent, child, NONE]
    }
}
