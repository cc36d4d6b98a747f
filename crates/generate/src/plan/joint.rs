//! Joints: where three or more tubes meet.
//!
//! ```text
//!            pole +
//!     b  ╲    │    ╱  a        neighbors a, b, c in order of their angle about the normal n
//!         ╲ v │ ╱              (n points at you; pole − lies behind pole +)
//!     v ───── ● ───── v        one vertex v between two consecutive neighbors
//!             │
//!             │ c              ring of a neighbor: pole +, vertex before, pole −, vertex after
//! ```
//!
//! The paper joins a fork with four vertices of the parent's quad and one more, v′. That is this
//! rule for three neighbors: k + 2 vertices, and every edge from a pole to a vertex is shared by
//! exactly the two tubes beside it, so the joint is closed for every k.
//!
//! Where a vertex lies: the tubes of two neighbors a and b, of radii ra and rb, whose directions
//! enclose φ, part at distance ra from a's axis and rb from b's. With θ the angle from a,
//! `tan θ = ra sin φ / (rb + ra cos φ)` and the distance is `ra / sin θ` (own derivation; for equal
//! radii the known `r / sin(φ/2)` on the bisector).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

/// A neighbor as the joint sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbor {
    /// Unit direction from the joint.
    pub(crate) direction: DVec3,
    /// Distance of the neighbor's own ring (µm).
    pub(crate) length: f64,
    /// Radius of the neighbor's tube where it leaves the joint (µm).
    pub(crate) radius: f64,
}

impl Neighbor {
    /// The neighbor whose ring is at `ring`, seen from a joint. `share`: of the way between them that is this joint's.
    pub(crate) fn new(joint: DVec3, ring: DVec3, radius: f64, share: f64) -> Self {
        let way = ring - joint;
        Self {
            direction: way.try_normalize().unwrap_or(DVec3::Y),
            length: way.length() * share,
            radius,
        }
    }

    /// The same with all the room there may be.
    pub(crate) fn without_limit(self) -> Self {
        Self {
            length: f64::INFINITY,
            ..self
        }
    }
}

/// The vertices of a joint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct JointShape {
    /// Normal of the plane that the neighbors lie in.
    pub(crate) normal: DVec3,
    /// The poles on the side of the normal and on the other, relative to the center.
    pub(crate) poles: [DVec3; 2],
    /// Neighbors in order of their angle about the normal.
    pub(crate) order: Vec<usize>,
    /// `crotches[i]` lies between neighbor `order[i]` and the next; relative to the center.
    pub(crate) crotches: Vec<DVec3>,
}

/// Least angle between two consecutive neighbors about the normal; nearer ones are spread.
const MIN_GAP: f64 = 0.12;
/// Slope against the plane up to which a neighbor that leans draws poles and crotches along.
const STEEPEST: f64 = 2.0;
/// A crotch stays behind this share of the way to either neighbor's ring.
const BEFORE_RING: f64 = 0.85;

impl JointShape {
    /// Joins tubes at a point of radius `radius`.
    pub(crate) fn new(radius: f64, neighbors: &[Neighbor]) -> Self {
        let directions: Vec<DVec3> = neighbors.iter().map(|n| n.direction).collect();
        let (normal, _) = plane(&directions);
        let (e1, e2) = normal.any_orthonormal_pair();
        let angle = |d: DVec3| f64::atan2(d.dot(e2), d.dot(e1));
        let mut order: Vec<usize> = (0..neighbors.len()).collect();
        order.sort_by(|&a, &b| {
            angle(directions[a])
                .total_cmp(&angle(directions[b]))
                .then(a.cmp(&b))
        });
        let mut angles: Vec<f64> = order.iter().map(|&i| angle(directions[i])).collect();
        spread(&mut angles);
        let k = order.len();
        let crotches = (0..k)
            .map(|i| {
                let (a, b) = (&neighbors[order[i]], &neighbors[order[(i + 1) % k]]);
                let gap = (angles[(i + 1) % k] - angles[i]).rem_euclid(TAU);
                let (turn, distance) = crotch(gap, radius, a, b);
                let around = angles[i] + turn;
                let flat = e1 * around.cos() + e2 * around.sin();
                let tilt = if gap < PI {
                    tilt(a, b, normal, turn / gap)
                } else {
                    0.0
                };
                (flat + normal * tilt).try_normalize().unwrap_or(flat) * distance
            })
            .collect();
        Self {
            normal,
            poles: poles(radius, normal, &directions),
            order,
            crotches,
        }
    }

    /// Where a neighbor is in the order.
    ///
    /// # Panics
    /// If the joint has no neighbor of this number.
    pub(crate) fn slot(&self, neighbor: usize) -> usize {
        let slot = self.order.iter().position(|&n| n == neighbor);
        slot.expect("the order has each neighbor once")
    }

    /// How far the joint reaches along a neighbor's direction (µm).
    pub(crate) fn reach(&self, neighbor: usize, direction: DVec3) -> f64 {
        let k = self.order.len();
        let slot = self.slot(neighbor);
        let beside = [self.crotches[slot], self.crotches[(slot + k - 1) % k]];
        beside
            .into_iter()
            .chain(self.poles)
            .map(|v| v.dot(direction))
            .fold(0.0, f64::max)
    }
}

/// Angle from a, and distance, of the vertex between two neighbors that enclose `gap`.
fn crotch(gap: f64, radius: f64, a: &Neighbor, b: &Neighbor) -> (f64, f64) {
    if gap >= PI {
        return (0.5 * gap, radius);
    }
    // Towards a straight line the two radii count as the joint's own, or the vertex would run off.
    let straight = smoothstep((gap - FRAC_PI_2) / FRAC_PI_2);
    let tube = |r: f64| r.min(radius) + straight * (radius - r.min(radius));
    let (ra, rb) = (tube(a.radius), tube(b.radius));
    let turn = f64::atan2(ra * gap.sin(), rb + ra * gap.cos());
    let free = ra / turn.sin();
    let room = |length: f64, off: f64| {
        if off.cos() > 0.0 {
            BEFORE_RING * length / off.cos()
        } else {
            f64::INFINITY
        }
    };
    let cap = room(a.length, turn).min(room(b.length, gap - turn));
    (turn, free.max(radius).min(cap.max(0.5 * radius)))
}

fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Slope of a direction against the plane, at most [`STEEPEST`].
fn slope(direction: DVec3, normal: DVec3) -> f64 {
    let up = direction.dot(normal);
    let flat = (1.0 - up * up).max(f64::MIN_POSITIVE).sqrt();
    (up / flat).clamp(-STEEPEST, STEEPEST)
}

/// Slope between those of the two neighbors.
fn tilt(a: &Neighbor, b: &Neighbor, normal: DVec3, share: f64) -> f64 {
    slope(a.direction, normal) * (1.0 - share) + slope(b.direction, normal) * share
}

/// Poles, farther out where the neighbors lean towards them.
fn poles(radius: f64, normal: DVec3, directions: &[DVec3]) -> [DVec3; 2] {
    [1.0, -1.0].map(|side| {
        let slopes = directions.iter().map(|&d| slope(d, side * normal));
        let steepest = slopes.fold(0.0, f64::max);
        normal * (side * radius * (1.0 + steepest * steepest).sqrt())
    })
}

/// Moves angles apart that are nearer than [`MIN_GAP`]; ascending, within one turn.
fn spread(angles: &mut [f64]) {
    let k = angles.len();
    let least = MIN_GAP.min(TAU / (2.0 * k as f64));
    for _ in 0..20 {
        let mut moved = false;
        for i in 0..k {
            let wrap = if i + 1 == k { TAU } else { 0.0 };
            let lack = least - (angles[(i + 1) % k] + wrap - angles[i]);
            if lack > 1e-9 {
                angles[i] -= 0.5 * lack;
                angles[(i + 1) % k] += 0.5 * lack;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
}

/// Normal about which the directions are farthest apart, and the least angle between two
/// consecutive ones about it.
///
/// Candidates are the normals of the planes through any three tips (for three directions the plane
/// of least variance exactly) and of those through the center and any two; the one with the widest
/// least gap wins, with a penalty for directions that lean out of the plane.
pub(crate) fn plane(directions: &[DVec3]) -> (DVec3, f64) {
    let mut best = (DVec3::Y, f64::NEG_INFINITY, 0.0);
    let mut judge = |normal: DVec3| {
        let Some(normal) = normal.try_normalize() else {
            return;
        };
        let gap = least_gap(normal, directions);
        let lean = directions
            .iter()
            .map(|d| d.dot(normal).abs())
            .fold(0.0, f64::max);
        let score = gap - lean;
        if score > best.1 + 1e-12 {
            best = (normal, score, gap);
        }
    };
    let k = directions.len();
    for a in 0..k {
        for b in a + 1..k {
            judge(directions[a].cross(directions[b]));
            for c in b + 1..k {
                judge((directions[b] - directions[a]).cross(directions[c] - directions[a]));
            }
        }
    }
    if best.1 == f64::NEG_INFINITY {
        let fallback = directions
            .first()
            .map_or(DVec3::Y, |d| d.any_orthonormal_vector());
        return (fallback, 0.0);
    }
    (best.0, best.2)
}

fn least_gap(normal: DVec3, directions: &[DVec3]) -> f64 {
    let (e1, e2) = normal.any_orthonormal_pair();
    let mut angles: Vec<f64> = directions
        .iter()
        .map(|d| f64::atan2(d.dot(e2), d.dot(e1)))
        .collect();
    angles.sort_by(f64::total_cmp);
    let wrap = angles[0] + TAU - angles[angles.len() - 1];
    angles.windows(2).map(|w| w[1] - w[0]).fold(wrap, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn neighbor(x: f64, y: f64, z: f64, radius: f64) -> Neighbor {
        let direction = DVec3::new(x, y, z).try_normalize().unwrap();
        Neighbor {
            direction,
            length: 10.0,
            radius,
        }
    }

    #[test]
    fn equal_tubes_part_on_the_bisector() {
        let (a, b) = (
            neighbor(1.0, 0.0, 0.0, 1.0),
            neighbor(0.5, 0.75_f64.sqrt(), 0.0, 1.0),
        );
        let (turn, distance) = crotch(PI / 3.0, 1.0, &a, &b);
        assert!((turn - PI / 6.0).abs() < 1e-12);
        assert!((distance - 2.0).abs() < 1e-12);
    }

    #[test]
    fn tilted_parent_does_not_hide_a_narrow_pair() {
        let directions = [
            DVec3::new(0.0, 0.17, -0.98),
            DVec3::new(0.087, 0.0, 0.996),
            DVec3::new(-0.087, 0.0, 0.996),
        ]
        .map(DVec3::normalize_or_zero);
        let (normal, gap) = plane(&directions);
        assert!(normal.y.abs() > 0.9, "{normal}");
        assert!(gap > 0.15);
    }

    #[test]
    fn every_crotch_lies_between_its_neighbors() {
        let tubes = [
            neighbor(0.0, 0.0, -1.0, 1.0),
            neighbor(0.6, 0.1, 1.0, 0.4),
            neighbor(-0.5, -0.1, 1.0, 0.8),
            neighbor(1.0, 0.2, -0.1, 0.5),
        ];
        let joint = JointShape::new(1.0, &tubes);
        let (e1, e2) = joint.normal.any_orthonormal_pair();
        let angle = |d: DVec3| f64::atan2(d.dot(e2), d.dot(e1));
        for i in 0..4 {
            let from = angle(tubes[joint.order[i]].direction);
            let to = (angle(tubes[joint.order[(i + 1) % 4]].direction) - from).rem_euclid(TAU);
            let at = (angle(joint.crotches[i]) - from).rem_euclid(TAU);
            assert!(at > 0.0 && at < to);
            assert!(joint.crotches[i].length() >= 0.89);
        }
    }
}
