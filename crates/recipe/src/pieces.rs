//! The pieces of a mesh for simulators, which solvers take for bodies of their own.

use neurotess_mesh::SurfaceMesh;

/// The sample of the first vertex of each piece, in their order.
pub(crate) fn samples(mesh: &SurfaceMesh) -> Vec<i32> {
    let mut piece: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut is_used = vec![false; piece.len()];
    for corners in &mesh.faces.triangles {
        let [a, b, c] = corners.map(|corner| {
            is_used[corner as usize] = true;
            first(&mut piece, corner)
        });
        let least = a.min(b).min(c);
        for corner in [a, b, c] {
            piece[corner as usize] = least;
        }
    }
    (0..piece.len() as u32)
        .filter(|&vertex| is_used[vertex as usize] && piece[vertex as usize] == vertex)
        .map(|vertex| mesh.vertices[vertex as usize].point)
        .collect()
}

/// The least vertex that is known to be of the same piece; shortens the way there.
fn first(piece: &mut [u32], vertex: u32) -> u32 {
    let mut vertex = vertex;
    while piece[vertex as usize] != vertex {
        let next = piece[vertex as usize];
        piece[vertex as usize] = piece[next as usize];
        vertex = next;
    }
    vertex
}

#[cfg(test)]
mod tests {
    use neurotess_mesh::{Faces, SurfaceVertex};

    use super::*;

    #[test]
    fn each_piece_is_named_once() {
        let vertex = |point: i32| SurfaceVertex {
            point,
            ..SurfaceVertex::default()
        };
        let mut mesh = SurfaceMesh {
            vertices: [7, 7, 9, 9, 4, 4, 4].map(vertex).into(),
            faces: Faces {
                triangles: vec![[2, 3, 0], [5, 6, 4], [1, 0, 3]],
                quads: Vec::new(),
            },
            ..SurfaceMesh::default()
        };
        assert_eq!(samples(&mesh), [7, 4]);
        mesh.faces.triangles.push([6, 0, 1]);
        assert_eq!(samples(&mesh), [7]);
    }
}
