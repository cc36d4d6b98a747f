//! Seams are sharp creases between exactly flat pieces, at which tetrahedra fail. Their vertices go a little
//! towards the middle of their neighbors, where that makes no crossing.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use neurotess_mesh::self_intersections_of;

use crate::surface::work::Work;

/// Steps of smoothing.
const STEPS: usize = 3;

/// How often vertices near what has gone wrong are put back before all are. A guard.
const TRIES: usize = 5;

/// Moves vertices that cuts made by `share` of the way to the middle of their neighbors, a few times. Where
/// faces then cross or turn over, vertices go back. Returns how many were moved.
pub(crate) fn smooth(work: &mut Work, share: f64) -> usize {
    let mut ours = vec![false; work.vertices.len()];
    for &corner in work.triangles.iter().flatten() {
        ours[corner as usize] = work.seam[corner as usize];
    }
    let before: Vec<(u32, Vec3)> = (0..)
        .zip(&work.vertices)
        .filter(|&(v, _)| ours[v as usize])
        .map(|(v, vertex)| (v, vertex.position))
        .collect();
    if before.is_empty() || share <= 0.0 {
        return 0;
    }
    let faces: Vec<u32> = (0..work.triangles.len() as u32)
        .filter(|&face| {
            work.triangles[face as usize]
                .iter()
                .any(|&corner| ours[corner as usize])
        })
        .collect();
    let normals: Vec<DVec3> = faces.iter().map(|&face| normal(work, face)).collect();
    for (vertex, position) in relaxed(work, &before, &faces, share, STEPS) {
        work.vertices[vertex as usize].position = position;
    }
    for try_ in 0..=TRIES {
        let wrong = wrong(work, &faces, &normals);
        if wrong.is_empty() {
            break;
        }
        put_back(work, &before, &wrong, try_);
    }
    let moved = |&&(vertex, position): &&(u32, Vec3)| work.position(vertex) != position;
    before.iter().filter(moved).count()
}

/// Where vertices go in some steps to the middle of their neighbors. `faces` are all that have one of them.
pub(crate) fn relaxed(
    work: &Work,
    ours: &[(u32, Vec3)],
    faces: &[u32],
    share: f64,
    steps: usize,
) -> Vec<(u32, Vec3)> {
    let row: HashMap<u32, usize> = ours.iter().map(|&(vertex, _)| vertex).zip(0..).collect();
    let mut at: Vec<DVec3> = ours
        .iter()
        .map(|(_, position)| position.as_dvec3())
        .collect();
    for _ in 0..steps {
        let mut sums = vec![(DVec3::ZERO, 0.0); at.len()];
        for &face in faces {
            let corners = work.triangles[face as usize];
            for n in 0..3 {
                // Around a closed fan each neighbor comes next once.
                let next = corners[(n + 1) % 3];
                if let Some(&sum) = row.get(&corners[n]) {
                    let own = || work.position(next).as_dvec3();
                    sums[sum].0 += row.get(&next).map_or_else(own, |&next| at[next]);
                    sums[sum].1 += 1.0;
                }
            }
        }
        for (at, (sum, count)) in at.iter_mut().zip(sums) {
            *at += share * (sum / count - *at);
        }
    }
    let vertices = ours.iter().map(|&(vertex, _)| vertex);
    vertices.zip(at.into_iter().map(DVec3::as_vec3)).collect()
}

/// Faces that cross others, or that have turned by more than a right angle.
fn wrong(work: &Work, faces: &[u32], normals: &[DVec3]) -> Vec<u32> {
    let pairs = self_intersections_of(&work.positions(), &work.faces(), faces);
    let turned = faces
        .iter()
        .zip(normals)
        .filter(|(face, before)| normal(work, **face).dot(**before) < 0.0)
        .map(|(&face, _)| face);
    pairs.into_iter().flatten().chain(turned).collect()
}

/// Puts vertices of faces back, and with each try those of one more ring; at last all.
fn put_back(work: &mut Work, before: &[(u32, Vec3)], faces: &[u32], rings: usize) {
    let all = rings >= TRIES;
    let mut near = vec![all; work.vertices.len()];
    for &face in faces {
        work.triangles[face as usize]
            .iter()
            .for_each(|&corner| near[corner as usize] = true);
    }
    let near = work.widened(near, rings.min(TRIES - 1));
    for &(vertex, position) in before {
        if near[vertex as usize] {
            work.vertices[vertex as usize].position = position;
        }
    }
}

fn normal(work: &Work, face: u32) -> DVec3 {
    let [a, b, c] = work.corners(face);
    (b - a).cross(c - a)
}

/// Gives the vertices that are ours the normals of their faces, weighted by area.
pub(crate) fn renew_normals(work: &mut Work) {
    let mut sums = vec![DVec3::ZERO; work.vertices.len()];
    for face in 0..work.triangles.len() as u32 {
        let corners = work.triangles[face as usize];
        if work.is_fresh(&corners) {
            let normal = normal(work, face);
            corners
                .iter()
                .for_each(|&corner| sums[corner as usize] += normal);
        }
    }
    for ((vertex, &fresh), sum) in work.vertices.iter_mut().zip(&work.fresh).zip(sums) {
        if fresh && let Some(normal) = sum.try_normalize() {
            vertex.normal = normal.as_vec3();
        }
    }
}
