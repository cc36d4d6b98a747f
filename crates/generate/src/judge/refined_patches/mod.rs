//! Some patches of a mesh, refined: which of their facets cross or fold over.
//!
//! By this forks are judged, thousands of times a cell, and rings are drawn in.

mod cut;
mod finer;
mod pairs;
mod seams;

use glam::{Vec3, Vec3A};
use neurotess_mesh::{CoarseMesh, Patch, PatchKind};
use neurotess_refine::{RefineOptions, patch_points};
use rayon::prelude::*;

use crate::judge::facets::{Bounds, Facet};
use crate::judge::part::Part;
use cut::{Cut, Level, MAX_FACETS};
pub(crate) use finer::FinerFaults;
use seams::{Seams, numbers};

/// Overlapping boxes by patch from which on patches are a crowd. Forks of the reference cells have six to
/// eight, stems all around a small soma fifty.
const CROWDED: usize = 16;
/// Facets are seen from one side if they face it by more than this: cosine of 72°, to stay clear of outlines
/// that cross. With 90° little more time is saved, and cells with many folds have a few more of them.
const MIN_COS: f32 = 0.3;

/// Cosine of the angle between a ring's normal and the ways to its neighbors up to which its path goes straight on.
const STRAIGHT_ON: f32 = 0.8;
/// A ring that is so many times as thick as both next ones is a swelling.
const SWELLING: f32 = 1.5;

/// Patches that are refined, and pairs that are searched, by one task.
const MIN_PATCHES: usize = 64;
const MIN_PAIRS: usize = 256;

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
    cut: &'static Cut,
    /// Patch by patch: the numbers of its points.
    points: Vec<u32>,
    /// Patch by patch.
    facets: Vec<Facet>,
    /// By patch.
    boxes: Vec<Bounds>,
    /// By patch: sum of its facets' normals.
    facing: Vec<Vec3A>,
    seams: Seams,
}

impl RefinedPatches {
    /// Patches as they are at level 2.
    pub(crate) fn new(mesh: &CoarseMesh, patches: Vec<u32>) -> Self {
        Self::at_level(Level::Two, mesh, patches)
    }

    fn at_level(level: Level, mesh: &CoarseMesh, patches: Vec<u32>) -> Self {
        let part = Part::new(mesh, patches);
        let cut = Cut::of(level);
        let count = part.mesh.patches.len();
        let (points, seams) = numbers(&part.mesh, cut);
        let mut refined = Self {
            cut,
            points,
            part,
            facets: Vec::new(),
            boxes: Vec::with_capacity(count),
            facing: Vec::with_capacity(count),
            seams,
        };
        let all: Vec<u32> = (0..count as u32).collect();
        refined.facets = refined.refine(&all);
        for facets in refined.facets.chunks(cut.facets()) {
            refined.boxes.push(bounds(facets));
            refined.facing.push(facing(facets));
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
        let mut faults = self.crossings_of(near);
        faults.extend(self.folds());
        faults
    }

    /// The pairs of patches that cross, in their order.
    fn crossings_of(&self, pairs: Vec<[u32; 2]>) -> Vec<Fault> {
        let pairs = pairs.into_par_iter().with_min_len(MIN_PAIRS);
        let crossings = pairs.map(|patches| self.crossing(patches));
        crossings.filter(|fault| fault.count > 0).collect()
    }

    fn crossing(&self, patches: [u32; 2]) -> Fault {
        Fault {
            patches,
            count: self.crossings(patches),
            folded: false,
        }
    }

    /// Edges within patches and between them that fold over, in the order of their vertices.
    fn folds(&self) -> impl Iterator<Item = Fault> {
        let patches = 0..self.boxes.len() as u32;
        let within = patches.flat_map(|patch| self.edges_within(patch));
        let across = self.seams.edges.iter().copied();
        let folded = within.chain(across).filter(|edge| self.is_folded(edge));
        let mut folded: Vec<([u32; 2], [u32; 2])> = folded
            .map(|edge| (self.common_vertices(edge), edge))
            .collect();
        folded.sort_unstable();
        folded.into_iter().map(|(_, edge)| self.fold(edge))
    }

    /// Pairs of facets that share an edge within a patch.
    fn edges_within(&self, patch: u32) -> impl Iterator<Item = [u32; 2]> {
        let pattern = self.cut.pattern(&self.part.mesh.patches[patch as usize]);
        let first = self.cut.facets() as u32 * patch;
        pattern
            .within
            .iter()
            .map(move |pair| pair.map(|facet| first + facet))
    }

    /// The vertices of the edge that two facets share, in order.
    fn common_vertices(&self, edge: [u32; 2]) -> [u32; 2] {
        let [a, b] = edge.map(|facet| self.facets[facet as usize].corners);
        let mut common = a.into_iter().filter(|corner| b.contains(corner));
        let [p, q] = [(); 2].map(|()| common.next().unwrap_or_default());
        [p.min(q), p.max(q)]
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
        let crossings = self.crossings_of(self.pairs_near(&has_changed));
        kept.copied().chain(crossings).chain(self.folds()).collect()
    }

    /// The faults that some patches have, with each other and with all others; none if they are more than
    /// `most`. `patches`: ascending.
    pub(crate) fn faults_of(&self, patches: &[u32], most: usize) -> Option<Vec<Fault>> {
        let boxes = patches.iter().map(|&patch| self.boxes[patch as usize]);
        let around = boxes.reduce(|a, b| a.with(&b))?;
        let mut faults = Vec::new();
        let mut count = 0;
        let mut is_too_many = |fault: Fault| {
            count += fault.count;
            faults.extend((fault.count > 0).then_some(fault));
            count > most
        };
        let within = patches.iter().flat_map(|&patch| self.edges_within(patch));
        let mut seams: Vec<u32> = patches.iter().flat_map(|&p| self.seams.of(p)).collect();
        seams.sort_unstable();
        seams.dedup();
        let across = seams.iter().flat_map(|&seam| self.seams.edges(seam));
        let across = across.copied();
        for edge in within.chain(across).filter(|edge| self.is_folded(edge)) {
            if is_too_many(self.fold(edge)) {
                return None;
            }
        }
        let all = 0..self.boxes.len() as u32;
        let near = all.filter(|&other| around.overlaps(&self.boxes[other as usize]));
        let near: Vec<u32> = near.collect();
        for &patch in patches {
            for &other in &near {
                let counted = other < patch && patches.binary_search(&other).is_ok();
                let overlap = self.boxes[patch as usize].overlaps(&self.boxes[other as usize]);
                if !counted && overlap && is_too_many(self.crossing([patch, other])) {
                    return None;
                }
            }
        }
        Some(faults)
    }

    /// Refines patches again whose corners moved.
    pub(crate) fn update(&mut self, patches: &[u32]) {
        let refined = self.refine(patches);
        self.restore(patches, &refined);
    }

    /// The facets of some patches, to be [restored](Self::restore).
    pub(crate) fn saved(&self, patches: &[u32]) -> Vec<Facet> {
        let facets = patches.iter().flat_map(|&patch| self.facets_of(patch));
        facets.copied().collect()
    }

    /// Gives patches the facets back that were saved; their corners are where they were then.
    pub(crate) fn restore(&mut self, patches: &[u32], saved: &[Facet]) {
        let count = self.cut.facets();
        for (&patch, facets) in patches.iter().zip(saved.chunks(count)) {
            let patch = patch as usize;
            self.facets[count * patch..][..count].copy_from_slice(facets);
            self.boxes[patch] = bounds(facets);
            self.facing[patch] = facing(facets);
        }
    }

    /// The facets of some patches, from where their corners are now.
    fn refine(&self, patches: &[u32]) -> Vec<Facet> {
        let count = self.cut.facets();
        let mut facets = vec![Facet::default(); count * patches.len()];
        let parts = facets.par_chunks_mut(count * MIN_PATCHES);
        let parts = parts.zip(patches.par_chunks(MIN_PATCHES));
        parts.for_each_with(Vec::new(), |points, (facets, patches)| {
            self.facets_at(patches, points, facets);
        });
        facets
    }

    fn facets_at(&self, patches: &[u32], points: &mut Vec<Vec3>, facets: &mut [Facet]) {
        let mesh = &self.part.mesh;
        points.clear();
        let steps = self.cut.steps as u32;
        patch_points(mesh, patches, steps, &RefineOptions::default(), points);
        let of_patches = facets.chunks_mut(self.cut.facets());
        let of_patches = of_patches.zip(points.chunks(self.cut.points()));
        for ((facets, points), &patch) in of_patches.zip(patches) {
            let patch = patch as usize;
            let numbers = &self.points[self.cut.points() * patch..][..self.cut.points()];
            let triangles = &self.cut.pattern(&mesh.patches[patch]).triangles;
            for (facet, t) in facets.iter_mut().zip(triangles) {
                *facet = Facet::new(t.map(|k| numbers[k]), t.map(|k| points[k]));
            }
        }
    }

    /// Pairs of facets of two patches that cross.
    fn crossings(&self, patches: [u32; 2]) -> usize {
        if self.is_spread_out(patches) {
            return 0;
        }
        let [a, b] = patches.map(|p| self.facets_of(p));
        if patches[0] == patches[1] {
            let after = |i: usize| a[i + 1..].iter().filter(move |other| a[i].crosses(other));
            return (0..a.len()).map(|i| after(i).count()).sum();
        }
        // Of patches side by side, few facets are near the other patch.
        let near = |patch: u32, facet: &Facet| facet.bounds.overlaps(&self.boxes[patch as usize]);
        let mut others = [0; MAX_FACETS];
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

    /// Whether two patches with a common edge, or a patch alone, are seen from one side all over: such a surface
    /// does not cross itself unless its outline does (Volino & Magnenat-Thalmann, Efficient self-collision
    /// detection on smoothly discretized surface animations, 1994). Of patches with only a vertex in common the
    /// outlines cross too often.
    fn is_spread_out(&self, [a, b]: [u32; 2]) -> bool {
        let corners = |patch: u32| self.part.mesh.patches[patch as usize].corners;
        let (own, others) = (corners(a), corners(b));
        if a != b && own.iter().filter(|corner| others.contains(corner)).count() < 2 {
            return false;
        }
        let side = self.facing[a as usize] + self.facing[b as usize];
        let least = MIN_COS * side.length();
        let mut facets = self.facets_of(a).iter().chain(self.facets_of(b));
        facets.all(|facet| facet.normal.dot(side) > least)
    }

    fn facets_of(&self, patch: u32) -> &[Facet] {
        &self.facets[self.cut.facets() * patch as usize..][..self.cut.facets()]
    }

    /// The fault of facets that fold over at their edge.
    fn fold(&self, edge: [u32; 2]) -> Fault {
        Fault {
            patches: edge.map(|facet| facet / self.cut.facets() as u32),
            count: 1,
            folded: true,
        }
    }

    fn is_folded(&self, edge: &[u32; 2]) -> bool {
        let [a, b] = edge.map(|facet| &self.facets[facet as usize]);
        a.folds(b) && !self.is_swelling(edge)
    }

    /// Whether facets meet at a ring whose tubes go on to opposite sides of its plane: of a swelling they
    /// face nearly opposite ways and fold nothing over.
    fn is_swelling(&self, edge: &[u32; 2]) -> bool {
        let mesh = &self.part.mesh;
        let [a, b] = edge.map(|facet| &mesh.patches[facet as usize / self.cut.facets()]);
        let points = |patch: &Patch| {
            let mut points = patch
                .corners
                .map(|v| mesh.vertices[v as usize].tracing)
                .to_vec();
            points.dedup();
            points
        };
        let [a, b] = match [a, b].map(|patch| (patch.kind, points(patch))) {
            [(PatchKind::Lateral, a), (PatchKind::Lateral, b)] => [a, b],
            _ => return false,
        };
        let Some(&ring) = a.iter().find(|ring| b.contains(ring)) else {
            return false;
        };
        let ring_point = &mesh.tracing[ring as usize];
        // How far the tube goes on along the ring's normal, and how many times as thick as its other ring this one is.
        let along = |points: Vec<u32>| {
            let other = points.into_iter().find(|&point| point != ring)?;
            let other = &mesh.tracing[other as usize];
            let way = (other.center - ring_point.center).normalize_or_zero();
            let thicker = ring_point.radius / other.radius;
            Some([way.dot(ring_point.tangent), thicker])
        };
        let (Some([a, thicker]), Some([b, than])) = (along(a), along(b)) else {
            return false;
        };
        let is_straight = a * b < 0.0 && a.abs().min(b.abs()) > STRAIGHT_ON;
        is_straight && thicker.min(than) > SWELLING
    }
}

fn bounds(facets: &[Facet]) -> Bounds {
    let rest = facets[1..].iter();
    rest.fold(facets[0].bounds, |bounds, facet| bounds.with(&facet.bounds))
}

fn facing(facets: &[Facet]) -> Vec3A {
    facets.iter().map(|facet| facet.normal).sum()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use neurotess_mesh::{TracingPoint, Vertex};

    use super::*;

    /// An open tube of radius 1 along a path that turns back within that: it folds over and crosses itself.
    pub(super) fn hairpin() -> CoarseMesh {
        let mut mesh = CoarseMesh::default();
        for ring in 0..16_u32 {
            let (along, back) = (ring as f32 - 7.5, ring > 7);
            let center = Vec3::new(-along.abs(), if back { 0.3 } else { 0.0 }, 0.0);
            let tangent = if back { -Vec3::X } else { Vec3::X };
            let radial = tangent.cross(Vec3::Z);
            mesh.tracing.push(TracingPoint {
                center,
                radius: 1.0,
                tangent,
                ..TracingPoint::default()
            });
            for normal in [radial, Vec3::Z, -radial, -Vec3::Z] {
                mesh.vertices.push(Vertex {
                    position: center + normal,
                    normal,
                    tracing: ring,
                });
            }
            let first = 4 * ring;
            mesh.patches.extend((0..4).filter(|_| ring > 0).map(|k| {
                let [a, b] = [first + k, first + (k + 1) % 4];
                Patch {
                    corners: [a - 4, b - 4, b, a],
                    kind: PatchKind::Lateral,
                }
            }));
        }
        mesh
    }

    /// Those that some patches have a part in.
    fn concerned(faults: &[Fault], patches: &[u32]) -> Vec<Fault> {
        let concerned = |fault: &&Fault| fault.patches.iter().any(|p| patches.contains(p));
        faults.iter().filter(concerned).copied().collect()
    }

    #[test]
    fn faults_of_some_patches_are_those_of_all_that_concern_them() {
        let mesh = hairpin();
        let all = 0..mesh.patches.len() as u32;
        let refined = RefinedPatches::new(&mesh, all.clone().collect());
        let faults = refined.faults();
        let [folded, crossing] =
            [true, false].map(|k| faults.iter().filter(move |f| f.folded == k));
        let found = [folded.count(), crossing.count()];
        assert!(found.iter().all(|&found| found > 0), "{found:?}");
        let all: Vec<u32> = all.collect();
        for patches in all.chunks(7).chain([&all[..]]) {
            let expected = count(&concerned(&faults, patches));
            let of = |most: usize| refined.faults_of(patches, most);
            assert_eq!(of(expected).map(|of| count(&of)), Some(expected));
            if let Some(fewer) = expected.checked_sub(1) {
                assert!(of(fewer).is_none(), "more than {fewer}");
            }
        }
    }

    #[test]
    fn what_was_saved_comes_back() {
        let mesh = hairpin();
        let mut refined = RefinedPatches::new(&mesh, (0..60).collect());
        let before = refined.faults();
        let patches = [20, 21, 22, 23, 24, 25, 26, 27];
        let saved = refined.saved(&patches);
        let moved = refined.part.mesh.vertices[24].position;
        refined.part.mesh.vertices[24].position = moved + Vec3::splat(0.4);
        refined.update(&patches);
        assert_ne!(refined.faults(), before);
        refined.part.mesh.vertices[24].position = moved;
        refined.restore(&patches, &saved);
        assert_eq!(refined.faults(), before);
    }
}
