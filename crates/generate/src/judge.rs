//! How sound some patches are: crossing pairs of facets of their refined surface, and folded edges.
//!
//! A judgement of one choice beside another, thousands of times a cell.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, SurfaceMesh};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

use crate::facets::Facet;
use crate::part::Part;

/// Level at which patches are judged.
const LEVEL: u32 = 2;

/// Crossing pairs and folded edges of some patches' refined surface.
pub(crate) fn faults(mesh: &CoarseMesh, patches: &[u32]) -> usize {
    let part = Part::new(mesh, patches.to_vec()).mesh;
    let options = RefineOptions::default();
    let level = LodCriterion::Homogeneous(LEVEL);
    let surface = SurfaceMesh::collect(&Refinement::new(&part, level, &options));
    let point = |v: u32| surface.vertices[v as usize].position;
    let triangles = surface.faces.triangles.iter();
    let mut facets: Vec<Facet> = triangles
        .map(|&corners| Facet::new(corners, corners.map(point)))
        .collect();
    folds(&facets) + crossings(&mut facets)
}

/// Pairs of facets that cross; those with a common edge are the folds' concern.
fn crossings(facets: &mut [Facet]) -> usize {
    let axis = longest_axis(facets);
    facets.sort_by(|a, b| a.low[axis].total_cmp(&b.low[axis]));
    let mut count = 0;
    for (i, a) in facets.iter().enumerate() {
        let after = facets[i + 1..].iter();
        let near = after.take_while(|b| b.low[axis] <= a.high[axis]);
        count += near.filter(|b| a.crosses(b)).count();
    }
    count
}

/// The axis along which the facets spread most: the fewest pairs overlap there.
fn longest_axis(facets: &[Facet]) -> usize {
    let low = facets.iter().fold(Vec3::INFINITY, |low, f| low.min(f.low));
    let high = facets
        .iter()
        .fold(Vec3::NEG_INFINITY, |high, f| high.max(f.high));
    (high - low).max_position()
}

/// Edges between facets that are folded over.
fn folds(facets: &[Facet]) -> usize {
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * facets.len());
    for (t, facet) in (0..).zip(facets) {
        let [a, b, c] = facet.corners;
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), t));
        }
    }
    edges.sort_unstable();
    let folded = |pair: &&[(u32, u32, u32)]| {
        let [a, b] = [pair[0], pair[1]];
        (a.0, a.1) == (b.0, b.1) && facets[a.2 as usize].folds(&facets[b.2 as usize])
    };
    edges.windows(2).filter(folded).count()
}
