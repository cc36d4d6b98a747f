//! Where a mesh crosses itself.
//!
//! **The rule.** A pair of faces counts if their triangles have a point in common beyond what they
//! share as neighbours. Quads are two triangles, split along the diagonal from their first corner,
//! and no pair with each other. Corners are the same if their index is, or their position bit for
//! bit, so that a file that repeats its vertices (STL) has the neighbours that it shows.
//!
//! | corners shared | the pair counts if |
//! | --- | --- |
//! | none | the closed triangles meet: touching counts |
//! | one | the edge opposite to it, of one, meets the other |
//! | two | they lie in one plane and on the same side of the edge (folded over) |
//! | three | always: they are the same triangle |
//!
//! Triangles without an area have no part in it; they are degenerate already.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::bvh::{Bounds, Bvh};
use crate::crossing::{fans_meet, folded, has_area, triangles_meet};
use crate::weld::first_alike;
use crate::{Faces, SurfaceMesh};

impl SurfaceMesh {
    /// See [`self_intersections`].
    pub fn self_intersections(&self) -> Vec<[u32; 2]> {
        self_intersections(&self.positions(), &self.faces)
    }
}

/// Pairs of faces that cross, each once, lower number first, sorted. Faces are numbered triangles
/// first, then quads: face `triangles.len() + n` is quad `n`.
///
/// Time grows with the faces and with the pairs found: a million triangles take about a second.
/// Panics if a face names a vertex that is not there.
pub fn self_intersections(positions: &[Vec3], faces: &Faces) -> Vec<[u32; 2]> {
    let triangles = triangles(positions, faces);
    let boxes: Vec<Bounds> = triangles
        .par_iter()
        .map(|triangle| Bounds::of(triangle.corners.map(|corner| positions[corner as usize])))
        .collect();
    let tree = Bvh::new(&boxes);
    let mut pairs = (0..tree.leaf_count())
        .into_par_iter()
        .fold(Vec::new, |mut pairs, leaf| {
            tree.overlaps_of_leaf(leaf, |a, b| {
                let (a, b) = (&triangles[a as usize], &triangles[b as usize]);
                if a.face != b.face && a.crosses(b, positions) {
                    pairs.push([a.face.min(b.face), a.face.max(b.face)]);
                }
            });
            pairs
        })
        .reduce(Vec::new, |mut pairs, more| {
            pairs.extend(more);
            pairs
        });
    pairs.par_sort_unstable();
    pairs.dedup();
    pairs
}

/// A triangle of a face.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [u32; 3],
    face: u32,
}

/// Triangles of all faces that have an area, corners at one position being one.
fn triangles(positions: &[Vec3], faces: &Faces) -> Vec<Triangle> {
    let first = first_alike(positions);
    let make = |face: usize, corners: [u32; 3]| {
        let corners = corners.map(|corner| first[corner as usize]);
        let points = corners.map(|corner| positions[corner as usize].as_dvec3());
        let sound = points.iter().all(|point| point.is_finite()) && has_area(&points);
        sound.then_some(Triangle {
            corners,
            face: face as u32,
        })
    };
    let count = faces.triangles.len();
    let triangles = faces
        .triangles
        .par_iter()
        .enumerate()
        .filter_map(|(n, &face)| make(n, face));
    let quads = faces
        .quads
        .par_iter()
        .enumerate()
        .flat_map_iter(|(n, &[a, b, c, d])| {
            [make(count + n, [a, b, c]), make(count + n, [a, c, d])]
                .into_iter()
                .flatten()
        });
    triangles.chain(quads).collect()
}

impl Triangle {
    fn crosses(&self, other: &Self, positions: &[Vec3]) -> bool {
        let mut a = self.corners;
        let mut b = other.corners;
        let shared = shared_first(&mut a, &mut b);
        let at = |corner: u32| -> DVec3 { positions[corner as usize].as_dvec3() };
        let (a, b) = (a.map(at), b.map(at));
        match shared {
            0 => triangles_meet(&a, &b),
            1 => fans_meet(&a, &b),
            2 => folded(&a, &b),
            _ => true,
        }
    }
}

/// Moves the corners that both have to the front, in the same order; returns how many.
fn shared_first(a: &mut [u32; 3], b: &mut [u32; 3]) -> usize {
    let mut shared = 0;
    for n in 0..3 {
        if let Some(m) = (shared..3).find(|&m| b[m] == a[n]) {
            a.swap(n, shared);
            b.swap(m, shared);
            shared += 1;
        }
    }
    shared
}
