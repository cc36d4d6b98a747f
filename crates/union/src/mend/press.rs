//! Surfaces that cross a little are pressed in, instead of growing together.
//!
//! Where two branches cross, their union has a handle if they hang together elsewhere, too: for voltage and
//! diffusion a short circuit. If they cross by less than a share of their radii, both become thinner there, step
//! by step, each towards its own inside, with their surroundings half and a quarter as far. Places that still
//! cross when no vertex may go farther are put back, and merged.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use neurotess_mesh::Forest;

use crate::surface::vicinity::Vicinity;
use crate::surface::work::Work;

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
    let near = work.widened(corners_of(work, pairs), RINGS);
    let mut pressed = Pressing {
        vicinity: Vicinity::around(work, &near),
        work,
        start: BTreeMap::new(),
    };
    let mut left = pairs.to_vec();
    for _ in 0..STEPS {
        if left.is_empty() {
            break;
        }
        pressed.step(&left, most);
        left = pressed.crossings();
    }
    while !left.is_empty() {
        // What is put back may meet what is not, so it is searched again.
        pressed.put_back(&left);
        left = pressed.crossings();
    }
    let Pressing { start, .. } = pressed;
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

/// Which vertices are corners of some pairs of faces.
fn corners_of(work: &Work, pairs: &[[u32; 2]]) -> Vec<bool> {
    let mut corners = vec![false; work.vertices.len()];
    for &face in pairs.iter().flatten() {
        for corner in work.triangles[face as usize] {
            corners[corner as usize] = true;
        }
    }
    corners
}

/// A surface that is pressed in.
struct Pressing<'w> {
    work: &'w mut Work,
    /// Where vertices were that have moved.
    start: BTreeMap<u32, Vec3>,
    vicinity: Vicinity,
}

impl Pressing<'_> {
    /// Moves the corners of faces that cross, and what is around them, one step.
    fn step(&mut self, pairs: &[[u32; 2]], most: f64) {
        let shares = self.shares(pairs);
        let reach = self.reach(&shares);
        for (vertex, share) in shares {
            let before = self.work.vertices[vertex as usize];
            let first = *self.start.entry(vertex).or_insert(before.position);
            let farthest = most as f32 * before.radius.min(reach[&vertex]);
            let by = share * farthest / STEPS as f32;
            let way = before.position - by * before.normal - first;
            let position = first + way.clamp_length_max(farthest);
            self.work.vertices[vertex as usize].position = position;
        }
    }

    /// The vertices that move, and by which share of a step.
    fn shares(&mut self, pairs: &[[u32; 2]]) -> BTreeMap<u32, f32> {
        loop {
            let mut near = corners_of(self.work, pairs);
            let mut shares: BTreeMap<u32, f32> = BTreeMap::new();
            let mut share = 1.0;
            for ring in 0..=RINGS {
                for vertex in (0..).zip(&near).filter(|(_, near)| **near).map(|(v, _)| v) {
                    shares.entry(vertex).or_insert(share);
                }
                share *= 0.5;
                if ring < RINGS {
                    near = self.vicinity.widened(self.work, &near);
                }
            }
            if shares.keys().all(|&vertex| self.vicinity.is_whole(vertex)) {
                return shares;
            }
            self.look_around(near);
        }
    }

    /// Mean distance of vertices to their neighbors.
    fn reach(&self, of: &BTreeMap<u32, f32>) -> BTreeMap<u32, f32> {
        let mut sums: BTreeMap<u32, (f32, f32)> =
            of.keys().map(|&vertex| (vertex, (0.0, 0.0))).collect();
        for &face in self.vicinity.faces() {
            let face = self.work.triangles[face as usize];
            for n in 0..3 {
                let [a, b] = [face[n], face[(n + 1) % 3]];
                if let Some((sum, count)) = sums.get_mut(&a) {
                    *sum += self.work.position(a).distance(self.work.position(b));
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
    fn crossings(&mut self) -> Vec<[u32; 2]> {
        let moved = |start: &BTreeMap<u32, Vec3>, vertex: u32| start.contains_key(&vertex);
        let start = &self.start;
        if !self.vicinity.covers(self.work, |v| moved(start, v)) {
            self.look_around(vec![false; self.work.vertices.len()]);
        }
        let start = &self.start;
        self.vicinity.crossings(self.work, |v| moved(start, v))
    }

    /// Makes the vicinity that of some vertices and of all that have moved.
    fn look_around(&mut self, mut near: Vec<bool>) {
        for &vertex in self.start.keys() {
            near[vertex as usize] = true;
        }
        self.vicinity = Vicinity::around(self.work, &near);
    }

    /// Puts those vertices back that hang together with faces that cross.
    fn put_back(&mut self, pairs: &[[u32; 2]]) {
        let Self {
            work,
            start,
            vicinity,
        } = self;
        let mut forest = Forest::new(work.vertices.len());
        for &face in vicinity.faces() {
            let face = work.triangles[face as usize];
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
}
