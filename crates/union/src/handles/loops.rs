//! Where holes may be: seams, and short loops through them that bound a disk outside the solid.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec3;
use neurotess_mesh::Forest;
use rayon::prelude::*;

use super::patch::{Loop, Patch};
use crate::arrange::winding::{Query, windings};
use crate::surface::work::Work;

/// Most vertices of a seam through which loops are looked for. A guard.
const STARTS: usize = 48;

/// Most loops of a seam that are told. A guard.
const LOOPS: usize = 12;

/// Vertices that cuts made, by what hangs together.
pub(super) fn seams(work: &Work) -> Vec<Vec<u32>> {
    let mut forest = Forest::new(work.vertices.len());
    let mut named = vec![false; work.vertices.len()];
    for face in &work.triangles {
        for n in 0..3 {
            let [a, b] = [face[n], face[(n + 1) % 3]];
            named[a as usize] = work.seam[a as usize];
            if work.seam[a as usize] && work.seam[b as usize] {
                forest.unite(a, b);
            }
        }
    }
    let mut seams: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for vertex in (0..work.vertices.len() as u32).filter(|&v| named[v as usize]) {
        seams.entry(forest.root(vertex)).or_default().push(vertex);
    }
    seams.into_values().collect()
}

/// Loops through a seam that bound a disk outside the solid, the shortest first. None is longer than `girth`
/// circumferences of the branch where that is thinnest on the loop.
pub(super) fn tunnels(work: &Work, seam: &[u32], girth: f64) -> Vec<Loop> {
    // A loop is as thin as the vertex of the seam that it passes, or thinner.
    let reach = |vertex: u32| girth * TAU * radius(work, vertex) / 2.0;
    let farthest = seam.iter().map(|&v| reach(v)).fold(0.0, f64::max);
    let patch = Patch::new(work, &faces_near(work, seam, farthest));
    if patch.handles() == 0 {
        return Vec::new();
    }
    let starts: Vec<u32> = seam
        .iter()
        .copied()
        .step_by(seam.len().div_ceil(STARTS))
        .collect();
    let is_short =
        |around: &Loop| around.length <= girth * TAU * least_radius(work, &around.vertices);
    let mut loops: Vec<Loop> = starts
        .par_iter()
        .flat_map_iter(|&start| patch.loops(start, reach(start)))
        .filter(is_short)
        .collect();
    loops.sort_by(|a, b| {
        let lengths = a.length.total_cmp(&b.length);
        lengths.then_with(|| a.vertices.cmp(&b.vertices))
    });
    loops.dedup_by(|a, b| sorted(a) == sorted(b));
    let outside = outside(work, &loops);
    let loops = loops.into_iter().zip(outside);
    let loops = loops.filter(|(_, outside)| *outside);
    loops.take(LOOPS).map(|(around, _)| around).collect()
}

fn sorted(around: &Loop) -> Vec<u32> {
    let mut vertices = around.vertices.clone();
    vertices.sort_unstable();
    vertices
}

fn radius(work: &Work, vertex: u32) -> f64 {
    f64::from(work.vertices[vertex as usize].radius)
}

pub(super) fn least_radius(work: &Work, vertices: &[u32]) -> f64 {
    let radii = vertices.iter().map(|&v| radius(work, v));
    radii.fold(f64::INFINITY, f64::min)
}

/// Faces wholly within `reach` of a box around vertices.
fn faces_near(work: &Work, vertices: &[u32], reach: f64) -> Vec<u32> {
    let points = || vertices.iter().map(|&v| work.position(v).as_dvec3());
    let low = points().fold(DVec3::INFINITY, DVec3::min) - reach;
    let high = points().fold(DVec3::NEG_INFINITY, DVec3::max) + reach;
    let is_near = |corner: &u32| {
        let at = work.position(*corner).as_dvec3();
        at.cmpge(low).all() && at.cmple(high).all()
    };
    let faces = (0..).zip(&work.triangles);
    faces
        .filter(|(_, face)| face.iter().all(is_near))
        .map(|(face, _)| face)
        .collect()
}

/// The mean of the vertices of a loop.
pub(super) fn middle(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

/// For each loop whether most of the disk between it and its middle is outside the solid.
fn outside(work: &Work, loops: &[Loop]) -> Vec<bool> {
    let disk = |around: &Loop| -> Vec<DVec3> {
        let points = around.points(work);
        let middle = middle(&points);
        let edges = points.iter().zip(points.iter().cycle().skip(1));
        let thirds = edges.map(|(&a, &b)| (a + b + middle) / 3.0);
        thirds.chain([middle]).collect()
    };
    let disks: Vec<Vec<DVec3>> = loops.iter().map(disk).collect();
    let query = |&point: &DVec3| Query {
        point,
        without: Vec::new(),
    };
    let queries: Vec<Query> = disks.iter().flatten().map(query).collect();
    let windings = windings(|face| work.corners(face), work.triangles.len(), &queries);
    let mut rest = windings.as_slice();
    let mut is_outside = |disk: &Vec<DVec3>| {
        let (own, others) = rest.split_at(disk.len());
        rest = others;
        2 * own.iter().filter(|&&winding| winding == 0).count() > own.len()
    };
    disks.iter().map(&mut is_outside).collect()
}
