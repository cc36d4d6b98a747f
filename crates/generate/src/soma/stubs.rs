//! What was traced of neurites between a soma's surface and their first rings.
//!
//! A neurite draws the surface out up to its first ring. What was traced of it that far is not the soma's own volume: the
//! finished soma has both. So the neurite's frusta are cut into small parts; those outside of the soma are kept with
//! their volumes, and those on this side of a ring's plane count, wherever rings end up.

use glam::DVec3;

use super::insertion_quads::Insertion;
use super::site::{HIGHEST, MAX_WAY, THIN};
use crate::tracing::{NONE, Root, Skeleton, SomaSphere};
use crate::{GenerateOptions, SomaMethod};

/// Thickness of slices, in radii of the soma.
const SLICE: f64 = 0.08;
/// Slices of a link, at most. A guard.
const MAX_SLICES: f64 = 24.0;
/// Parts of a slice of a thick neurite: rings of equal area, and parts of each.
const RINGS: usize = 3;
const AROUND: usize = 8;

/// A part of a neurite outside of its soma: where, about the soma's center, and its volume (µm³).
pub(crate) type Stub = (DVec3, f64);

/// Tells somata what was traced of their neurites next to them.
pub(crate) fn measure(
    skeleton: &Skeleton,
    soma_spheres: &mut [Option<SomaSphere>],
    options: &GenerateOptions,
) {
    if options.soma != SomaMethod::Fem {
        return;
    }
    let children = skeleton.children();
    let mut stubs: Vec<Vec<Stub>> = vec![Vec::new(); soma_spheres.len()];
    for (root, node) in (0..).zip(skeleton.nodes()) {
        let (Root::Soma(soma), NONE) = (node.root, node.parent) else {
            continue;
        };
        let Some(sphere) = &soma_spheres[soma as usize] else {
            continue;
        };
        // Rings that were asked for may be farther out than any other.
        let highest = match options.rings.is_empty() {
            true => HIGHEST * sphere.radius,
            false => MAX_WAY * sphere.radius,
        };
        let mut open: Vec<u32> = vec![root];
        while let Some(here) = open.pop() {
            for &next in children.of(here) {
                let link = [here, next].map(|node| {
                    let node = skeleton.node(node);
                    (
                        node.center - sphere.center,
                        node.radius * options.radius_factor,
                    )
                });
                add(sphere, link, highest, &mut stubs[soma as usize]);
                let end = link[1].0;
                if end.length() - sphere.surface(end.try_normalize().unwrap_or(DVec3::Y)) < highest
                {
                    open.push(next);
                }
            }
        }
    }
    for (sphere, stubs) in soma_spheres.iter_mut().zip(stubs) {
        if let Some(sphere) = sphere {
            sphere.set_stubs(stubs);
        }
    }
}

/// Adds the parts of a link that are outside of the soma.
fn add(sphere: &SomaSphere, link: [(DVec3, f64); 2], highest: f64, stubs: &mut Vec<Stub>) {
    let [(from, first), (to, last)] = link;
    let way = to - from;
    let Some(axis) = way.try_normalize() else {
        return;
    };
    let count = (way.length() / (SLICE * sphere.radius))
        .ceil()
        .clamp(1.0, MAX_SLICES);
    let (x, y) = axis.any_orthonormal_pair();
    let height =
        |place: DVec3| place.length() - sphere.surface(place.try_normalize().unwrap_or(DVec3::Y));
    for slice in 0..count as usize {
        let share = (slice as f64 + 0.5) / count;
        let (center, radius) = (from + way * share, first + share * (last - first));
        let volume = std::f64::consts::PI * radius * radius * way.length() / count;
        let over = height(center);
        // A soma is hardly drawn out towards a neurite that is thicker than it.
        if radius > sphere.radius || over < -2.0 * radius || over > highest + radius {
            continue;
        }
        if over > radius || radius < THIN * sphere.radius {
            if over > 0.0 {
                stubs.push((center, volume));
            }
            continue;
        }
        for part in 0..RINGS * AROUND {
            let (ring, turn) = (part / AROUND, part % AROUND);
            let off = radius * ((ring as f64 + 0.5) / RINGS as f64).sqrt();
            let (sin, cos) = (std::f64::consts::TAU * turn as f64 / AROUND as f64).sin_cos();
            let place = center + (x * cos + y * sin) * off;
            if height(place) > 0.0 {
                stubs.push((place, volume / (RINGS * AROUND) as f64));
            }
        }
    }
}

/// Volume (µm³) of the parts up to the planes of first rings, of each part that of the nearest ring.
pub(super) fn up_to_rings(stubs: &[Stub], insertions: &[Insertion]) -> f64 {
    let counted = stubs.iter().filter(|(place, _)| {
        let off = |insertion: &&Insertion| insertion.center().distance_squared(*place);
        let nearest = insertions.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.is_some_and(|ring| (*place - ring.center()).dot(ring.axis) < 0.0)
    });
    counted.map(|(_, volume)| volume).sum()
}
