//! The faces near some vertices, so that what happens there need not look at the whole surface.

use std::collections::HashSet;

use glam::Vec3;
use neurotess_mesh::{Faces, self_intersections_of};
use rayon::prelude::*;

use crate::surface::work::Work;

/// Cells of space around some vertices, and all faces that reach into them.
pub(crate) struct Vicinity {
    /// Side of a cell (µm).
    side: f32,
    cells: HashSet<[i32; 3]>,
    /// In order.
    faces: Vec<u32>,
    /// By vertex: whether all its faces are among these.
    whole: Vec<bool>,
}

/// A face that reaches into more cells than this counts as one of the vicinity; there are few. A guard.
const MANY_CELLS: i32 = 64;

/// Cells along the largest face that is near.
const FINEST: f32 = 16.0;

impl Vicinity {
    /// The vicinity of those vertices for which `near` holds: as far as their faces reach, and once more.
    pub(crate) fn around(work: &Work, near: &[bool]) -> Self {
        let faces = work.triangles.par_iter();
        let boxes: Vec<[Vec3; 2]> = faces
            .filter(|face| face.iter().any(|&corner| near[corner as usize]))
            .map(|face| {
                let [low, high] = bounds(work, face);
                let reach = (high - low).max_element();
                [low - reach, high + reach]
            })
            .collect();
        let lengths = boxes.iter().map(|[low, high]| (*high - *low).max_element());
        let (sum, most) = lengths.fold((0.0, 0.0_f32), |(sum, most), length| {
            (sum + length, most.max(length))
        });
        let mean = sum / boxes.len().max(1) as f32;
        let side = mean.max(most / FINEST).max(f32::MIN_POSITIVE);
        let cells = boxes.into_iter().flat_map(|ends| cells_of(ends, side));
        let mut vicinity = Self {
            side,
            cells: cells.collect(),
            faces: Vec::new(),
            whole: vec![false; work.vertices.len()],
        };
        let all = 0..work.triangles.len() as u32;
        vicinity.faces = all
            .into_par_iter()
            .filter(|&face| vicinity.is_reached_by(work, &work.triangles[face as usize]))
            .collect();
        for &face in &vicinity.faces {
            for v in work.triangles[face as usize] {
                vicinity.whole[v as usize] = vicinity.holds(work.position(v));
            }
        }
        vicinity
    }

    /// Its faces, in order.
    pub(crate) fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// Whether all faces of a vertex are known.
    pub(crate) fn is_whole(&self, vertex: u32) -> bool {
        self.whole[vertex as usize]
    }

    /// Whether the faces of `vertices`, all of which are whole, lie within: then nothing else meets them.
    pub(crate) fn covers(&self, work: &Work, vertices: impl Fn(u32) -> bool) -> bool {
        self.faces.iter().all(|&face| {
            let corners = &work.triangles[face as usize];
            let moved = corners.iter().any(|&corner| vertices(corner));
            let mut cells = cells_of(bounds(work, corners), self.side);
            !moved || cells.all(|cell| self.cells.contains(&cell))
        })
    }

    /// Pairs of faces that cross, one of which has one of `vertices`.
    pub(crate) fn crossings(&self, work: &Work, vertices: impl Fn(u32) -> bool) -> Vec<[u32; 2]> {
        let corners = |&face: &u32| work.triangles[face as usize];
        let triangles: Vec<[u32; 3]> = self.faces.iter().map(corners).collect();
        let chosen: Vec<u32> = (0..)
            .zip(&triangles)
            .filter(|(_, corners)| corners.iter().any(|&corner| vertices(corner)))
            .map(|(at, _)| at)
            .collect();
        let faces = Faces {
            triangles,
            quads: Vec::new(),
        };
        let pairs = self_intersections_of(&work.positions(), &faces, &chosen);
        let pairs = pairs.into_iter();
        pairs
            .map(|pair| pair.map(|face| self.faces[face as usize]))
            .collect()
    }

    /// A set of vertices together with their neighbors.
    pub(crate) fn widened(&self, work: &Work, vertices: &[bool]) -> Vec<bool> {
        let mut wider = vertices.to_vec();
        for &face in &self.faces {
            let corners = work.triangles[face as usize];
            if corners.iter().any(|&corner| vertices[corner as usize]) {
                corners
                    .iter()
                    .for_each(|&corner| wider[corner as usize] = true);
            }
        }
        wider
    }

    fn holds(&self, position: Vec3) -> bool {
        self.cells.contains(&cell_of(position, self.side))
    }

    fn is_reached_by(&self, work: &Work, face: &[u32; 3]) -> bool {
        let ends = bounds(work, face);
        let [low, high] = ends.map(|end| cell_of(end, self.side));
        let counts = [0, 1, 2].map(|k| high[k].saturating_sub(low[k]).saturating_add(1));
        let many = counts.into_iter().fold(1, i32::saturating_mul) > MANY_CELLS;
        many || cells_of(ends, self.side).any(|cell| self.cells.contains(&cell))
    }
}

/// Lowest and highest coordinates of a face.
fn bounds(work: &Work, face: &[u32; 3]) -> [Vec3; 2] {
    let [a, b, c] = face.map(|corner| work.position(corner));
    [a.min(b).min(c), a.max(b).max(c)]
}

fn cell_of(position: Vec3, side: f32) -> [i32; 3] {
    (position / side).floor().as_ivec3().to_array()
}

/// The cells of a box.
fn cells_of(ends: [Vec3; 2], side: f32) -> impl Iterator<Item = [i32; 3]> {
    let [low, high] = ends.map(|end| cell_of(end, side));
    let [xs, ys, zs] = [0, 1, 2].map(|k: usize| low[k]..=high[k]);
    xs.flat_map(move |x| {
        let zs = zs.clone();
        ys.clone()
            .flat_map(move |y| zs.clone().map(move |z| [x, y, z]))
    })
}
