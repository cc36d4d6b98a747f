//! Decides what goes into which part of a packed mesh.
//!
//! A mesh that would not fit is cut into **parts**. Vertices that two parts or two runs share are
//! explicit, and explicit vertices keep the mesh's order. So the two patches beside an edge have
//! the same bits for it and evaluate it in the same direction: there are no cracks.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind};

use crate::bounding_sphere::{patch_sphere, sphere_around};
use crate::decode::{ImplicitRing, POINTS_OF_SPHERE, accurate};
use crate::part::{MOST_COLOR_KEYS, PATCHES_OF_SPHERE};
use crate::runs::{Tube, find_runs, implicit_ring};

/// Most explicit vertices of a part: their indices have 15 bits.
const MOST_EXPLICIT: usize = 1 << 15;
/// Patches of somata are stored with indices of 12 bits: they reach this many explicit vertices.
const FEW_EXPLICIT: usize = 1 << 12;

/// If all color keys below 2³¹ are also below this, they are taken for indices: see
/// [`crate::pack()`].
const MOST_NUMBERS: u32 = 1 << 20;

/// Runs and other patches that go into one part, by index.
#[derive(Default)]
pub(crate) struct Pile {
    runs: Vec<usize>,
    others: Vec<usize>,
}

pub(crate) struct Packer<'m> {
    pub(crate) mesh: &'m CoarseMesh,
    color_keys: &'m [u32],
    values: &'m [u8],
    pub(crate) runs: Vec<Tube>,
    pub(crate) others: Vec<usize>,
    /// By vertex: whether it is explicit.
    pub(crate) explicit: Vec<bool>,
}

impl<'m> Packer<'m> {
    /// Finds the runs of a mesh; no vertex is explicit yet.
    pub(crate) fn new(mesh: &'m CoarseMesh, color_keys: &'m [u32], values: &'m [u8]) -> Self {
        let (mut runs, others) = find_runs(mesh);
        // Runs that are near one another share a sphere, which is then small, so that centers are
        // accurate.
        let middle = |run: &Tube| {
            let ring = run.rings[run.rings.len() / 2];
            mesh.tracing[mesh.vertices[ring[0] as usize].tracing as usize].center
        };
        let (low, high) = runs
            .iter()
            .map(middle)
            .fold((Vec3::MAX, Vec3::MIN), |(low, high), p| {
                (low.min(p), high.max(p))
            });
        runs.sort_by_key(|run| morton((middle(run) - low) / (high - low).max_element().max(1e-6)));
        Self {
            mesh,
            color_keys,
            values,
            runs,
            others,
            explicit: vec![false; mesh.vertices.len()],
        }
    }

    pub(crate) fn center(&self, vertex: u32) -> Vec3 {
        self.mesh.tracing[self.mesh.vertices[vertex as usize].tracing as usize].center
    }

    pub(crate) fn radius(&self, vertex: u32) -> f32 {
        self.mesh.tracing[self.mesh.vertices[vertex as usize].tracing as usize].radius
    }

    /// Runs and other patches by part, in the mesh's order.
    pub(crate) fn piles(&self, most_patches: usize) -> Vec<Pile> {
        let mut piles = vec![Pile::default()];
        let (mut patches, mut explicit) = (PATCHES_OF_SPHERE, 0);
        let exact = self.has_numbers();
        let mut numbers = BTreeSet::new();
        let mut room =
            |piles: &mut Vec<Pile>, more: usize, more_explicit: usize, color_keys: &[u32]| {
                patches += more;
                explicit += more_explicit;
                numbers.extend(color_keys);
                if patches > most_patches
                    || explicit > MOST_EXPLICIT
                    || exact && numbers.len() > MOST_COLOR_KEYS
                {
                    piles.push(Pile::default());
                    (patches, explicit) = (PATCHES_OF_SPHERE + more, more_explicit);
                    numbers = color_keys.iter().copied().collect();
                }
                piles.len() - 1
            };
        for (i, run) in self.runs.iter().enumerate() {
            let used = run
                .rings
                .iter()
                .filter(|ring| self.explicit[ring[0] as usize]);
            let most = run.rings.len() + POINTS_OF_SPHERE;
            let tracing = |ring: &[u32; 4]| self.mesh.vertices[ring[0] as usize].tracing;
            let color_keys: Vec<u32> = run
                .rings
                .iter()
                .map(|r| self.color_key(tracing(r)))
                .collect();
            let pile = room(&mut piles, 4 * most, 4 * used.count(), &color_keys);
            piles[pile].runs.push(i);
        }
        for &other in &self.others {
            let corners = self.mesh.patches[other].corners;
            if self.explicit[corners[0] as usize] {
                let pile = room(&mut piles, 1, 4, &[]);
                piles[pile].others.push(other);
            }
        }
        // The cap of an implicit ring goes into the part of its ring.
        let mut owner = BTreeMap::new();
        for (p, pile) in piles.iter().enumerate() {
            for &run in &pile.runs {
                let rings = &self.runs[run].rings;
                for ring in [rings[0], rings[rings.len() - 1]] {
                    owner.insert(ring[0], p);
                }
            }
        }
        for &other in &self.others {
            let corners = self.mesh.patches[other].corners;
            if !self.explicit[corners[0] as usize] {
                let first = corners.into_iter().min().unwrap_or(0);
                if let Some(&pile) = owner.get(&first) {
                    piles[pile].others.push(other);
                }
            }
        }
        piles.retain(|pile| !pile.runs.is_empty() || !pile.others.is_empty());
        piles
    }

    /// The rings of a pile, one after the other, with the patches from each to the next.
    pub(crate) fn rings(&self, pile: &Pile) -> Vec<Slot> {
        let mut slots = Vec::new();
        for run in pile.runs.iter().map(|&run| &self.runs[run]) {
            if self.strays(&slots, run) {
                slots.resize(
                    slots.len().next_multiple_of(POINTS_OF_SPHERE),
                    Slot::default(),
                );
            }
            for (i, &ring) in run.rings.iter().enumerate() {
                let goes_on = i + 1 < run.rings.len();
                slots.push(Slot {
                    ring: Some(ring),
                    patch: goes_on.then_some(run.first_patch + 4 * i),
                });
            }
        }
        slots.resize(
            slots.len().next_multiple_of(POINTS_OF_SPHERE),
            Slot::default(),
        );
        slots
    }

    /// Whether a run should begin with a sphere of its own: an empty slot takes a fifth of the
    /// memory of a ring that is explicit because its sphere is too large.
    fn strays(&self, slots: &[Slot], run: &Tube) -> bool {
        let begun = slots.len() % POINTS_OF_SPHERE;
        if begun == 0 {
            return false;
        }
        let free = POINTS_OF_SPHERE - begun;
        let before = slots[slots.len() - begun..]
            .iter()
            .filter_map(|slot| slot.ring);
        let rings: Vec<[u32; 4]> = before.chain(run.rings.iter().take(free).copied()).collect();
        let centers = rings
            .iter()
            .map(|ring| (self.center(ring[0]), 4.0 * self.radius(ring[0])));
        let sphere = widened(sphere_around(centers)).1;
        let inaccurate = rings
            .iter()
            .filter(|ring| !accurate(sphere, self.radius(ring[0])));
        5 * inaccurate.count() > free
    }

    pub(crate) fn sphere(&self, slots: &[Slot]) -> (Vec3, f32) {
        let patches = slots
            .iter()
            .filter_map(|slot| slot.patch)
            .flat_map(|patch| patch..patch + 4);
        let patches = patches.map(|patch| patch_sphere(self.mesh, &self.mesh.patches[patch]));
        let centers = slots.iter().filter_map(|slot| slot.ring);
        let centers = centers.map(|ring| (self.center(ring[0]), 0.0));
        widened(sphere_around(patches.chain(centers)))
    }

    /// The contents of the part that a pile becomes.
    pub(crate) fn contents(&self, pile: &Pile) -> Contents {
        let slots = self.rings(pile);
        let (others, caps): (Vec<usize>, Vec<usize>) = pile
            .others
            .iter()
            .partition(|&&other| self.explicit[self.mesh.patches[other].corners[0] as usize]);
        let corners = |patches: &[usize]| -> Vec<u32> {
            let patches = patches
                .iter()
                .map(|&patch| self.mesh.patches[patch].corners);
            patches.flatten().collect()
        };
        let rings = slots.iter().filter_map(|slot| slot.ring).flatten();
        let mut explicit: Vec<u32> = rings.chain(corners(&others)).collect();
        explicit.retain(|&v| self.explicit[v as usize]);
        explicit.sort_unstable();
        explicit.dedup();
        let few = explicit.get(FEW_EXPLICIT).copied().unwrap_or(u32::MAX);
        let (soma, quads): (Vec<usize>, Vec<usize>) = others.into_iter().partition(|&other| {
            let patch = &self.mesh.patches[other];
            patch.kind == PatchKind::Soma && patch.corners.iter().all(|&v| v < few)
        });
        Contents {
            slots,
            explicit,
            soma,
            quads,
            caps,
        }
    }

    pub(crate) fn implicit(&self, ring: [u32; 4]) -> Option<ImplicitRing> {
        let implicit = !self.explicit[ring[0] as usize];
        implicit.then(|| implicit_ring(self.mesh, ring)).flatten()
    }

    pub(crate) fn color_key(&self, tracing: u32) -> u32 {
        self.color_keys.get(tracing as usize).copied().unwrap_or(0)
    }

    /// Whether color keys are indices, which must keep all their bits, and not fractions of a
    /// scale.
    fn has_numbers(&self) -> bool {
        let mut color_keys = self.color_keys.iter();
        color_keys.all(|key| !(MOST_NUMBERS..1 << 31).contains(key))
    }

    pub(crate) fn level(&self, tracing: u32) -> u32 {
        let value = self.values.get(tracing as usize).copied().unwrap_or(1);
        u32::from(value.clamp(1, 64))
    }
}

/// Room for a point: its ring, and the first of the four patches to the next point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slot {
    pub(crate) ring: Option<[u32; 4]>,
    pub(crate) patch: Option<usize>,
}

/// The contents of one part, in order: patches by index, explicit vertices sorted.
pub(crate) struct Contents {
    pub(crate) slots: Vec<Slot>,
    pub(crate) explicit: Vec<u32>,
    pub(crate) soma: Vec<usize>,
    pub(crate) quads: Vec<usize>,
    pub(crate) caps: Vec<usize>,
}

/// First vertex of the ring that a cap closes, and whether the cap has the ring's vertices in
/// reverse order.
pub(crate) fn cap_ring(corners: [u32; 4]) -> Option<(u32, bool)> {
    let first = corners.into_iter().min()?;
    let forwards = [0, 1, 2, 3].map(|k| first + k);
    let backwards = [3, 2, 1, 0].map(|k| first + k);
    match corners {
        c if c == forwards => Some((first, false)),
        c if c == backwards => Some((first, true)),
        _ => None,
    }
}

/// Morton code of a point with coordinates from 0 to 1: their bits interleaved. Close points have
/// close codes.
fn morton(p: Vec3) -> u32 {
    let spread = |c: f32| {
        let bits = (c.clamp(0.0, 1.0) * 1023.0) as u32;
        (0..10).fold(0, |sum, i| sum | (((bits >> i) & 1) << (3 * i)))
    };
    spread(p.x) | (spread(p.y) << 1) | (spread(p.z) << 2)
}

/// A sphere that is a little larger, since rounding moves points.
pub(crate) fn widened((center, radius): (Vec3, f32)) -> (Vec3, f32) {
    (center, radius * 1.01 + 1e-6)
}
