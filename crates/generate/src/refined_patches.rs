//! Some patches of a mesh, refined: which of their facets cross or fold over.
//!
//! By this forks are judged, thousands of times a cell, and rings are drawn in.

use neurotess_mesh::{CoarseMesh, PatchKind};
use neurotess_refine::{RefineOptions, patch_points};

use crate::facets::{Bounds, Facet};
use crate::part::Part;

/// Cells of a patch to a side: level 2.
const STEPS: u32 = 2;
/// Facets of a patch.
const FACETS: usize = 8;
/// Points of a patch.
const POINTS: usize = 9;
/// Overlapping boxes by patch from which on patches are a crowd. Forks of the reference cells have six to
/// eight, stems all around a small soma fifty.
const CROWDED: usize = 16;

/// Triangles of a patch by its points, which are numbered row by row: with parallel diagonals, and with
/// diagonals that run towards the corners.
const PARALLEL: [[usize; 3]; FACETS] = [
    [0, 1, 4],
    [0, 4, 3],
    [1, 2, 5],
    [1, 5, 4],
    [3, 4, 7],
    [3, 7, 6],
    [4, 5, 8],
    [4, 8, 7],
];
const FANNED: [[usize; 3]; FACETS] = [
    [0, 1, 4],
    [0, 4, 3],
    [1, 2, 4],
    [2, 5, 4],
    [3, 4, 6],
    [4, 7, 6],
    [4, 5, 8],
    [4, 8, 7],
];

/// Faults between two patches, or of one patch with itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) patches: [u32; 2],
    pub(crate) count: usize,
    /// Whether they fold over at their edge, and do not cross.
    pub(crate) folded: bool,
}

/// How many faults there are in all.
pub(crate) fn count(faults: &[Fault]) -> usize {
    faults.iter().map(|fault| fault.count).sum()
}

/// Some patches with their refined facets.
pub(crate) struct RefinedPatches {
    pub(crate) part: Part,
    /// By patch: the numbers of its points.
    points: Vec<[u32; POINTS]>,
    /// Eight of each patch.
    facets: Vec<Facet>,
    /// By patch.
    boxes: Vec<Bounds>,
    /// Facets that share an edge, and those of each patch by number.
    edges: Vec<[u32; 2]>,
    patch_edges: Vec<Vec<u32>>,
}

impl RefinedPatches {
    pub(crate) fn new(mesh: &CoarseMesh, patches: Vec<u32>) -> Self {
        let part = Part::new(mesh, patches);
        let count = part.mesh.patches.len();
        let mut refined = Self {
            points: numbers(&part.mesh),
            part,
            facets: Vec::with_capacity(FACETS * count),
            boxes: Vec::with_capacity(count),
            edges: Vec::new(),
            patch_edges: vec![Vec::new(); count],
        };
        for patch in 0..count {
            let facets = refined.patch_facets(patch);
            refined.facets.extend(facets);
            refined.boxes.push(bounds(&facets));
        }
        refined.edges = shared_edges(&refined.facets);
        for (number, edge) in (0..).zip(&refined.edges) {
            let [a, b] = edge.map(|facet| facet as usize / FACETS);
            refined.patch_edges[a].push(number);
            if a != b {
                refined.patch_edges[b].push(number);
            }
        }
        refined
    }

    /// Pairs of facets that cross, and folded edges, by their patches.
    pub(crate) fn faults(&self) -> Vec<Fault> {
        self.faults_of_pairs(self.near_pairs(usize::MAX).unwrap_or_default())
    }

    /// [`RefinedPatches::faults`]; none where there are so many patches in one place that they cannot be looked
    /// at pair by pair.
    pub(crate) fn faults_unless_crowd(&self) -> Option<Vec<Fault>> {
        let near = self.near_pairs(CROWDED * self.boxes.len())?;
        Some(self.faults_of_pairs(near))
    }

    fn faults_of_pairs(&self, near: Vec<[u32; 2]>) -> Vec<Fault> {
        let crossings = near.into_iter().map(|patches| self.crossing(patches));
        let crossings = crossings.filter(|fault| fault.count > 0);
        crossings.chain(self.folds()).collect()
    }

    fn crossing(&self, patches: [u32; 2]) -> Fault {
        Fault {
            patches,
            count: self.crossings(patches),
            folded: false,
        }
    }

    fn folds(&self) -> impl Iterator<Item = Fault> {
        let folded = self.edges.iter().filter(|edge| self.is_folded(edge));
        folded.map(|edge| Fault {
            patches: edge.map(|facet| facet / FACETS as u32),
            count: 1,
            folded: true,
        })
    }

    /// All faults, after some patches were refined again; `before` has those of the others.
    pub(crate) fn faults_again(&self, before: &[Fault], changed: &[u32]) -> Vec<Fault> {
        let mut has_changed = vec![false; self.boxes.len()];
        for &patch in changed {
            has_changed[patch as usize] = true;
        }
        let concerned = |patches: &[u32; 2]| patches.iter().any(|&p| has_changed[p as usize]);
        let kept = before
            .iter()
            .filter(|f| !f.folded && !concerned(&f.patches));
        let near = self.near_pairs(usize::MAX).unwrap_or_default();
        let near = near.into_iter().filter(concerned);
        let crossings = near.map(|patches| self.crossing(patches));
        let crossings = crossings.filter(|fault| fault.count > 0);
        kept.copied().chain(crossings).chain(self.folds()).collect()
    }

    /// How many faults some patches have, with each other and with all others. `patches`: ascending.
    pub(crate) fn faults_of(&self, patches: &[u32]) -> usize {
        let mut count = 0;
        let mut edges: Vec<u32> = Vec::new();
        for &patch in patches {
            edges.extend(&self.patch_edges[patch as usize]);
            for other in 0..self.boxes.len() as u32 {
                let counted = other < patch && patches.binary_search(&other).is_ok();
                if !counted && self.boxes[patch as usize].overlaps(&self.boxes[other as usize]) {
                    count += self.crossings([patch, other]);
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let folded = |edge: &&u32| self.is_folded(&self.edges[**edge as usize]);
        count + edges.iter().filter(folded).count()
    }

    /// Refines patches again whose corners moved.
    pub(crate) fn update(&mut self, patches: &[u32]) {
        for &patch in patches {
            let patch = patch as usize;
            let facets = self.patch_facets(patch);
            self.facets[FACETS * patch..FACETS * (patch + 1)].copy_from_slice(&facets);
            self.boxes[patch] = bounds(&facets);
        }
    }

    fn patch_facets(&self, patch: usize) -> [Facet; FACETS] {
        let mut points = Vec::with_capacity(POINTS);
        let mesh = &self.part.mesh;
        patch_points(mesh, patch, STEPS, &RefineOptions::default(), &mut points);
        let numbers = &self.points[patch];
        let triangles = match mesh.patches[patch].kind {
            PatchKind::Lateral => &PARALLEL,
            PatchKind::Cap | PatchKind::Soma | PatchKind::Loft => &FANNED,
        };
        triangles.map(|t| Facet::new(t.map(|k| numbers[k]), t.map(|k| points[k])))
    }

    /// Pairs of patches whose boxes overlap, each with itself too; none if there are more than `most`.
    fn near_pairs(&self, most: usize) -> Option<Vec<[u32; 2]>> {
        let mut order: Vec<u32> = (0..self.boxes.len() as u32).collect();
        let low = |patch: u32| self.boxes[patch as usize].low.x;
        order.sort_by(|&a, &b| low(a).total_cmp(&low(b)).then(a.cmp(&b)));
        let mut pairs = Vec::with_capacity(12 * order.len());
        for (i, &a) in order.iter().enumerate() {
            let end = self.boxes[a as usize].high.x;
            pairs.push([a, a]);
            for &b in order[i + 1..].iter().take_while(|&&b| low(b) <= end) {
                if self.boxes[a as usize].overlaps(&self.boxes[b as usize]) {
                    pairs.push([a, b]);
                }
            }
            if pairs.len() > most {
                return None;
            }
        }
        Some(pairs)
    }

    /// Pairs of facets of two patches that cross.
    fn crossings(&self, patches: [u32; 2]) -> usize {
        let [a, b] = patches.map(|p| &self.facets[FACETS * p as usize..][..FACETS]);
        if patches[0] == patches[1] {
            let after = |i: usize| a[i + 1..].iter().filter(move |other| a[i].crosses(other));
            return (0..FACETS).map(|i| after(i).count()).sum();
        }
        // Of patches side by side, few facets are near the other patch.
        let near = |patch: u32, facet: &Facet| facet.bounds.overlaps(&self.boxes[patch as usize]);
        let mut others = [0; FACETS];
        let mut count = 0;
        for (i, _) in b.iter().enumerate().filter(|(_, f)| near(patches[0], f)) {
            others[count] = i;
            count += 1;
        }
        let crossed = |facet: &Facet| {
            let others = others[..count].iter().filter(|&&i| facet.crosses(&b[i]));
            others.count()
        };
        let facets = a.iter().filter(|facet| near(patches[1], facet));
        facets.map(crossed).sum()
    }

    fn is_folded(&self, edge: &[u32; 2]) -> bool {
        let [a, b] = edge.map(|facet| &self.facets[facet as usize]);
        a.folds(b)
    }
}

fn bounds(facets: &[Facet; FACETS]) -> Bounds {
    let rest = facets[1..].iter();
    rest.fold(facets[0].bounds, |bounds, facet| bounds.with(&facet.bounds))
}

/// Numbers of the points of each patch: corners first, then the middles of edges, then those of patches.
fn numbers(mesh: &CoarseMesh) -> Vec<[u32; POINTS]> {
    let sides = |c: [u32; 4]| [(c[0], c[1]), (c[1], c[2]), (c[3], c[2]), (c[0], c[3])];
    let edge = |(a, b): (u32, u32)| (a.min(b), a.max(b));
    let mut edges: Vec<(u32, u32)> = mesh
        .patches
        .iter()
        .flat_map(|patch| sides(patch.corners).map(edge))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    let first_edge = mesh.vertices.len() as u32;
    let first_inner = first_edge + edges.len() as u32;
    let number = |side| first_edge + edges.partition_point(|&e| e < edge(side)) as u32;
    (first_inner..)
        .zip(&mesh.patches)
        .map(|(inner, patch)| {
            let [a, b, c, d] = patch.corners;
            let [near, right, far, left] = sides(patch.corners).map(number);
            [a, near, b, left, inner, right, d, far, c]
        })
        .collect()
}

/// Pairs of facets with a common edge.
fn shared_edges(facets: &[Facet]) -> Vec<[u32; 2]> {
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * facets.len());
    for (number, facet) in (0..).zip(facets) {
        let [a, b, c] = facet.corners;
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), number));
        }
    }
    edges.sort_unstable();
    let same = |pair: &&[(u32, u32, u32)]| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1);
    let pairs = edges.windows(2).filter(same);
    pairs.map(|pair| [pair[0].2, pair[1].2]).collect()
}
