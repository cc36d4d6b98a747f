//! Surfaces that cross a little are pressed in, instead of growing together.
//!
//! Where two branches cross, their union has a handle if they hang together elsewhere, too: for voltage and
//! diffusion a short circuit. If they cross by less than a share of their radii, both become thinner there, step
//! by step, each towards its own inside, with their surroundings half and a quarter as far. Places that still
//! cross when no vertex may go farther are put back, and merged.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use neurotess_mesh::{Forest, self_intersections_of};

use crate::work::Work;

/// Steps to the farthest that a vertex may go.
const STEPS: usize = 10;

/// Edges around faces that cross within which the surface follows.
const RINGS: usize = 2;

/// What [`press_in`] did.
pub(crate) struct Pressed {
    /// How many vertices were moved.
    pub(crate) moved: usize,
    /// Which of the pairs still cross; no others do.
    pub(crate) left: Vec<[u32; 2]>,
}

/// Presses the faces of `pairs`, which are all that cross, in: each vertex by `most` of its radius or of the distance
/// to its neighbors, what is less.
pub(crate) fn press_in(work: &mut Work, pairs: &[[u32; 2]], most: f64) -> Pressed {
    let mut start: BTreeMap<u32, Vec3> = BTreeMap::new();
    let mut left = pairs.to_vec();
    for _ in 0..STEPS {
        if left.is_empty() {
            break;
        }
        step(work, &left, most, &mut start);
        left = crossings_near(work, &start);
    }
    while !left.is_empty() {
        // What is put back may meet what is not, so it is searched again.
        put_back(work, &left, &mut start);
        left = crossings_near(work, &start);
    }
    for &vertex in start.keys() {
        work.fresh[vertex as usize] = true;
    }
    // Faces of vertices that have moved cross nothing any more.
    let stays = |face: u32| {
        let mut corners = work.triangles[face as usize].iter();
        corners.all(|corner| !start.contains_key(corner))
    };
    let left = pairs.iter().filter(|pair| pair.iter().all(|&f| stays(f)));
    Pressed {
        moved: start.len(),
        left: left.copied().collect(),
    }
}

/// Moves the corners of faces that cross, and what is around them, one step.
fn step(work: &mut Work, pairs: &[[u32; 2]], most: f64, start: &mut BTreeMap<u32, Vec3>) {
    let mut near = vec![false; work.vertices.len()];
    for &face in pairs.iter().flatten() {
        for corner in work.triangles[face as usize] {
            near[corner as usize] = true;
        }
    }
    let mut shares: BTreeMap<u32, f32> = BTreeMap::new();
    let mut share = 1.0;
    for ring in 0..=RINGS {
        for vertex in (0..).zip(&near).filter(|(_, near)| **near).map(|(v, _)| v) {
            shares.entry(vertex).or_insert(share);
        }
        share *= 0.5;
        if ring < RINGS {
            near = work.widened(near, 1);
        }
    }
    let reach = reach(work, &shares);
    for (vertex, share) in shares {
        let before = work.vertices[vertex as usize];
        let first = *start.entry(vertex).or_insert(before.position);
        let farthest = most as f32 * before.radius.min(reach[&vertex]);
        let by = share * farthest / STEPS as f32;
        let way = before.position - by * before.normal - first;
        let position = first + way.clamp_length_max(farthest);
        work.vertices[vertex as usize].position = position;
    }
}

/// Mean distance of vertices to their neighbors.
fn reach(work: &Work, of: &BTreeMap<u32, f32>) -> BTreeMap<u32, f32> {
    let mut sums: BTreeMap<u32, (f32, f32)> =
        of.keys().map(|&vertex| (vertex, (0.0, 0.0))).collect();
    for face in &work.triangles {
        for n in 0..3 {
            let [a, b] = [face[n], face[(n + 1) % 3]];
            if let Some((sum, count)) = sums.get_mut(&a) {
                *sum += work.position(a).distance(work.position(b));
                *count += 1.0;
            }
        }
    }
    let means = sums.into_iter();
    means
        .map(|(vertex, (sum, count))| (vertex, sum / count))
        .collect()
}

/// Crossings of the faces of vertices that have moved.
fn crossings_near(work: &Work, moved: &BTreeMap<u32, Vec3>) -> Vec<[u32; 2]> {
    let faces = (0..).zip(&work.triangles);
    let faces: Vec<u32> = faces
        .filter(|(_, face)| face.iter().any(|corner| moved.contains_key(corner)))
        .map(|(face, _)| face)
        .collect();
    self_intersections_of(&work.positions(), &work.faces(), &faces)
}

/// Puts those vertices back that hang together with faces that cross.
fn put_back(work: &mut Work, pairs: &[[u32; 2]], start: &mut BTreeMap<u32, Vec3>) {
    let mut forest = Forest::new(work.vertices.len());
    for face in &work.triangles {
        for n in 0..3 {
            let [a, b] = [face[n], face[(n + 1) % 3]];
            if start.contains_key(&a) && start.contains_key(&b) {
                forest.unite(a, b);
            }
        }
    }
    let corners = pairs.iter().flatten();
    let corners = corners.flat_map(|&face| work.triangles[face as usize]);
    let stuck: BTreeSet<u32> = corners
        .filter(|corner| start.contains_key(corner))
        .map(|corner| forest.root(corner))
        .collect();
    start.retain(|&vertex, position| {
        let back = stuck.contains(&forest.root(vertex));
        if back {
            work.vertices[vertex as usize].position = *position;
        }
        !back
    });
}
