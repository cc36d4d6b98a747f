//! Which faces the arrangement is given: those that cross others, and rings of neighbors around them.

use std::collections::HashSet;

use glam::Vec3;

use crate::surface::work::Work;

/// Faces around crossings.
pub(crate) struct Region {
    /// In order.
    pub(crate) faces: Vec<u32>,
    /// For each face of the region, whether it crosses another.
    pub(crate) crossing: Vec<bool>,
    /// For each face of the surface, whether it is in the region.
    pub(crate) has: Vec<bool>,
}

/// The faces of `pairs` and `rings` rings of neighbors. Neighbors are told by position, so that sheets that
/// merely touch come along.
pub(crate) fn around(work: &Work, pairs: &[[u32; 2]], rings: u32) -> Region {
    let crossing = crossing(work, pairs);
    let mut has = crossing.clone();
    for _ in 0..rings {
        let inner: HashSet<[u32; 3]> = work
            .triangles
            .iter()
            .zip(&has)
            .filter(|&(_, &has)| has)
            .flat_map(|(face, _)| face.map(|corner| key(work.position(corner))))
            .collect();
        let near: Vec<bool> = work
            .vertices
            .iter()
            .map(|vertex| inner.contains(&key(vertex.position)))
            .collect();
        for (face, has) in work.triangles.iter().zip(&mut has) {
            *has |= face.iter().any(|&corner| near[corner as usize]);
        }
    }
    region(&crossing, has)
}

/// All faces.
pub(crate) fn everything(work: &Work, pairs: &[[u32; 2]]) -> Region {
    region(&crossing(work, pairs), vec![true; work.triangles.len()])
}

/// For each face whether it is of one of the pairs.
fn crossing(work: &Work, pairs: &[[u32; 2]]) -> Vec<bool> {
    let mut crossing = vec![false; work.triangles.len()];
    for &face in pairs.iter().flatten() {
        crossing[face as usize] = true;
    }
    crossing
}

fn region(crossing: &[bool], has: Vec<bool>) -> Region {
    let faces: Vec<u32> = (0..has.len() as u32).filter(|&n| has[n as usize]).collect();
    let crossing = faces.iter().map(|&face| crossing[face as usize]).collect();
    Region {
        faces,
        crossing,
        has,
    }
}

/// A position as a key; −0 is 0.
pub(crate) fn key(position: Vec3) -> [u32; 3] {
    position.to_array().map(|x| (x + 0.0).to_bits())
}
