//! Two rings instead of one where a path turns sharply.
//!
//! ```text
//!   ──────────►╮ a        One ring, across the bisector, narrows the tube by the cosine of half the turn,
//!              │          and beyond 120° folds it on the outer side. Two rings, beside the traced point
//!   ◄──────────╯ b        along the bisector's normal, take half of the turn each.
//! ```
//!
//! The rings are so far apart that they do not cross. Where the path turns back, the tip stays where it was traced.
//! Where it turns by less, rings beside the traced point are outside of both legs, and the tube would be too thick
//! there; on the legs they would cut the corner. So they move a part of the way inwards.

use glam::DVec3;

use super::path::{Path, Plan, PlannedRing, RingKind};
use super::shape::is_straight_back;

/// Turns sharper than this get two rings: cosine of 60°, where one ring would narrow the tube by 13 %.
const SHARP: f64 = 0.5;
/// At turns by more than this (radians; 105°) one ring narrows the tube by two fifths, and soon folds it. They are given
/// room even if there is none for two rings: in a zigzag, every other bend with two rings would be in the way of the
/// others.
const VERY_SHARP: f64 = 1.83;
/// The two rings are this many times as far apart as rings that touch.
const CLEAR: f64 = 1.1;
/// How far apart their inner corners are, which share the crease of the bend, as a share of the centers: just so far that
/// they are two. Not tuned.
const OF_ASIDE: f64 = 0.15;
/// The leg is at most this many asides away from the bend: beyond 120°, rings stay nearer to the tip.
const MAX_ASIDE: f64 = 1.73;
/// A neighbor is at least this many radii away, and this many times as far as rings that stand between are from their
/// traced points: where a path goes to and fro, the rings of two sharp bends would be in the way of each other.
const MIN_WAY: f64 = 1.0;
const MIN_WAY_PER_ASIDE: f64 = 1.4;

/// Makes two rings of one at sharp bends.
pub(crate) fn split_sharp_bends(plan: &mut Plan) {
    for path in &mut plan.paths {
        let bends = (1..path.last())
            .filter_map(|ring| Bend::new(path, ring))
            .collect();
        // The last of the path first, so that the others keep their numbers.
        for bend in with_room(path, bends).into_iter().rev() {
            let ring = path.rings[bend.ring];
            let [before, after] =
                [(-bend.aside, 0), (bend.aside, 1)].map(|(aside, k)| PlannedRing {
                    center: ring.center + bend.inward + aside,
                    normal: bend.normals[k],
                    kind: RingKind::Bend,
                    crease: ring.crease.and_then(|crease| {
                        let from = bend.inward + aside;
                        let crease = crease + (OF_ASIDE * aside - from) / ring.radius;
                        (crease.length() > 1.0).then_some(crease)
                    }),
                    ..ring
                });
            path.rings.splice(bend.ring..=bend.ring, [before, after]);
        }
    }
}

/// The bends whose rings have room beside their neighbors and those of sharper bends, in the order of the path.
fn with_room(path: &Path, mut bends: Vec<Bend>) -> Vec<Bend> {
    if bends.is_empty() {
        return bends;
    }
    bends.sort_by(|a, b| b.turn.total_cmp(&a.turn).then(a.ring.cmp(&b.ring)));
    // How much room bends take: those that get two rings, and the very sharp ones.
    let mut asides = vec![0.0; path.rings.len()];
    for bend in bends.iter().filter(|bend| bend.turn > VERY_SHARP) {
        asides[bend.ring] = bend.aside.length();
    }
    bends.retain(|bend| {
        let ring = &path.rings[bend.ring];
        let own = bend.aside.length();
        let is_near = |neighbor: usize| {
            let least = MIN_WAY * ring.radius + MIN_WAY_PER_ASIDE * (own + asides[neighbor]);
            ring.center.distance(path.rings[neighbor].center) < least
        };
        let has_room = !is_near(bend.ring - 1) && !is_near(bend.ring + 1);
        if has_room {
            asides[bend.ring] = own;
        }
        has_room
    });
    bends.sort_by_key(|bend| bend.ring);
    bends
}

struct Bend {
    ring: usize,
    /// By which angle the path turns (radians).
    turn: f64,
    /// From the traced point to halfway between both rings.
    inward: DVec3,
    /// From there to the second ring, and back to the first.
    aside: DVec3,
    normals: [DVec3; 2],
}

impl Bend {
    fn new(path: &Path, index: usize) -> Option<Self> {
        let ring = &path.rings[index];
        let [before, after] = [index - 1, index + 1].map(|n| path.rings[n].center);
        let incoming = (ring.center - before).try_normalize()?;
        let outgoing = (after - ring.center).try_normalize()?;
        if incoming.dot(outgoing) >= SHARP || ring.is_of_zone() {
            return None;
        }
        let tip = (incoming - outgoing).try_normalize()?;
        let along = incoming + outgoing;
        let along = match is_straight_back(along) {
            true => ring.normal,
            false => along,
        };
        let along = (along - tip * along.dot(tip)).try_normalize()?;
        let turn = incoming.angle_between(outgoing);
        // Rings r sin γ / cos(γ / 2) apart, γ = turn / 2 the angle between them, touch: clearance.rs.
        let aside = 0.5 * CLEAR * ring.radius * (0.5 * turn).sin() / (0.25 * turn).cos();
        // With β, half the turn, the angle between `along` and the leg, the ring is `aside` sin β off the leg, of which
        // cos β is inwards. Where the inner corners lie in a crease, the ring goes half-way to the leg itself: then the tube
        // has the volume of two that meet in a ball.
        let own = 0.5 * turn.sin();
        let inward = match ring.crease {
            Some(_) => 0.5 * (own + (0.5 * turn).tan().min(MAX_ASIDE)) * aside,
            None => own * aside,
        };
        let halfway = |a: DVec3, b: DVec3| (a + b).try_normalize().unwrap_or(along);
        Some(Self {
            ring: index,
            turn,
            inward: tip * -inward,
            aside: along * aside,
            normals: [halfway(incoming, along), halfway(along, outgoing)],
        })
    }
}
