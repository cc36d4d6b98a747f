//! Where the inner corner of a ring is at a bend.
//!
//! ```text
//!   ───────────────╮  r      The tubes of both legs meet on the bisector, on the inner side at
//!   ─── · ─── · ─●  ╲        r / cos(turn / 2) from the traced point. A circle reaches r: between it
//!   ──────────╲   ╲  ╲       and the rings before and after, the wall would cut through the tube.
//!         crease   ·  ╲      On the outer side the round cones reach r, as the circle does.
//! ```
//!
//! So a ring is a half circle outside and half an ellipse inside. Where legs are short, the crease is nearer: no ring
//! reaches past the next.

use glam::DVec3;

use super::path::{Path, Plan};
use super::shape::TURNED_BACK;

/// Radii of a crease that is told from a circle: that of a turn by 44°. Below, a ring is a fourteenth too thin inside at
/// most, and costs no memory of its own.
const MIN_REACH: f64 = 1.08;
/// Share of a leg that the creases at its ends may take. With 0.9 there are 4 % more crossings beside forks, with 0.5
/// walls are no better than with 0.6.
const OF_LEG: f64 = 0.7;
/// Radii of a leg that a ring without a crease keeps to itself. With 1 there are 5 % more crossings beside forks at level 4,
/// and narrow bends are two fifths thinner inside.
const KEPT: f64 = 0.5;

/// Notes the inner corners of the rings at bends.
pub(crate) fn set_creases(plan: &mut Plan) {
    for path in &mut plan.paths {
        let bends: Vec<Option<Bend>> = (0..=path.last())
            .map(|ring| Bend::new(path, ring))
            .collect();
        if bends.iter().all(Option::is_none) {
            continue;
        }
        // What each ring takes of the legs beside it.
        let wanted: Vec<f64> = (bends.iter().zip(&path.rings))
            .map(|(bend, ring)| match bend {
                Some(bend) => bend.wanted,
                None => KEPT * ring.radius,
            })
            .collect();
        let leg = |ring: usize| {
            path.rings[ring]
                .center
                .distance(path.rings[ring + 1].center)
        };
        let share = |ring: usize| {
            let wanted = wanted[ring] + wanted[ring + 1];
            (OF_LEG * leg(ring) / wanted.max(f64::MIN_POSITIVE)).min(1.0)
        };
        let creases: Vec<Option<DVec3>> = (0..=path.last())
            .map(|ring| {
                let bend = bends[ring].as_ref()?;
                let reach = bend.reach * share(ring - 1).min(share(ring));
                (reach > MIN_REACH).then_some(bend.inwards * reach)
            })
            .collect();
        for (ring, crease) in path.rings.iter_mut().zip(creases) {
            ring.crease = crease;
        }
    }
}

/// A ring between two legs.
struct Bend {
    /// Unit direction to the inner side.
    inwards: DVec3,
    /// How far (radii) the crease is from the traced point.
    reach: f64,
    /// How far (µm) along either leg it is.
    wanted: f64,
}

impl Bend {
    fn new(path: &Path, index: usize) -> Option<Self> {
        let ring = &path.rings[index];
        if index == 0 || index == path.last() || ring.is_of_zone() {
            return None;
        }
        let [before, after] = [index - 1, index + 1].map(|n| path.rings[n].center);
        let incoming = (ring.center - before).try_normalize()?;
        let outgoing = (after - ring.center).try_normalize()?;
        let cos = incoming.dot(outgoing);
        // cos² of half the turn.
        let half = 0.5 * (1.0 + cos);
        let reach = half.sqrt().recip();
        if cos < TURNED_BACK || reach <= MIN_REACH {
            return None;
        }
        Some(Self {
            inwards: (outgoing - incoming).try_normalize()?,
            reach,
            wanted: reach * ring.radius * (1.0 - half).sqrt(),
        })
    }
}
