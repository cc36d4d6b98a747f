//! Volume and area that a soma's coarse surface has once it is refined.
//!
//! Refined, a patch is curved: its edges are cubics that leave their ends at right angles to the normals there. The middle of
//! such an edge lies off its chord by δ = ((e·n₁) n₁ − (e·n₂) n₂) / −8, e the chord and n the normals; in between, a
//! patch follows its edges, so that its mean displacement is a third of the sum of its four edges' δ. Times the patch's
//! vector area this is the volume that refinement adds. Own derivation; a test holds it beside the refined surface
//! (`traced_somata::what_is_told_of_a_soma_is_what_its_refined_surface_holds`), and `cargo xtask quality` measures the
//! refined surface of real cells.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::DVec3;
use neurotess_refine::SOMA_FILLET;

use super::insertion_quads::Insertion;
use crate::soma::site::collar;

/// A coarse surface about the origin.
pub(super) struct Coarse<'a> {
    pub(super) vertices: &'a [DVec3],
    pub(super) quads: &'a [[u32; 4]],
    pub(super) rings: &'a [[u32; 4]],
    pub(super) insets: &'a [Option<[u32; 4]>],
    pub(super) insertions: &'a [Insertion],
}

/// Volume (µm³) and area (µm²) of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Extent {
    /// Closed by the planes of the first rings.
    pub(super) volume: f64,
    /// Without what neurites take.
    pub(super) area: f64,
    /// Of the disks that neurites take.
    pub(super) open: f64,
}

/// Share of an arc's radius by which the middle of a quarter lies off its chord.
const QUARTER: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

impl Coarse<'_> {
    /// What it encloses and measures, refined.
    pub(super) fn extent(&self) -> Extent {
        let lofts = self.lofts();
        let patches = || self.quads.iter().chain(&lofts);
        let mut normals = vec![DVec3::ZERO; self.vertices.len()];
        for quad in patches() {
            let [a, b, c, d] = self.corners(quad);
            let normal = (c - a).cross(d - b);
            quad.iter().for_each(|&v| normals[v as usize] += normal);
        }
        normals
            .iter_mut()
            .for_each(|normal| *normal = normal.normalize_or_zero());
        let mut on_ring: HashMap<u32, usize> = HashMap::new();
        for (index, (ring, insertion)) in self.rings.iter().zip(self.insertions).enumerate() {
            let center = insertion.center();
            for &v in ring {
                normals[v as usize] = (self.vertices[v as usize] - center).normalize_or_zero();
                on_ring.insert(v, index);
            }
        }
        let mut extent = self.within_lofts(&normals);
        for quad in self.quads {
            let corners = self.corners(quad);
            let [a, b, c, d] = corners;
            let (left, right) = ((b - a).cross(c - a), (c - a).cross(d - a));
            let vector = 0.5 * (c - a).cross(d - b);
            let displacement: DVec3 = (0..4)
                .map(|i| {
                    let [v, w] = [quad[i], quad[(i + 1) % 4]];
                    let ends = [corners[i], corners[(i + 1) % 4]];
                    let [n, m] = [v, w].map(|v| normals[v as usize]);
                    match (on_ring.get(&v), on_ring.get(&w)) {
                        (Some(&ring), Some(&same)) if ring == same => {
                            let radius = self.insertions[ring].radius;
                            (n + m).normalize_or_zero() * (QUARTER * radius)
                        }
                        _ => {
                            let chord = ends[1] - ends[0];
                            (m * chord.dot(m) - n * chord.dot(n)) / 8.0
                        }
                    }
                })
                .sum();
            let flat = 0.5 * (left.length() + right.length());
            let volume = (a.dot(left) + a.dot(right)) / 6.0;
            let added = displacement.dot(vector) / 3.0;
            extent.volume += volume + added;
            // Of a sphere, a patch's area grows by half the share that its volume does.
            extent.area += flat * (1.0 + 0.5 * added / volume.max(f64::MIN_POSITIVE)).max(1.0);
        }
        for insertion in self.insertions {
            let square = insertion.radius * insertion.radius;
            // What lies between a ring's chords and arcs was added with the patches; lofts have as many corners as
            // points of theirs.
            let disk = match insertion.inset {
                true => 2.0 * ACROSS as f64 * (std::f64::consts::FRAC_PI_2 / ACROSS as f64).sin(),
                false => 2.0,
            };
            extent.volume += disk * square * insertion.center().dot(insertion.axis) / 3.0;
            extent.open += PI * square;
        }
        extent
    }

    /// What lofts enclose and measure: a few points of each, as refinement makes them.
    fn within_lofts(&self, normals: &[DVec3]) -> Extent {
        let mut extent = Extent::default();
        let pairs = self.rings.iter().zip(self.insets).zip(self.insertions);
        for ((ring, quad), insertion) in pairs {
            let Some(quad) = quad else { continue };
            for side in 0..4 {
                let ends = [side, (side + 1) % 4];
                let under = ends.map(|i| quad[i] as usize);
                let over = ends.map(|i| self.vertices[ring[i] as usize]);
                let grid = loft(
                    under.map(|v| self.vertices[v]),
                    under.map(|v| normals[v]),
                    over,
                    insertion,
                );
                for x in 0..ACROSS {
                    for y in 0..ALONG {
                        let [a, b] = [grid[x][y], grid[x + 1][y]];
                        let [d, c] = [grid[x][y + 1], grid[x + 1][y + 1]];
                        let (left, right) = ((b - a).cross(c - a), (c - a).cross(d - a));
                        extent.volume += (a.dot(left) + a.dot(right)) / 6.0;
                        extent.area += 0.5 * (left.length() + right.length());
                    }
                }
            }
        }
        extent
    }

    /// The patches between insets' quads and rings.
    fn lofts(&self) -> Vec<[u32; 4]> {
        let pairs = self.rings.iter().zip(self.insets);
        let pairs = pairs.filter_map(|(ring, quad)| Some((ring, quad.as_ref()?)));
        let lofts = pairs.flat_map(|(ring, quad)| {
            [0, 1, 2, 3].map(|i| {
                let j = (i + 1) % 4;
                [quad[i], quad[j], ring[j], ring[i]]
            })
        });
        lofts.collect()
    }

    fn corners(&self, quad: &[u32; 4]) -> [DVec3; 4] {
        quad.map(|v| self.vertices[v as usize])
    }
}

/// Points of a loft, across and along the branch.
const ACROSS: usize = 2;
const ALONG: usize = 4;

/// Points of a loft, as `loft` of refine's `evaluate.rs` makes them on a soma.
fn loft(
    under: [DVec3; 2],
    normals: [DVec3; 2],
    over: [DVec3; 2],
    insertion: &Insertion,
) -> [[DVec3; ALONG + 1]; ACROSS + 1] {
    let center = insertion.center();
    let chord = under[1] - under[0];
    let bulge = (normals[1] * chord.dot(normals[1]) - normals[0] * chord.dot(normals[0])) / 8.0;
    let lifted = 0.5 * (over[0] + over[1] - under[0] - under[1]);
    let collar = collar(lifted.dot(insertion.axis), insertion.radius);
    std::array::from_fn(|i| {
        let x = i as f64 / ACROSS as f64;
        let near = under[0].lerp(under[1], x) + bulge * (4.0 * x * (1.0 - x));
        let out = (over[0].lerp(over[1], x) - center).normalize_or_zero();
        let far = center + out * insertion.radius;
        let normal = normals[0].lerp(normals[1], x).normalize_or_zero();
        let way = far - near;
        let along = way - normal * way.dot(normal);
        let left =
            f64::from(SOMA_FILLET) * insertion.radius / along.length().max(f64::MIN_POSITIVE);
        let share = if left < 2.0 / 3.0 {
            1.0 - left
        } else {
            1.0 / 3.0
        };
        let arrive = insertion.axis * collar.min(way.length() / 3.0);
        let controls = [near, near + along * share, far - arrive, far];
        std::array::from_fn(|j| {
            let y = j as f64 / ALONG as f64;
            let z = 1.0 - y;
            controls[0] * (z * z * z)
                + controls[1] * (3.0 * z * z * y)
                + controls[2] * (3.0 * z * y * y)
                + controls[3] * (y * y * y)
        })
    })
}
