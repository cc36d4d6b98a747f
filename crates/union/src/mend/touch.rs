//! Sheets that touch without crossing: in a common vertex, along a common edge, or corner on face.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use crate::arrange::region::key;
use crate::surface::work::Work;

/// How far a vertex goes towards the middle of its own neighbors, try after try: of the way there, but at most
/// of the radius.
const SHARES: [f64; 3] = [0.05, 0.1, 0.15];

/// Moves vertices that are at one position apart, each a little towards the middle of its own neighbors. Only
/// where one of them is ours: what the input repeats stays. Returns how many were moved.
pub(crate) fn part(work: &mut Work) -> usize {
    let mut moved = HashSet::new();
    for share in SHARES {
        let pinched = pinched(work);
        if pinched.is_empty() {
            break;
        }
        for (vertex, around) in around(work, &pinched) {
            let at = work.position(vertex).as_dvec3();
            let radius = f64::from(work.vertices[vertex as usize].radius);
            let most = if radius > 0.0 { radius } else { f64::INFINITY };
            let to = at + share * (around.middle - at).clamp_length_max(most);
            work.vertices[vertex as usize].position = to.as_vec3();
            work.fresh[vertex as usize] = true;
        }
        moved.extend(pinched);
    }
    moved.len()
}

/// Vertices that triangles name and that share their position with one of ours, sorted.
fn pinched(work: &Work) -> Vec<u32> {
    let mut used = vec![false; work.vertices.len()];
    for &corner in work.triangles.iter().flatten() {
        used[corner as usize] = true;
    }
    let used = || (0..used.len() as u32).filter(|&v| used[v as usize]);
    let mut at: HashMap<[u32; 3], u32> = HashMap::new();
    for vertex in used().filter(|&v| work.fresh[v as usize]) {
        at.insert(key(work.position(vertex)), 0);
    }
    if at.is_empty() {
        return Vec::new();
    }
    for vertex in used() {
        if let Some(count) = at.get_mut(&key(work.position(vertex))) {
            *count += 1;
        }
    }
    used()
        .filter(|&v| {
            at.get(&key(work.position(v)))
                .is_some_and(|&count| count > 1)
        })
        .collect()
}

/// What lies around a vertex.
#[derive(Default)]
struct Around {
    /// The mean of its neighbors.
    middle: DVec3,
    /// Outwards, of the length of twice the area.
    normal: DVec3,
    /// The mean distance to its neighbors.
    reach: f64,
}

/// What lies around each of some vertices, in their order.
fn around(work: &Work, vertices: &[u32]) -> Vec<(u32, Around)> {
    let row: HashMap<u32, usize> = vertices.iter().copied().zip(0..).collect();
    let mut found: Vec<(Around, f64)> = vertices.iter().map(|_| Default::default()).collect();
    for (face, corners) in (0..).zip(&work.triangles) {
        for (n, corner) in corners.iter().enumerate() {
            if let Some(&row) = row.get(corner) {
                let points = work.corners(face);
                let [at, a, b] = [points[n], points[(n + 1) % 3], points[(n + 2) % 3]];
                let (sum, count) = &mut found[row];
                sum.middle += a + b;
                sum.normal += (a - at).cross(b - at);
                sum.reach += at.distance(a) + at.distance(b);
                *count += 2.0;
            }
        }
    }
    let mean = |(sum, count): (Around, f64)| Around {
        middle: sum.middle / count,
        normal: sum.normal,
        reach: sum.reach / count,
    };
    vertices
        .iter()
        .copied()
        .zip(found.into_iter().map(mean))
        .collect()
}

/// Of the radius and of the mean distance to its neighbors, how far a vertex is pressed in; by eye.
const PRESS: f64 = 1e-3;

/// Where faces touch without crossing there is nothing to cut: their corners are pressed in a little. `pairs`
/// are the faces that still meet, `before` what [`faces`] was before the cut. Returns how many vertices were
/// moved.
pub(crate) fn press(work: &mut Work, pairs: &[[u32; 2]], before: &HashSet<FaceKey>) -> usize {
    let uncut = |face: &u32| before.contains(&face_key(work, *face));
    let stuck = pairs.iter().filter(|pair| pair.iter().all(uncut));
    let faces: Vec<u32> = stuck.flatten().copied().collect();
    press_corners(work, &faces, 1.0)
}

/// Presses the corners of all faces that meet in, `times` as far: sheets nearer to one another than 32 bits
/// tell apart cross anew whenever they are cut and rounded.
pub(crate) fn press_all(work: &mut Work, pairs: &[[u32; 2]], times: f64) -> usize {
    let faces: Vec<u32> = pairs.iter().flatten().copied().collect();
    press_corners(work, &faces, times)
}

fn press_corners(work: &mut Work, faces: &[u32], times: f64) -> usize {
    let corners = faces.iter().flat_map(|&face| work.triangles[face as usize]);
    let mut vertices: Vec<u32> = corners.collect();
    vertices.sort_unstable();
    vertices.dedup();
    for (vertex, around) in around(work, &vertices) {
        let at = work.position(vertex);
        let radius = f64::from(work.vertices[vertex as usize].radius);
        let reach = if radius > 0.0 {
            around.reach.min(radius)
        } else {
            around.reach
        };
        // At least some steps of what 32 bits tell apart.
        let least = 8.0 * f64::from(f32::EPSILON * at.abs().max_element());
        let by = times * (PRESS * reach).max(least);
        let inwards = -around.normal.try_normalize().unwrap_or_default();
        work.vertices[vertex as usize].position = (at.as_dvec3() + by * inwards).as_vec3();
        work.fresh[vertex as usize] = true;
    }
    vertices.len()
}

/// A face by its corners' positions.
pub(crate) type FaceKey = [[u32; 3]; 3];

/// Faces of pairs by their positions.
pub(crate) fn faces(work: &Work, pairs: &[[u32; 2]]) -> HashSet<FaceKey> {
    pairs
        .iter()
        .flatten()
        .map(|&face| face_key(work, face))
        .collect()
}

fn face_key(work: &Work, face: u32) -> FaceKey {
    let mut key = work.triangles[face as usize].map(|corner| key(work.position(corner)));
    key.sort_unstable();
    key
}
