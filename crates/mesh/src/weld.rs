//! Vertices at the same position.

use glam::Vec3;
use rayon::prelude::*;

use crate::SurfaceMesh;

/// For every vertex, the first vertex at the same position, bit for bit (−0 is 0).
pub(crate) fn first_alike(positions: &[Vec3]) -> Vec<u32> {
    let mut sorted: Vec<([u32; 3], u32)> = positions
        .par_iter()
        .enumerate()
        .map(|(n, position)| (position.to_array().map(|x| (x + 0.0).to_bits()), n as u32))
        .collect();
    sorted.par_sort_unstable();
    let mut first = vec![0; positions.len()];
    for alike in sorted.chunk_by(|a, b| a.0 == b.0) {
        for &(_, n) in alike {
            first[n as usize] = alike[0].1;
        }
    }
    first
}

/// Makes one vertex of all that have identical positions: the first, with its attributes. STL files
/// need it. Faces stay, even those that collapse. Returns how many vertices went.
pub fn merge_identical(mesh: &mut SurfaceMesh) -> usize {
    let first = first_alike(&mesh.positions());
    let mut new = vec![0u32; first.len()];
    let mut kept = 0;
    for (n, &first) in first.iter().enumerate() {
        if first as usize == n {
            new[n] = kept as u32;
            mesh.vertices[kept] = mesh.vertices[n];
            kept += 1;
        } else {
            new[n] = new[first as usize];
        }
    }
    mesh.vertices.truncate(kept);
    let corners = mesh.faces.triangles.iter_mut().flatten();
    for corner in corners.chain(mesh.faces.quads.iter_mut().flatten()) {
        *corner = new[*corner as usize];
    }
    first.len() - kept
}
