//! Some patches of a mesh as a mesh of their own.

use neurotess_mesh::{CoarseMesh, Patch, Vertex};

/// Part of a mesh, and where its vertices and tracing points are in the whole.
pub(crate) struct Part {
    pub(crate) mesh: CoarseMesh,
    /// Numbers in the whole, ascending.
    pub(crate) vertices: Vec<u32>,
    /// Numbers in the whole, ascending.
    pub(crate) tracing: Vec<u32>,
}

impl Part {
    /// The part of these patches, in the mesh's order: edges run from the lower number.
    pub(crate) fn new(mesh: &CoarseMesh, mut patches: Vec<u32>) -> Self {
        patches.sort_unstable();
        patches.dedup();
        let corners = |&patch: &u32| mesh.patches[patch as usize].corners;
        let mut vertices: Vec<u32> = patches.iter().flat_map(corners).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let tracing_of = |v: u32| mesh.vertices[v as usize].tracing;
        let mut tracing: Vec<u32> = vertices.iter().map(|&v| tracing_of(v)).collect();
        tracing.sort_unstable();
        tracing.dedup();
        let number = |list: &[u32], of: u32| list.partition_point(|&x| x < of) as u32;
        let part = CoarseMesh {
            origin: mesh.origin,
            vertices: vertices
                .iter()
                .map(|&v| {
                    let vertex = mesh.vertices[v as usize];
                    let tracing = number(&tracing, vertex.tracing);
                    Vertex { tracing, ..vertex }
                })
                .collect(),
            tracing: tracing.iter().map(|&t| mesh.tracing[t as usize]).collect(),
            patches: patches
                .iter()
                .map(|&p| {
                    let patch = mesh.patches[p as usize];
                    let corners = patch.corners.map(|v| number(&vertices, v));
                    Patch { corners, ..patch }
                })
                .collect(),
        };
        Self {
            mesh: part,
            vertices,
            tracing,
        }
    }
}
