//! Decides what goes into which part of a packed mesh.
//!
//! A mesh that would not fit is cut into **parts**. Vertices that two parts or two runs share are
//! explicit, and explicit vertices keep the mesh's order. So the two patches beside an edge have
//! the same bits for it and evaluate it in the same direction: there are no cracks.

use std::collections::BTreeSet;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind};

use crate::bounding_sphere::{patch_sphere, sphere_around};
use crate::decode::{POINTS_OF_SPHERE, accurate};
use crate::part::{MAX_COLOR_KEYS, PATCHES_OF_SPHERE};
use crate::ring_form::{RingForm, implicit_ring, shaped_ring};
use crate::runs::{NO_PATCH, Tube, find_runs};

/// Most slots for patches of a part: a shaped ring keeps the index of its point in 22 bits.
const MAX_PATCHES: usize = 1 << 24;
/// Most explicit vertices and corners of shaped rings of a part: their indices have 15 bits.
const MAX_EXPLICIT: usize = 1 << 15;
/// Patches of somata are stored with indices of 12 bits: they reach this many explicit vertices.
const FEW_EXPLICIT: usize = 1 << 12;

/// If all color keys below 2³¹ are also below this, they are taken for indices: see
/// [`crate::pack()`].
const MAX_NUMBERS: u32 = 1 << 20;

/// Runs and other patches that go into one part, by index.
#[derive(Default)]
pub(crate) struct Pile {
    pub(crate) runs: Vec<usize>,
    pub(crate) others: Vec<usize>,
}

pub(crate) struct Packer<'m> {
    pub(crate) mesh: &'m CoarseMesh,
    color_keys: &'m [u32],
    values: &'m [u8],
    pub(crate) runs: Vec<Tube>,
    pub(crate) others: Vec<usize>,
    /// By vertex: whether it is explicit.
    pub(crate) explicit: Vec<bool>,
    /// By vertex: whether patches name it that belong to no run and are no cap of its ring, or its point has a border.
    pub(crate) named: Vec<bool>,
    /// By vertex: the last run with a ring that it belongs to, [`NO_RUN`] if there is none.
    pub(crate) run_of: Vec<u32>,
}

/// In place of a run.
pub(crate) const NO_RUN: u32 = u32::MAX;

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
        let mut run_of = vec![NO_RUN; mesh.vertices.len()];
        for (i, run) in (0..).zip(&runs) {
            for &v in run.rings.iter().flatten() {
                run_of[v as usize] = i;
            }
        }
        // Only shaped rings and anchors have room for borders.
        let points = mesh
            .vertices
            .iter()
            .map(|v| &mesh.tracing[v.tracing as usize]);
        let borders = points.map(|point| point.border != 0);
        Self {
            mesh,
            color_keys,
            values,
            runs,
            others,
            explicit: vec![false; mesh.vertices.len()],
            named: borders.collect(),
            run_of,
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
        let most_patches = most_patches.min(MAX_PATCHES);
        // A patch with corners of implicit or shaped rings goes where their run is.
        let mut with_run = vec![Vec::new(); self.runs.len()];
        for &other in &self.others {
            if let Some(run) = self.home(other) {
                with_run[run].push(other);
            }
        }
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
                    || explicit > MAX_EXPLICIT
                    || exact && numbers.len() > MAX_COLOR_KEYS
                {
                    piles.push(Pile::default());
                    (patches, explicit) = (PATCHES_OF_SPHERE + more, more_explicit);
                    numbers = color_keys.iter().copied().collect();
                }
                piles.len() - 1
            };
        for (i, run) in self.runs.iter().enumerate() {
            let named = |ring: &&[u32; 4]| {
                ring.iter()
                    .any(|&v| self.explicit[v as usize] || self.named[v as usize])
            };
            let used = run.rings.iter().filter(named).count() + with_run[i].len();
            let most = run.rings.len() + POINTS_OF_SPHERE;
            let tracing = |ring: &[u32; 4]| self.mesh.vertices[ring[0] as usize].tracing;
            let color_keys: Vec<u32> = run
                .rings
                .iter()
                .map(|r| self.color_key(tracing(r)))
                .collect();
            let patches = 4 * most + with_run[i].len();
            let pile = room(&mut piles, patches, 4 * used, &color_keys);
            piles[pile].runs.push(i);
            piles[pile].others.append(&mut with_run[i]);
        }
        for &other in &self.others {
            if self.home(other).is_none() {
                let pile = room(&mut piles, 1, 4, &[]);
                piles[pile].others.push(other);
            }
        }
        piles
            .iter_mut()
            .for_each(|pile| pile.others.sort_unstable());
        piles.retain(|pile| !pile.runs.is_empty() || !pile.others.is_empty());
        piles
    }

    /// The run that a patch outside of runs goes with.
    fn home(&self, other: usize) -> Option<usize> {
        let corners = self.mesh.patches[other].corners.into_iter();
        let mut computed = corners.filter(|&v| !self.explicit[v as usize]);
        computed.next().map(|v| self.run_of[v as usize] as usize)
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
                slots.push(Slot {
                    ring: Some(ring),
                    patches: run.patches.get(i).copied().unwrap_or([NO_PATCH; 4]),
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
            .flat_map(|slot| slot.patches)
            .filter(|&patch| patch != NO_PATCH);
        let patches =
            patches.map(|patch| patch_sphere(self.mesh, &self.mesh.patches[patch as usize]));
        let centers = slots.iter().filter_map(|slot| slot.ring);
        let centers = centers.map(|ring| (self.center(ring[0]), 0.0));
        widened(sphere_around(patches.chain(centers)))
    }

    /// The contents of the part that a pile becomes.
    pub(crate) fn contents(&self, pile: &Pile) -> Contents {
        let slots = self.rings(pile);
        let (caps, others): (Vec<usize>, Vec<usize>) = pile.others.iter().partition(|&&other| {
            let patch = &self.mesh.patches[other];
            patch.kind == PatchKind::Cap && !self.explicit[patch.corners[0] as usize]
        });
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
        let mut shaped = Vec::new();
        for (point, slot) in (0..).zip(&slots) {
            if let Some(ring) = slot.ring.filter(|&ring| self.is_shaped(ring)) {
                shaped.push((ring[0], point));
            }
        }
        // As in the mesh: an edge between two of them has the direction that it has there.
        shaped.sort_unstable();
        Contents {
            slots,
            explicit,
            shaped,
            soma,
            quads,
            caps,
        }
    }

    /// How a ring is computed, if it is not explicit.
    pub(crate) fn form(&self, ring: [u32; 4]) -> Option<RingForm> {
        let computed = !self.explicit[ring[0] as usize];
        computed.then(|| self.fit(ring)).flatten()
    }

    /// How a ring can be computed, if it can.
    pub(crate) fn fit(&self, ring: [u32; 4]) -> Option<RingForm> {
        if self.is_named(ring) {
            shaped_ring(self.mesh, ring).map(RingForm::Shaped)
        } else {
            implicit_ring(self.mesh, ring).map(RingForm::Implicit)
        }
    }

    fn is_named(&self, ring: [u32; 4]) -> bool {
        ring.iter().any(|&v| self.named[v as usize])
    }

    fn is_shaped(&self, ring: [u32; 4]) -> bool {
        !self.explicit[ring[0] as usize] && self.is_named(ring)
    }

    pub(crate) fn color_key(&self, tracing: u32) -> u32 {
        self.color_keys.get(tracing as usize).copied().unwrap_or(0)
    }

    /// Whether color keys are indices, which must keep all their bits, and not fractions of a
    /// scale.
    fn has_numbers(&self) -> bool {
        let mut color_keys = self.color_keys.iter();
        color_keys.all(|key| !(MAX_NUMBERS..1 << 31).contains(key))
    }

    pub(crate) fn level(&self, tracing: u32) -> u32 {
        let value = self.values.get(tracing as usize).copied().unwrap_or(1);
        u32::from(value.clamp(1, 64))
    }
}

/// Room for a point: its ring, and the four patches to the next point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    pub(crate) ring: Option<[u32; 4]>,
    pub(crate) patches: [u32; 4],
}

impl Default for Slot {
    fn default() -> Self {
        Self {
            ring: None,
            patches: [NO_PATCH; 4],
        }
    }
}

impl Slot {
    pub(crate) fn goes_on(&self) -> bool {
        self.patches.iter().any(|&patch| patch != NO_PATCH)
    }

    /// Bits of the sides where branches leave.
    pub(crate) fn open_sides(&self) -> u32 {
        let sides = (0..4).filter(|&k| self.goes_on() && self.patches[k] == NO_PATCH);
        sides.fold(0, |bits, k| bits | (1 << k))
    }
}

/// The contents of one part, in order: patches by index, explicit vertices sorted.
pub(crate) struct Contents {
    pub(crate) slots: Vec<Slot>,
    pub(crate) explicit: Vec<u32>,
    /// First vertex and point of each shaped ring, sorted.
    pub(crate) shaped: Vec<(u32, u32)>,
    pub(crate) soma: Vec<usize>,
    pub(crate) quads: Vec<usize>,
    pub(crate) caps: Vec<usize>,
}

impl Contents {
    /// The index by which patches name a vertex.
    pub(crate) fn id(&self, v: u32) -> u32 {
        if let Ok(explicit) = self.explicit.binary_search(&v) {
            return explicit as u32;
        }
        let ring = self.shaped.partition_point(|&(first, _)| first <= v) - 1;
        self.explicit.len() as u32 + 4 * ring as u32 + (v - self.shaped[ring].0)
    }

    /// Which of the shaped rings begins with this vertex.
    pub(crate) fn shaped_index(&self, first: u32) -> u32 {
        self.shaped.partition_point(|&(other, _)| other < first) as u32
    }
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
