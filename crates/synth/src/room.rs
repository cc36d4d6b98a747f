//! What of a cell is grown already, so that no branch grows through another.
//!
//! **Theory.** Each step of a branch is a capsule: a segment and the greatest radius on it. Two capsules are
//! apart if their segments are at least their radii, [`SWAY`] and [`GAP`] from each other; the surface of a
//! mesh then leaves a gap, since its curved path sways by up to 0.12 of the radius. Right behind a fork that
//! cannot be: there branches must [diverge](DIVERGENCE), so that they are apart soon.
//!
//! ```text
//!            ╱ ╱        apart: at least both radii from the sibling
//!       ____╱ ╱
//!       ____╳           diverging: the distance is at least 0.6 of the way between the two
//!            ╲ ╲        along the tree
//! ```
//!
//! **Practice.** A hashed grid: each bucket is a list of the capsules whose boxes touch its cells. Cells that
//! share a bucket cost time, but change no answer. A step looks at some tens of capsules, however large the
//! cell. The last capsule can be taken back, which is how a branch backs off.

use glam::{DVec3, IVec3};

/// Distance between the membranes of two branches, at least (µm).
const GAP: f64 = 0.1;
/// Factor on radii for the sway of a mesh's path, and for soma that a stem pulls along.
const SWAY: f64 = 1.15;
/// Sine of the least angle between branches behind a fork: 37°. Below that the mesher leaves out so many
/// points that siblings are one for a while.
const DIVERGENCE: f64 = 0.6;
/// No entry, no parent.
const NONE: u32 = u32::MAX;

/// One step of a branch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Capsule {
    pub(crate) from: DVec3,
    pub(crate) to: DVec3,
    /// Greatest radius on it.
    pub(crate) radius: f64,
    /// Number of the capsule that it goes on from, in the order of adding; `None` at the soma.
    pub(crate) parent: Option<u32>,
}

/// What stands in a capsule's way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// Nothing.
    Free,
    /// Nothing yet, but farther on.
    Ends,
    /// Something.
    Blocked,
}

/// A capsule that is there.
#[derive(Clone, Copy, Debug)]
struct Grown {
    segment: [DVec3; 2],
    radius: f64,
    parent: u32,
    /// Length of the path from the soma to its end.
    path: f64,
    /// Number of entries before its own.
    entries: usize,
}

/// A capsule in a bucket's list.
#[derive(Clone, Copy, Debug)]
struct Entry {
    capsule: u32,
    bucket: u32,
    next: u32,
}

/// The soma and the capsules of a cell.
#[derive(Debug)]
pub(crate) struct Room {
    soma_radius: f64,
    /// Side of a cell of the grid.
    side: f64,
    capsules: Vec<Grown>,
    entries: Vec<Entry>,
    /// The last entry of each bucket; a power of two of them.
    heads: Vec<u32>,
}

impl Room {
    /// Room around a soma at the origin for about `points` steps of `spacing`.
    pub(crate) fn new(soma_radius: f64, points: usize, spacing: f64) -> Self {
        Self {
            soma_radius,
            side: 3.0 * spacing,
            capsules: Vec::with_capacity(points),
            entries: Vec::with_capacity(2 * points),
            heads: vec![NONE; (2 * points).next_power_of_two()],
        }
    }

    /// Takes the next number for a capsule.
    pub(crate) fn add(&mut self, capsule: &Capsule) {
        let number = self.capsules.len() as u32;
        let entries = self.entries.len();
        let (low, high) = self.cells([capsule.from, capsule.to], SWAY * capsule.radius);
        for cell in cells_between(low, high) {
            let bucket = self.bucket(cell);
            let head = &mut self.heads[bucket];
            let next = std::mem::replace(head, self.entries.len() as u32);
            self.entries.push(Entry {
                capsule: number,
                bucket: bucket as u32,
                next,
            });
        }
        let before = capsule
            .parent
            .map_or(0.0, |p| self.capsules[p as usize].path);
        self.capsules.push(Grown {
            segment: [capsule.from, capsule.to],
            radius: capsule.radius,
            parent: capsule.parent.unwrap_or(NONE),
            path: before + capsule.from.distance(capsule.to),
            entries,
        });
    }

    /// Takes back all capsules but the first `count`.
    pub(crate) fn keep(&mut self, count: usize) {
        while self.capsules.len() > count {
            let Some(last) = self.capsules.pop() else {
                return;
            };
            for entry in self.entries.drain(last.entries..).rev() {
                self.heads[entry.bucket as usize] = entry.next;
            }
        }
    }

    /// Numbers of the capsules within `reach` of a place, ascending.
    pub(crate) fn near(&self, place: DVec3, reach: f64, found: &mut Vec<u32>) {
        found.clear();
        let (low, high) = self.cells([place; 2], reach);
        for cell in cells_between(low, high) {
            found.extend(self.listed(cell));
        }
        found.sort_unstable();
        found.dedup();
    }

    /// What stands in the way of a capsule, and of `ahead` (µm) more in its direction.
    pub(crate) fn way(&self, capsule: &Capsule, ahead: f64) -> Way {
        let beyond = beyond(capsule, ahead);
        let (low, high) = self.cells([capsule.from, beyond], reach(capsule.radius));
        let near = cells_between(low, high).flat_map(|cell| self.listed(cell));
        self.way_past(capsule, beyond, near)
    }

    /// [`Room::way`] past these capsules only.
    pub(crate) fn way_among(&self, capsule: &Capsule, ahead: f64, near: &[u32]) -> Way {
        self.way_past(capsule, beyond(capsule, ahead), near.iter().copied())
    }

    fn way_past(&self, capsule: &Capsule, beyond: DVec3, near: impl Iterator<Item = u32>) -> Way {
        if self.meets_soma(capsule) {
            return Way::Blocked;
        }
        let mut way = Way::Free;
        for number in near {
            match self.way_past_one(capsule, beyond, number) {
                Way::Blocked => return Way::Blocked,
                Way::Ends => way = Way::Ends,
                Way::Free => {}
            }
        }
        way
    }

    fn way_past_one(&self, capsule: &Capsule, beyond: DVec3, number: u32) -> Way {
        if capsule.parent == Some(number) {
            return Way::Free; // how sharply a branch turns is not a question of room
        }
        let other = &self.capsules[number as usize];
        let apart = clearance(capsule.radius, other.radius);
        let is_within =
            |segment, least: f64| distance_squared(segment, other.segment) < least * least;
        if !is_within([capsule.from, beyond], apart) {
            return Way::Free;
        }
        let step = [capsule.from, capsule.to];
        let (length, ahead) = (step[0].distance(step[1]), capsule.to.distance(beyond));
        let limit = apart / DIVERGENCE + ahead;
        let Some(between) = self.path_between(capsule.parent, number, limit) else {
            return match is_within(step, apart) {
                true => Way::Blocked,
                false => Way::Ends,
            };
        };
        let at_start = apart.min(DIVERGENCE * between);
        let at_end = apart.min(DIVERGENCE * (between + length));
        match is_within(step, at_start) || is_within([capsule.to; 2], at_end) {
            true => Way::Blocked,
            false => Way::Free,
        }
    }

    /// Whether a capsule runs into the soma, or along it instead of away from it.
    fn meets_soma(&self, capsule: &Capsule) -> bool {
        let apart = clearance(capsule.radius, self.soma_radius);
        let from = capsule.from.length();
        let outwards = from + 0.5 * capsule.from.distance(capsule.to);
        let segment = [capsule.from, capsule.to];
        let nearest = distance_squared(segment, [DVec3::ZERO; 2]).sqrt();
        // Only what begins near the soma may be near it.
        let is_near = nearest < apart.min(from) || capsule.to.length() < apart.min(outwards);
        capsule.parent.is_some() && is_near
    }

    /// Path along the tree between the end of capsule `from` and the nearer end of capsule `to`; `None` if it is
    /// longer than `limit`, or leads through the soma.
    fn path_between(&self, from: Option<u32>, to: u32, limit: f64) -> Option<f64> {
        let of = |number: u32| &self.capsules[number as usize];
        let start = from?;
        let (mut a, mut b) = (start, to);
        // Parents have lower numbers than what comes of them.
        while a != b {
            let up = if a > b { &mut a } else { &mut b };
            *up = of(*up).parent;
            if *up == NONE {
                return None;
            }
            let walked = (of(start).path - of(a).path).max(of(to).path - of(b).path);
            if walked > limit + of(to).segment[0].distance(of(to).segment[1]) {
                return None;
            }
        }
        let fork = of(a).path;
        let down = if a == to {
            0.0
        } else {
            of(of(to).parent).path - fork
        };
        let between = of(start).path - fork + down;
        (between <= limit).then_some(between)
    }

    /// Lowest and highest cell that a box around a segment touches.
    fn cells(&self, [from, to]: [DVec3; 2], reach: f64) -> (IVec3, IVec3) {
        let cell = |place: DVec3| (place / self.side).floor().as_ivec3();
        (cell(from.min(to) - reach), cell(from.max(to) + reach))
    }

    fn bucket(&self, cell: IVec3) -> usize {
        let mixed = (cell.x as u32).wrapping_mul(0x9e37_79b1)
            ^ (cell.y as u32).wrapping_mul(0x85eb_ca77).rotate_left(11)
            ^ (cell.z as u32).wrapping_mul(0xc2b2_ae3d).rotate_left(22);
        (mixed ^ (mixed >> 15)) as usize & (self.heads.len() - 1)
    }

    /// Capsules in the bucket of a cell.
    fn listed(&self, cell: IVec3) -> impl Iterator<Item = u32> {
        let entry = |at: u32| (at != NONE).then(|| self.entries[at as usize]);
        let first = entry(self.heads[self.bucket(cell)]);
        std::iter::successors(first, move |e| entry(e.next)).map(|e| e.capsule)
    }
}

/// Least distance between the axes of branches of these radii.
fn clearance(a: f64, b: f64) -> f64 {
    SWAY * (a + b) + GAP
}

/// How far from a capsule's axis boxes of others can be that are too near: their own radius is in their boxes.
pub(crate) fn reach(radius: f64) -> f64 {
    SWAY * radius + GAP
}

/// Where `ahead` more leads.
fn beyond(capsule: &Capsule, ahead: f64) -> DVec3 {
    capsule.to + (capsule.to - capsule.from).normalize_or_zero() * ahead
}

fn cells_between(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    let along = move |y, z| (low.x..=high.x).map(move |x| IVec3::new(x, y, z));
    (low.z..=high.z).flat_map(move |z| (low.y..=high.y).flat_map(move |y| along(y, z)))
}

/// Square of the distance of two segments (C. Ericson, Real-Time Collision Detection, 2004, 5.1.9).
fn distance_squared([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> f64 {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let (uw, vw) = (u.dot(w), v.dot(w));
    // At `a + s u` and `c + t v`; a part of nothing where a segment is a point.
    let part = |over: f64, whole: f64| {
        if whole > 0.0 {
            (over / whole).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let s = part(uv * vw - vv * uw, uu * vv - uv * uv);
    let t = part(uv * s + vw, vv);
    let s = part(uv * t - uw, uu);
    (w + u * s - v * t).length_squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn capsule(from: [f64; 2], to: [f64; 2], parent: Option<u32>) -> Capsule {
        let place = |[x, y]: [f64; 2]| DVec3::new(x, y, 0.0);
        Capsule {
            from: place(from),
            to: place(to),
            radius: 0.5,
            parent,
        }
    }

    /// Around a soma of radius 5, with these capsules, each grown from the one before.
    fn room(places: &[[f64; 2]]) -> Room {
        let mut room = Room::new(5.0, 100, 2.0);
        for (i, step) in places.windows(2).enumerate() {
            let parent = i.checked_sub(1).map(|before| before as u32);
            room.add(&capsule(step[0], step[1], parent));
        }
        room
    }

    #[test]
    fn what_is_in_the_way_is_not_when_it_is_taken_back() {
        let mut room = room(&[[6.0, 0.0], [8.0, 0.0], [10.0, 0.0], [12.0, 0.0]]);
        let through = capsule([11.0, 3.0], [11.0, 1.0], None);
        assert_eq!(room.way(&through, 0.0), Way::Blocked);
        let before = capsule([11.0, 6.0], [11.0, 4.0], None);
        assert_eq!(room.way(&before, 0.0), Way::Free);
        assert_eq!(room.way(&before, 3.0), Way::Ends);
        room.keep(2);
        assert_eq!(room.way(&through, 0.0), Way::Free);
        room.add(&capsule([10.0, 0.0], [12.0, 0.0], Some(1)));
        assert_eq!(room.way(&through, 0.0), Way::Blocked);
    }

    #[test]
    fn siblings_diverge() {
        let room = room(&[[6.0, 0.0], [8.0, 0.0], [10.0, 0.0]]);
        let sibling = |to| room.way(&capsule([8.0, 0.0], to, Some(0)), 0.0);
        assert_eq!(sibling([9.0, 1.7]), Way::Free);
        assert_eq!(sibling([9.9, 0.5]), Way::Blocked);
    }

    #[test]
    fn only_stems_touch_the_soma() {
        let room = room(&[[6.0, 0.0], [8.0, 0.0]]);
        let stem = capsule([0.0, 5.0], [0.0, 6.0], None);
        assert_eq!(room.way(&stem, 0.0), Way::Free);
        let back = capsule([8.0, 0.0], [5.5, 3.0], Some(0));
        assert_eq!(room.way(&back, 0.0), Way::Blocked);
    }

    #[test]
    fn distances_of_segments_are_those_of_their_nearest_places() {
        let at = |x, y, z| DVec3::new(x, y, z);
        let along = [at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0)];
        for (other, expected) in [
            ([at(2.0, -1.0, 3.0), at(2.0, 1.0, 3.0)], 3.0),
            ([at(7.0, 4.0, 0.0), at(9.0, 8.0, 0.0)], 5.0),
            ([at(1.0, 2.0, 0.0), at(3.0, 2.0, 0.0)], 2.0),
            ([at(2.0, 0.0, 1.0); 2], 1.0),
        ] {
            assert_eq!(distance_squared(along, other), expected * expected);
            assert_eq!(distance_squared(other, along), expected * expected);
        }
    }
}
