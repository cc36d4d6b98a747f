//! How far along its branch a push is spread, and which points it concerns.

use glam::DVec3;

use super::geometry::direction;
use super::rods::Rods;
use super::search::Found;
use crate::tracing::NONE;

/// A push is spread over this many radii to each side, or over this many times the way that the branch
/// has to give. From 5 times that way on, lengths stay as they are to a thousandth; 6 has a margin.
const SPREAD: f64 = 6.0;
/// By how much the spread length decays for each µm along the tree.
const DECAY: f64 = 0.25;
/// Free space that stays between two surfaces, in radii of the thinner one: facets of the mesh and its
/// bends reach a little beyond the round cones.
pub(super) const GAP: f64 = 0.25;
/// Two branches of a fork with a cosine above this one may lie within each other far beyond it.
const NARROW: f64 = 0.8;
/// A narrow fork matters if its branches are longer than this many of their radii.
const LONG: f64 = 2.5;

/// By point.
#[derive(Debug)]
pub(super) struct Spread {
    /// Spread length (µm).
    pub(super) length: Vec<f64>,
    /// Way to the next contact along the tree, in spread lengths; infinite where there is none.
    pub(super) distance: Vec<f64>,
}

impl Spread {
    /// For contacts found with a margin of at least [`GAP`]: those `now`, and those at the `traced` places,
    /// which tell how far a branch gives way in all.
    pub(super) fn new(rods: &Rods, now: &Found, traced: &Found) -> Self {
        let count = rods.count() as u32;
        let mut spread = Self {
            length: (0..count).map(|i| SPREAD * rods.radius(i)).collect(),
            distance: vec![f64::INFINITY; count as usize],
        };
        spread.add_contacts(rods, traced);
        spread.distance.fill(f64::INFINITY);
        spread.add_contacts(rods, now);
        spread.add_narrow_forks(rods);
        spread.decay_along(rods);
        spread
    }

    fn add_contacts(&mut self, rods: &Rods, found: &Found) {
        for contact in &found.contacts {
            let (ra, rb) = (rods.radius(contact.a), rods.radius(contact.b));
            let need = contact.depth + GAP * ra.min(rb);
            if need <= 0.0 {
                continue;
            }
            // The thinner one gives way.
            let share = rb * rb / (ra * ra + rb * rb);
            self.add(rods, contact.a, need * share);
            self.add(rods, contact.b, need * (1.0 - share));
        }
        for contact in &found.somata {
            self.add(rods, contact.segment, contact.depth);
        }
    }

    /// A segment that has to give way by so much (µm).
    fn add(&mut self, rods: &Rods, segment: u32, way: f64) {
        for end in [segment, rods.parent(segment)] {
            let length = &mut self.length[end as usize];
            *length = length.max(SPREAD * way);
            self.distance[end as usize] = 0.0;
        }
    }

    /// Pairs of branches that leave a fork side by side: what they share shows only once they are cut.
    /// Neighbors in the order of children, which is enough: a fork has few.
    fn add_narrow_forks(&mut self, rods: &Rods) {
        let mut before = vec![NONE; rods.count()];
        for i in rods.segments() {
            let slot = &mut before[rods.parent(i) as usize];
            let sibling = std::mem::replace(slot, i);
            if sibling != NONE && narrow(rods, sibling, i) {
                self.distance[sibling as usize] = 0.0;
                self.distance[i as usize] = 0.0;
            }
        }
    }

    /// Lets both decay up and down the tree.
    fn decay_along(&mut self, rods: &Rods) {
        let segments: Vec<u32> = rods.segments().collect();
        let up = segments.iter().rev().map(|&i| (i, rods.parent(i)));
        let down = segments.iter().map(|&i| (rods.parent(i), i));
        for (from, to) in up.chain(down) {
            let way = rods.length[from.max(to) as usize];
            let (from, to) = (from as usize, to as usize);
            self.length[to] = self.length[to].max(self.length[from] - DECAY * way);
            let unit = self.length[from].max(self.length[to]);
            self.distance[to] = self.distance[to].min(self.distance[from] + way / unit);
        }
    }
}

/// Whether two long branches leave their fork side by side.
fn narrow(rods: &Rods, a: u32, b: u32) -> bool {
    let long = LONG * (rods.radius(a) + rods.radius(b));
    let center = |i: u32| -> DVec3 { rods.points[i as usize].node.center };
    let way = |i: u32| center(i) - center(rods.parent(i));
    let cosine = direction(way(a)).dot(direction(way(b)));
    rods.length[a as usize].min(rods.length[b as usize]) > long && cosine > NARROW
}
