//! What a body left on the surface becomes part of it: no knob, and no needles.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};

use crate::mend::smooth::relaxed;
use crate::mend::tidy::tidy;
use crate::surface::stars::normal;
use crate::surface::work::Work;

/// Steps of smoothing, the most that makes nothing cross and nothing fold. Forty make a cap over a hole about as
/// flat as it can be.
const STEPS: [usize; 3] = [40, 15, 5];

/// How far vertices go to the middle of their neighbors in each step.
const SHARE: f64 = 0.5;

/// Cosine of the angle between faces that are folded onto one another: 155°.
const FOLDED: f64 = -0.9;

/// Tidies the faces at the vertices from `first` on, and flattens what they make, where that crosses nothing.
pub(super) fn blend(work: Work, first: u32, needles: f64) -> Work {
    let mut tidied = work.clone();
    if needles > 0.0 {
        tidy(&mut tidied, needles);
    }
    let work = match tidied.crossings_of_changed().is_empty() {
        true => tidied,
        false => work,
    };
    let faces: Vec<u32> = (0..work.triangles.len() as u32)
        .filter(|&face| work.triangles[face as usize].iter().any(|&v| v >= first))
        .collect();
    let mut ours: Vec<u32> = faces
        .iter()
        .flat_map(|&face| work.triangles[face as usize])
        .filter(|&vertex| vertex >= first)
        .collect();
    ours.sort_unstable();
    ours.dedup();
    let before: Vec<(u32, Vec3)> = ours.iter().map(|&v| (v, work.position(v))).collect();
    let folds = folds(&work, &faces);
    for steps in STEPS {
        let mut smoothed = work.clone();
        for (vertex, position) in relaxed(&work, &before, &faces, SHARE, steps) {
            smoothed.vertices[vertex as usize].position = position;
        }
        let fair = self::folds(&smoothed, &faces) <= folds;
        if fair && smoothed.crossings_of_changed().is_empty() {
            return smoothed;
        }
    }
    work
}

/// Edges between two of some faces that are folded onto one another.
fn folds(work: &Work, faces: &[u32]) -> usize {
    let mut normals: BTreeMap<[u32; 2], DVec3> = BTreeMap::new();
    let mut folds = 0;
    for &face in faces {
        let corners = work.triangles[face as usize];
        let normal = normal(&work.corners(face)).normalize_or_zero();
        for n in 0..3 {
            let [a, b] = [corners[n], corners[(n + 1) % 3]];
            match normals.get(&[a.min(b), a.max(b)]) {
                Some(other) => folds += usize::from(other.dot(normal) < FOLDED),
                None => drop(normals.insert([a.min(b), a.max(b)], normal)),
            }
        }
    }
    folds
}
