//! What a picture took, and why there is none.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use neurotess_mesh::Surface as _;
use neurotess_refine::{HIGHEST_LEVEL, Refinement};
use thiserror::Error;

/// Why a picture was not made.
#[derive(Debug, Error)]
pub enum PictureError<E> {
    /// The function that takes the bands returned an error.
    #[error("{0}")]
    Sink(E),
    /// It was stopped by a [`Watch`](neurotess_picture::Watch).
    #[error("stopped")]
    Stopped,
}

/// What a picture took, and what it shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Number of bands.
    pub bands: usize,
    /// Most bytes of samples at once.
    pub sample_bytes: u64,
    /// Patches that are drawn, and vertices and triangles that they are refined to; what several bands show counts in each.
    pub patches: u64,
    /// Vertices.
    pub vertices: u64,
    /// Triangles.
    pub triangles: u64,
    /// By level: sides of drawn patches.
    pub levels: BTreeMap<u32, u64>,
}

/// Counts what is drawn.
pub(crate) struct Counts {
    patches: AtomicU64,
    vertices: AtomicU64,
    triangles: AtomicU64,
    levels: [AtomicU64; HIGHEST_LEVEL as usize + 1],
}

impl Default for Counts {
    fn default() -> Self {
        Self {
            patches: AtomicU64::default(),
            vertices: AtomicU64::default(),
            triangles: AtomicU64::default(),
            levels: [const { AtomicU64::new(0) }; HIGHEST_LEVEL as usize + 1],
        }
    }
}

impl Counts {
    pub(crate) fn add(&self, shown: &[bool], refinement: &Refinement<'_>) {
        let add = |to: &AtomicU64, count: usize| to.fetch_add(count as u64, Ordering::Relaxed);
        let shown = || shown.iter().enumerate().filter(|(_, shown)| **shown);
        add(&self.patches, shown().count());
        add(&self.vertices, refinement.vertex_count());
        add(&self.triangles, refinement.triangle_count());
        let mut levels = [0; HIGHEST_LEVEL as usize + 1];
        for (patch, _) in shown() {
            for level in refinement.patch_levels(patch) {
                levels[level as usize] += 1;
            }
        }
        for (to, count) in self.levels.iter().zip(levels) {
            add(to, count);
        }
    }

    /// Adds what was counted.
    pub(crate) fn add_to(&self, cost: &mut Cost) {
        let count = |of: &AtomicU64| of.load(Ordering::Relaxed);
        cost.patches = count(&self.patches);
        cost.vertices = count(&self.vertices);
        cost.triangles = count(&self.triangles);
        let levels = (0..).zip(self.levels.iter().map(count));
        cost.levels = levels.filter(|(_, sides)| *sides > 0).collect();
    }
}
