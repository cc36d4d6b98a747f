//! Facets that cross, and facets that are folded.

use glam::Vec3;
use neurotess::mesh::{Faces, self_intersections};

use crate::tree::Tree;

/// Radii around a fork within which crossings are its own.
const NEAR_FORK: f32 = 4.0;
/// Cosine of the angle (120°) from which on two facets are folded onto one another.
const FOLDED: f32 = -0.5;

/// Crossing pairs near a fork, and all of them.
pub(crate) fn crossings(positions: &[Vec3], faces: &Faces, tree: &Tree) -> [usize; 2] {
    let pairs = self_intersections(positions, faces);
    let middle = |face: u32| {
        let [a, b, c] = faces.triangles[face as usize].map(|v| positions[v as usize]);
        (a + b + c) / 3.0
    };
    let forks: Vec<(Vec3, f32)> = tree
        .forks()
        .map(|fork| (tree.positions[fork], tree.radii[fork]))
        .collect();
    let near = pairs.iter().filter(|pair| {
        let [a, b] = pair.map(middle);
        forks.iter().any(|&(center, radius)| {
            a.distance(center).min(b.distance(center)) < NEAR_FORK * radius
        })
    });
    [near.count(), pairs.len()]
}

/// Facets that are folded onto a neighbor.
pub(crate) fn folded(positions: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let normals: Vec<Vec3> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let mut edges = Vec::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), t));
        }
    }
    edges.sort_unstable();
    let mut folded = vec![false; triangles.len()];
    for pair in edges.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        if (a.0, a.1) == (b.0, b.1) && normals[a.2].dot(normals[b.2]) < FOLDED {
            folded[a.2] = true;
            folded[b.2] = true;
        }
    }
    folded.into_iter().filter(|&f| f).count()
}
