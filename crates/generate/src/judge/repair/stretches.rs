//! Suspect rings that belong together, and the patches around them.

use neurotess_mesh::{CoarseMesh, PatchKind, Role};

use super::graph::RingGraph;
use super::suspects::Suspects;

/// Steps from a suspect ring to the last one that is drawn in with it.
const MARGIN: usize = 2;
/// No stretch, or none yet.
const NONE: u32 = u32::MAX;

/// Stretches of suspect rings.
pub(super) struct Stretches {
    /// By tracing point: the number of its stretch.
    of: Vec<u32>,
    /// By stretch: patches around its suspect rings, and around all its rings.
    pub(super) suspect: Vec<Vec<u32>>,
    pub(super) patches: Vec<Vec<u32>>,
}

impl Stretches {
    pub(super) fn new(mesh: &CoarseMesh, graph: &RingGraph, suspects: &Suspects) -> Self {
        let within = widened(mesh, graph, &suspects.rings);
        let mut sets = Sets::new(within.len());
        for &[a, b] in graph.tubes().iter().chain(&suspects.pairs) {
            if within[a as usize] && within[b as usize] {
                sets.join(a, b);
            }
        }
        let mut of = vec![NONE; within.len()];
        let mut count = 0;
        for ring in (0..within.len() as u32).filter(|&ring| within[ring as usize]) {
            // The first of a set stands for it.
            let first = sets.first(ring);
            if first == ring {
                of[ring as usize] = count;
                count += 1;
            } else {
                of[ring as usize] = of[first as usize];
            }
        }
        let mut stretches = Self {
            of,
            suspect: vec![Vec::new(); count as usize],
            patches: vec![Vec::new(); count as usize],
        };
        stretches.list_patches(mesh, &suspects.rings);
        stretches
    }

    /// Whether a tracing point belongs to a stretch.
    pub(super) fn has(&self, stretch: usize, ring: u32) -> bool {
        self.of[ring as usize] == stretch as u32
    }

    fn list_patches(&mut self, mesh: &CoarseMesh, suspect: &[bool]) {
        for (number, patch) in (0..).zip(&mesh.patches) {
            if patch.kind == PatchKind::Soma {
                continue;
            }
            for v in patch.corners {
                let ring = mesh.vertices[v as usize].tracing as usize;
                let stretch = self.of[ring];
                if stretch == NONE {
                    continue;
                }
                let patches = &mut self.patches[stretch as usize];
                if patches.last() != Some(&number) {
                    patches.push(number);
                }
                let patches = &mut self.suspect[stretch as usize];
                if suspect[ring] && patches.last() != Some(&number) {
                    patches.push(number);
                }
            }
        }
    }
}

/// Suspect rings and those within [`MARGIN`] steps.
fn widened(mesh: &CoarseMesh, graph: &RingGraph, suspect: &[bool]) -> Vec<bool> {
    let mut within = suspect.to_vec();
    let mut last: Vec<u32> = (0..within.len() as u32)
        .filter(|&ring| within[ring as usize])
        .collect();
    for _ in 0..MARGIN {
        let mut next = Vec::new();
        for &neighbor in last.iter().flat_map(|&ring| graph.neighbors(ring)) {
            let neighbor_within = &mut within[neighbor as usize];
            if !*neighbor_within && mesh.tracing[neighbor as usize].role != Role::Soma {
                *neighbor_within = true;
                next.push(neighbor);
            }
        }
        last = next;
    }
    within
}

/// Disjoint sets of numbers.
struct Sets(Vec<u32>);

impl Sets {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// The first number of a set.
    fn first(&mut self, mut number: u32) -> u32 {
        while self.0[number as usize] != number {
            let above = self.0[number as usize];
            self.0[number as usize] = self.0[above as usize];
            number = above;
        }
        number
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
