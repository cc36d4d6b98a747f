//! Triangles that a solver likes: no narrow ones, as far as the surface allows.
//!
//! Cells that were split along the worse diagonal get the other one first. Where an angle is small, three things are tried, and the one after which the smallest angle nearby is
//! largest is done: an edge is given to the two corners across it, the shortest edge is collapsed, or a corner
//! moves along the surface towards the middle of its neighbors (L. Freitag, C. Ollivier-Gooch, Tetrahedral Mesh
//! Improvement Using Swapping and Smoothing, 1997, for volumes). No face turns by more than a bound, and no
//! vertex goes far from where it was, so that the surface stays what it is. What then crosses is pressed in, or left as it
//! was.

use glam::Vec3;
use rayon::prelude::*;

use crate::mend::press::press_in;
use crate::solver::diagonals::choose_diagonals;
use crate::solver::edits::{Edit, Edits, sharpness};
use crate::surface::stars::Stars;
use crate::surface::work::Work;

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Improved {
    pub(crate) flipped: usize,
    pub(crate) collapsed: usize,
    pub(crate) moved: usize,
    /// Whether it was searched, and found, that no changed face crosses another.
    pub(crate) crosses_nothing: bool,
}

impl Improved {
    /// Edits of any kind.
    pub(crate) fn total(&self) -> usize {
        self.flipped + self.collapsed + self.moved
    }
}

/// Passes over narrow faces; the last ones find little. A guard.
const PASSES: usize = 8;

/// Edges from a narrow face to what may be edited; passes reach a little farther than one would.
const RINGS: usize = 3;

/// How often all is done again, without what crossed. A guard.
const TRIES: usize = 6;

/// What crosses afterwards is pressed in by up to this share of its radius, before all is done again.
const PRESS: f64 = 0.2;

/// Faces for which edits are looked for side by side. With more of them, more find that one before them has
/// changed their neighborhood, and are looked at again.
const BATCH: usize = 2048;

/// Makes angles below `least` (degrees) larger where that can be done; leaves no new crossing.
pub(crate) fn improve(work: &mut Work, least: f64) -> Improved {
    let goal = least.to_radians().sin();
    let mut fixed = vec![false; work.vertices.len()];
    for rings in 0..TRIES {
        let mut tried = work.clone();
        choose_diagonals(&mut tried, &fixed);
        let mut done = passes(&mut tried, goal, &fixed);
        let mut crossing = tried.crossings_of_changed();
        let mut near = vec![false; work.vertices.len()];
        for &face in crossing.iter().flatten() {
            for corner in tried.triangles[face as usize] {
                near[corner as usize] = true;
            }
        }
        if !crossing.is_empty() {
            crossing = press_in(&mut tried, &crossing, PRESS).left;
        }
        if crossing.is_empty() {
            *work = tried;
            done.crosses_nothing = true;
            return done;
        }
        let near = work.widened(near, 1 + rings);
        for (fixed, near) in fixed.iter_mut().zip(near) {
            *fixed |= near;
        }
    }
    Improved::default()
}

fn passes(work: &mut Work, goal: f64, fixed: &[bool]) -> Improved {
    let first = work.positions();
    let mut region = Region::new(work, goal, fixed, &first);
    for _ in 0..PASSES {
        let narrow = region.narrow();
        region.changed.clear();
        for batch in narrow.chunks(BATCH) {
            region.widen(batch);
        }
        if region.changed.is_empty() {
            break;
        }
        region.faces = region.near_changes();
    }
    region.stars.finish();
    region.done
}

/// Narrow faces and what is around them.
struct Region<'a> {
    stars: Stars<'a>,
    /// Faces that may be narrow, in order.
    faces: Vec<u32>,
    goal: f64,
    fixed: &'a [bool],
    /// Where vertices were before anything was moved.
    first: &'a [Vec3],
    /// For each vertex the number of the batch that last moved it or changed its faces; none: 0.
    batches: Vec<u32>,
    batch: u32,
    /// Vertices that were changed in this pass.
    changed: Vec<u32>,
    done: Improved,
}

impl<'a> Region<'a> {
    fn new(work: &'a mut Work, goal: f64, fixed: &'a [bool], first: &'a [Vec3]) -> Self {
        let count = work.vertices.len();
        let mut near = vec![false; count];
        let all = 0..work.triangles.len() as u32;
        let narrow: Vec<u32> = all
            .into_par_iter()
            .filter(|&face| sharpness(&work.corners(face)) < goal)
            .collect();
        for &face in &narrow {
            for corner in work.triangles[face as usize] {
                near[corner as usize] = true;
            }
        }
        let known = work.widened(near, RINGS);
        Self {
            faces: narrow,
            stars: Stars::new(work, |vertex| known[vertex as usize]),
            goal,
            fixed,
            first,
            batches: vec![0; count],
            batch: 0,
            changed: Vec::new(),
            done: Improved::default(),
        }
    }

    /// The faces with a small angle, the narrowest first.
    fn narrow(&self) -> Vec<u32> {
        let faces = self.faces.par_iter();
        let mut narrow: Vec<(f64, u32)> = faces
            .filter(|&&face| !self.stars.is_dead(face))
            .map(|&face| (sharpness(&self.stars.work.corners(face)), face))
            .filter(|&(sharpness, _)| sharpness < self.goal)
            .collect();
        narrow.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        narrow.into_iter().map(|(_, face)| face).collect()
    }

    /// Does the best edit for each of some narrow faces, one after the other. All are looked for at once; what an
    /// edit changes is looked at again.
    fn widen(&mut self, faces: &[u32]) {
        self.batch += 1;
        let edits: Vec<Option<Edit>> = faces.par_iter().map(|&face| self.best(face)).collect();
        for (&face, edit) in faces.iter().zip(edits) {
            let edit = match self.is_changed(face) {
                true => self.best(face),
                false => edit,
            };
            if let Some(edit) = edit {
                self.apply(face, edit);
            }
        }
    }

    /// The best edit for a face, if it is narrow.
    fn best(&self, face: u32) -> Option<Edit> {
        if self.stars.is_dead(face) || sharpness(&self.stars.work.corners(face)) >= self.goal {
            return None;
        }
        let edits = Edits {
            stars: &self.stars,
            fixed: self.fixed,
            first: self.first,
        };
        edits.best(face)
    }

    /// Whether this batch has changed anything that the best edit for a face depends on.
    fn is_changed(&self, face: u32) -> bool {
        let of_batch = |corner: &u32| self.batches[*corner as usize] == self.batch;
        let corners = self.stars.work.triangles[face as usize];
        self.stars.is_dead(face)
            || corners.iter().any(|&corner| {
                let star = self.stars.of(corner).unwrap_or_default();
                let around = star
                    .iter()
                    .map(|&face| self.stars.work.triangles[face as usize]);
                of_batch(&corner) || around.flatten().any(|corner| of_batch(&corner))
            })
    }

    fn apply(&mut self, face: u32, edit: Edit) {
        match edit {
            Edit::Flip(side) => {
                let corners = self.stars.work.triangles[face as usize];
                let across = self
                    .stars
                    .across(face, corners[side], corners[(side + 1) % 3]);
                if self.stars.flip(face, side, |_, _, _| true) {
                    self.note(&corners);
                    self.note(&[across.map_or(corners[0], |(_, far)| far)]);
                    self.done.flipped += 1;
                }
            }
            Edit::Collapse(from, to, vertex) => {
                let star = self.stars.of(from).unwrap_or_default();
                let around = star
                    .iter()
                    .map(|&face| self.stars.work.triangles[face as usize]);
                let around: Vec<u32> = around.flatten().collect();
                if self.stars.collapse(from, to, |_, _| Some(vertex)) {
                    self.note(&around);
                    self.stars.work.fresh[to as usize] = true;
                    self.done.collapsed += 1;
                }
            }
            Edit::Move(vertex, to) => {
                self.stars.work.vertices[vertex as usize].position = to.as_vec3();
                self.stars.work.fresh[vertex as usize] = true;
                self.note(&[vertex]);
                self.done.moved += 1;
            }
        }
    }

    /// Notes vertices whose place or faces have changed.
    fn note(&mut self, vertices: &[u32]) {
        for &vertex in vertices {
            self.batches[vertex as usize] = self.batch;
            self.changed.push(vertex);
        }
    }

    /// Faces for which there may be another best edit after those of this pass, in order: those that are at most one
    /// edge away from a change.
    fn near_changes(&self) -> Vec<u32> {
        let triangles = &self.stars.work.triangles;
        let mut near = vec![false; self.batches.len()];
        for &vertex in &self.changed {
            near[vertex as usize] = true;
        }
        let around = self.faces_of(&near);
        for &corner in around.iter().flat_map(|&face| &triangles[face as usize]) {
            near[corner as usize] = true;
        }
        self.faces_of(&near)
    }

    /// Faces around those of some vertices whose faces are known, in order.
    fn faces_of(&self, vertices: &[bool]) -> Vec<u32> {
        let triangles = &self.stars.work.triangles;
        let is_one = |&corner: &u32| vertices[corner as usize] && self.stars.of(corner).is_some();
        let faces = 0..triangles.len() as u32;
        faces
            .into_par_iter()
            .filter(|&face| !self.stars.is_dead(face))
            .filter(|&face| triangles[face as usize].iter().any(is_one))
            .collect()
    }
}
