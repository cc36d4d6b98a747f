//! Which quad of a zone faces each of its branches, how the zone's rings turn towards them, and how wide
//! the quads become.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use glam::{DQuat, DVec3};

use super::path_rings::PathRings;
use super::twist::{FACING, Target};
use crate::plan::{Inset, RoundCone, not_too_steep, outwards};

/// A quad is at least this much wider than its branch, to either side (8°).
const CLEARANCE: f64 = 0.14;
/// Widest half of a quad, around the trunk (72°).
const WIDEST: f64 = 1.257;
/// A quad turns, and a corner moves, at most this far: half-way to the next.
const MAX_TURN: f64 = FRAC_PI_4;

/// A branch at the quad that it leaves through.
#[derive(Clone, Debug)]
pub(super) struct Facing {
    pub(super) inset: u32,
    /// First ring of the zone, and the side of it.
    pub(super) ring: usize,
    pub(super) side: usize,
    pub(super) exit: DVec3,
    pub(super) direction: DVec3,
    pub(super) radius: f64,
    /// Half the width of the quad.
    half: f64,
    /// Angle of the branch about either ring.
    angles: [f64; 2],
}

/// Angles of the corners of a ring that no branch leaves from.
pub(super) const QUARTERS: [f64; 4] = [0.0, FRAC_PI_2, 2.0 * FRAC_PI_2, 3.0 * FRAC_PI_2];

/// Angle difference within half a turn.
fn wrap(angle: f64) -> f64 {
    (angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0
}

/// Where a branch's exit is beside the chord of its zone: the point on the chord, and the way from it.
fn beside(path: &PathRings<'_>, ring: usize, exit: DVec3) -> (DVec3, DVec3) {
    let (a, b) = (path.centers[ring], path.centers[ring + 1]);
    let along = path.chord(ring);
    let share = ((exit - a).dot(along) / a.distance(b).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let base = a.lerp(b, share);
    let way = exit - base;
    (base, way - along * way.dot(along))
}

/// How rings should turn: those of zones so that a quad of each faces its branches, those at bends so that a corner lies
/// in the crease. `zones`: first ring, and the branches.
pub(super) fn targets(
    path: &PathRings<'_>,
    zones: &[(usize, Vec<(u32, Inset)>)],
    out: &mut [Target],
) {
    let mut before = out[0].angle;
    let mut zones = zones.iter().peekable();
    for ring in 0..=path.last() {
        let Some((ring, insets)) = zones.next_if(|(first, _)| *first == ring) else {
            if let Some(crease) = path.crease(ring)
                && out[ring].weight == 0.0
            {
                let angle = crease.angle;
                before = angle + ((before - angle) / FRAC_PI_2).round() * FRAC_PI_2;
                out[ring] = Target {
                    angle: before,
                    weight: FACING,
                };
            }
            continue;
        };
        // Mean direction modulo a quarter turn: wide branches weigh more.
        let (mut cos, mut sin) = (0.0, 0.0);
        for (_, inset) in insets {
            let (_, way) = beside(path, *ring, inset.exit);
            let angle = path.angle(*ring, way) - FRAC_PI_4;
            let weight = inset.radius / path.radii[*ring].max(f64::MIN_POSITIVE);
            cos += weight * (4.0 * angle).cos();
            sin += weight * (4.0 * angle).sin();
        }
        let mean = sin.atan2(cos) / 4.0;
        let angle = mean + ((before - mean) / FRAC_PI_2).round() * FRAC_PI_2;
        for slot in &mut out[*ring..=ring + 1] {
            // A ring between two zones turns to the middle of both.
            let other = (slot.weight > 0.0).then_some(slot.angle);
            slot.angle = other.map_or(angle, |other| 0.5 * (other + angle));
            slot.weight = FACING;
        }
        before = angle;
    }
}

/// Gives each branch of a zone the free quad that faces it most, the thickest first.
pub(super) fn assign(path: &PathRings<'_>, ring: usize, insets: &[(u32, Inset)]) -> Vec<Facing> {
    let mut order: Vec<&(u32, Inset)> = insets.iter().collect();
    order.sort_by(|a, b| b.1.radius.total_cmp(&a.1.radius).then(a.0.cmp(&b.0)));
    let mut taken = [false; 4];
    let mut facing = Vec::with_capacity(insets.len());
    for &&(number, inset) in &order {
        let (_, way) = beside(path, ring, inset.exit);
        let first = path.angle(ring, way);
        let angles = [first, first + wrap(path.angle(ring + 1, way) - first)];
        let off = 0.5 * (angles[0] + angles[1]) - FRAC_PI_4;
        let apart = |side: usize| wrap(off - side as f64 * FRAC_PI_2).abs();
        let free = (0..4).filter(|&side| !taken[side]);
        let Some(side) = free.min_by(|&a, &b| apart(a).total_cmp(&apart(b))) else {
            continue; // arrange.rs puts three branches into a zone at most
        };
        taken[side] = true;
        let trunk = 0.5 * (path.radii[ring] + path.radii[ring + 1]);
        let half = (inset.radius / trunk).min(1.0).asin() + CLEARANCE;
        facing.push(Facing {
            inset: number,
            ring,
            side,
            exit: inset.exit,
            direction: inset.direction,
            radius: inset.radius,
            half: half.clamp(FRAC_PI_4, WIDEST),
            angles,
        });
    }
    facing
}

/// Angles of the corners of a ring whose quads are as wide as the branches at it need.
pub(super) fn corner_angles(ring: usize, facing: &[&Facing]) -> [f64; 4] {
    let at = |facing: &Facing| facing.angles[ring - facing.ring];
    match facing {
        [] => QUARTERS,
        [one] => {
            let middle = FRAC_PI_4 + one.side as f64 * FRAC_PI_2;
            let turn = wrap(at(one) - middle).clamp(-MAX_TURN, MAX_TURN);
            // The quad's own two corners about the branch, the other two evenly in the rest.
            let rest = TAU - 2.0 * one.half;
            let around = [
                -one.half,
                one.half,
                one.half + rest / 3.0,
                one.half + 2.0 * rest / 3.0,
            ];
            let mut angles = [0.0; 4];
            for (k, angle) in around.into_iter().enumerate() {
                angles[(one.side + k) % 4] = middle + turn + angle;
            }
            [0, 1, 2, 3].map(|k| QUARTERS[k] + wrap(angles[k] - QUARTERS[k]))
        }
        several => {
            let mut pulls = [(0.0, 0.0); 4];
            for one in several {
                for (k, half) in [(one.side, -one.half), ((one.side + 1) % 4, one.half)] {
                    pulls[k].0 += wrap(at(one) + half - QUARTERS[k]);
                    pulls[k].1 += 1.0;
                }
            }
            [0, 1, 2, 3].map(|k| {
                let (sum, count) = pulls[k];
                let pull = if count > 0.0 { sum / count } else { 0.0 };
                QUARTERS[k] + f64::clamp(pull, -MAX_TURN, MAX_TURN)
            })
        }
    }
}

/// Turns a branch around its trunk until it lies within its quad, and up from the trunk where it would
/// leave too steeply.
pub(super) fn settle(
    facing: &mut Facing,
    path: &PathRings<'_>,
    corners: [[f64; 4]; 2],
    trunk: &[RoundCone],
) {
    let along = path.chord(facing.ring);
    let (base, way) = beside(path, facing.ring, facing.exit);
    let thick = 0.5 * (path.radii[facing.ring] + path.radii[facing.ring + 1]);
    let own = (facing.radius / thick).min(1.0).asin();
    let (mut off, mut width) = (0.0, 0.0);
    for (ring, corners) in corners.iter().enumerate() {
        let [from, to] = [corners[facing.side], corners[(facing.side + 1) % 4]];
        let to = if facing.side == 3 { to + TAU } else { to };
        let angle = path.angle(facing.ring + ring, way);
        off += 0.5 * wrap(angle - 0.5 * (from + to));
        width += 0.25 * (to - from);
    }
    let free = (width - own).max(0.0);
    if off.abs() > free {
        let turn = DQuat::from_axis_angle(along, free.copysign(off) - off);
        facing.exit = base + turn * (facing.exit - base);
        facing.direction = turn * facing.direction;
    }
    let normal = outwards(trunk, facing.exit, facing.radius);
    facing.direction = not_too_steep(facing.direction, normal);
}
