//! On which side of a branch another one belongs.
//!
//! Where axes nearly meet, the line between them says nothing: the side is remembered from before,
//! taken from the neighbors along the two branches, so that two of a bundle do not change sides half-way, or
//! from where each branch is bent back to its own course.

use std::collections::{HashMap, VecDeque};

use glam::DVec3;

use super::geometry::direction;
use super::rods::Rods;
use super::search::Contact;
use crate::tracing::NONE;

/// Axes nearer than this many radii of the thinner one tell no side.
pub(super) const DEEP: f64 = 0.6;
/// Sine of the angle between two axes above which the side is along their common normal, and share of a neighbor's side that
/// a pair can use.
pub(super) const CROSSED: f64 = 0.2;
/// How far along its branch a course is judged, in sums of the radii.
const COURSE: f64 = 4.0;
/// Points that a walk along a branch passes, at most. A guard.
const MAX_STEPS: usize = 64;

/// Directions from `b` to `a`, by pair of segments. It is only looked up, never gone through, so the order of
/// a hash map changes nothing.
pub(super) type Sides = HashMap<(u32, u32), DVec3>;

/// A contact with its side; zero as long as there is none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) contact: Contact,
    pub(super) side: DVec3,
}

/// The contacts with the sides that were remembered, of a pair or of one beside it.
pub(super) fn recall(rods: &Rods, sides: &Sides, contacts: &[Contact]) -> Vec<Pair> {
    let with_side = |contact: &Contact| {
        let (a, b) = (contact.a, contact.b);
        let (up, down) = (|i: u32| rods.parent(i), |i: u32| rods.only[i as usize]);
        let beside = [
            (a, b),
            (a, up(b)),
            (up(a), b),
            (a, down(b)),
            (down(a), b),
            (up(a), up(b)),
            (down(a), down(b)),
        ];
        let side = beside.into_iter().find_map(|(a, b)| of_pair(sides, a, b));
        Pair {
            contact: *contact,
            side: side.unwrap_or(DVec3::ZERO),
        }
    };
    contacts.iter().map(with_side).collect()
}

fn of_pair(sides: &Sides, a: u32, b: u32) -> Option<DVec3> {
    if a <= b {
        sides.get(&(a, b)).copied()
    } else {
        sides.get(&(b, a)).map(|side| -*side)
    }
}

/// Gives sides to pairs that lie deep in one another and have none: breadth first from shallow and
/// remembered pairs along the bundle, and where there are none, from the pair whose axes cross most clearly.
pub(super) fn complete(rods: &Rods, centers: &[DVec3], pairs: &mut [Pair]) {
    let axes: Vec<Axes> = pairs
        .iter()
        .map(|p| Axes::new(rods, centers, &p.contact))
        .collect();
    let touches = |k: &usize| pairs[*k].contact.depth > 0.0;
    let deep: Vec<bool> = (0..pairs.len())
        .map(|k| touches(&k) && axes[k].deep() && pairs[k].side == DVec3::ZERO)
        .collect();
    if !deep.contains(&true) {
        return;
    }
    let number: HashMap<(u32, u32), usize> = (0..pairs.len())
        .filter(touches)
        .map(|k| ((pairs[k].contact.a, pairs[k].contact.b), k))
        .collect();
    let mut known: Vec<Option<DVec3>> = (0..pairs.len())
        .map(|k| match pairs[k].side {
            DVec3::ZERO => (touches(&k) && !deep[k])
                .then(|| axes[k].across())
                .flatten(),
            side => Some(side),
        })
        .collect();
    let mut pending: VecDeque<usize> = (0..pairs.len()).filter(|&k| known[k].is_some()).collect();
    let mut late: Vec<usize> = (0..pairs.len()).filter(|&k| deep[k]).collect();
    late.sort_by(|&a, &b| axes[b].crossed().total_cmp(&axes[a].crossed()));
    let mut late = late.into_iter();
    loop {
        while let Some(k) = pending.pop_front() {
            let Some(side) = known[k] else { continue };
            for (j, sign) in beside(rods, &pairs[k].contact, &number) {
                if deep[j] && known[j].is_none() {
                    known[j] = axes[j].taken_over(sign * side);
                    pending.extend(known[j].map(|_| j));
                }
            }
        }
        let Some(k) = late.find(|&k| known[k].is_none()) else {
            break;
        };
        known[k] = Some(from_course(rods, centers, &pairs[k].contact));
        pending.push_back(k);
    }
    for k in (0..pairs.len()).filter(|&k| deep[k]) {
        pairs[k].side = known[k].unwrap_or(DVec3::ZERO);
    }
}

/// Pairs beside one along both branches, −1 where `a` and `b` have changed places.
fn beside(
    rods: &Rods,
    contact: &Contact,
    number: &HashMap<(u32, u32), usize>,
) -> Vec<(usize, f64)> {
    let along = |i: u32| [i, rods.parent(i), rods.only[i as usize]];
    let mut list = Vec::new();
    for a in along(contact.a).into_iter().filter(|&a| a != NONE) {
        for b in along(contact.b).into_iter().filter(|&b| b != NONE) {
            let same = number.get(&(a, b)).map(|&k| (k, 1.0));
            let swapped = number.get(&(b, a)).map(|&k| (k, -1.0));
            list.extend(same.or(swapped));
        }
    }
    list
}

/// The axes of a pair where they are nearest.
struct Axes {
    /// From `b` to `a`.
    between: DVec3,
    along_a: DVec3,
    along_b: DVec3,
    thinner: f64,
}

impl Axes {
    fn new(rods: &Rods, centers: &[DVec3], contact: &Contact) -> Self {
        let ends = |i: u32| [rods.parent(i), i].map(|n| centers[n as usize]);
        let (p, q) = (ends(contact.a), ends(contact.b));
        Self {
            between: p[0].lerp(p[1], contact.s) - q[0].lerp(q[1], contact.t),
            along_a: direction(p[1] - p[0]),
            along_b: direction(q[1] - q[0]),
            thinner: rods.radius(contact.a).min(rods.radius(contact.b)),
        }
    }

    fn deep(&self) -> bool {
        self.between.length() < DEEP * self.thinner
    }

    fn crossed(&self) -> f64 {
        self.along_a.cross(self.along_b).length()
    }

    /// The line between them, if it stands across both.
    fn across(&self) -> Option<DVec3> {
        let line = direction(self.between);
        let slant = line
            .dot(self.along_a)
            .abs()
            .max(line.dot(self.along_b).abs());
        (slant < 0.5 && line != DVec3::ZERO).then_some(line)
    }

    /// A neighbor's side as this pair can use it.
    fn taken_over(&self, side: DVec3) -> Option<DVec3> {
        let mut side = side - side.dot(self.along_a) * self.along_a;
        let normal = self.along_a.cross(self.along_b);
        if normal.length() > CROSSED {
            let normal = direction(normal);
            side = normal * side.dot(normal);
        }
        (side.length() >= CROSSED).then(|| direction(side))
    }
}

/// The side towards which each branch is bent back to its own course.
pub(super) fn from_course(rods: &Rods, centers: &[DVec3], contact: &Contact) -> DVec3 {
    let axes = Axes::new(rods, centers, contact);
    let reach = COURSE * (rods.radius(contact.a) + rods.radius(contact.b));
    let middle = |i: u32| {
        let up = walk(rods, centers, rods.parent(i), reach, true);
        0.5 * (up + walk(rods, centers, i, reach, false))
    };
    let courses = middle(contact.a) - middle(contact.b);
    let normal = axes.along_a.cross(axes.along_b);
    if normal.length() > CROSSED {
        let normal = direction(normal);
        return if (2.0 * axes.between + courses).dot(normal) >= 0.0 {
            normal
        } else {
            -normal
        };
    }
    let across = |v: DVec3| v - v.dot(axes.along_a) * axes.along_a;
    let side = across(2.0 * axes.between + courses);
    if side.length() > 1e-9 {
        return direction(side);
    }
    // Twins: any side, always the same.
    let any = across(DVec3::Z);
    direction(if any.length() > 1e-3 {
        any
    } else {
        across(DVec3::Y)
    })
}

/// Where a walk of a length (µm) from a point along its branch ends, or the branch does.
fn walk(rods: &Rods, centers: &[DVec3], from: u32, length: f64, up: bool) -> DVec3 {
    let (mut here, mut left) = (from, length);
    for _ in 0..MAX_STEPS {
        let next = if up {
            rods.parent(here)
        } else {
            rods.only[here as usize]
        };
        if next == NONE {
            break;
        }
        let (at, step) = (
            centers[here as usize],
            centers[next as usize] - centers[here as usize],
        );
        let way = step.length();
        if way >= left && way > 0.0 {
            return at + step * (left / way);
        }
        left -= way;
        here = next;
    }
    centers[here as usize]
}
