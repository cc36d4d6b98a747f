//! Normals of the vertices of somata and joints.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Role, Vertex};

/// Normals of joints' and somata's vertices: the mean of their faces', by area. At the first ring of a neurite on
/// its soma they are the tube's: the soma runs smoothly into it.
pub(crate) fn average_normals(mesh: &mut CoarseMesh) {
    let averaged = |vertex: &Vertex| {
        let role = mesh.tracing[vertex.tracing as usize].role;
        matches!(role, Role::Joint | Role::Soma | Role::Insertion)
    };
    let averaged: Vec<bool> = mesh.vertices.iter().map(averaged).collect();
    let mut sums = vec![Vec3::ZERO; mesh.vertices.len()];
    for patch in &mesh.patches {
        if !patch.corners.iter().any(|&v| averaged[v as usize]) {
            continue; // nearly all
        }
        let [a, b, c, d] = patch.corners.map(|v| mesh.vertices[v as usize].position);
        let normal = (c - a).cross(d - b);
        for v in patch.corners {
            sums[v as usize] += normal;
        }
    }
    for (v, &sum) in sums.iter().enumerate() {
        if averaged[v] {
            let vertex = &mut mesh.vertices[v];
            let center = mesh.tracing[vertex.tracing as usize].center;
            let outwards = (vertex.position - center).normalize_or(Vec3::Y);
            let tracing = &mut mesh.tracing[vertex.tracing as usize];
            vertex.normal = match tracing.role {
                Role::Insertion => outwards,
                _ => sum.normalize_or(outwards),
            };
            if tracing.role == Role::Soma {
                tracing.tangent = vertex.normal;
            }
        }
    }
}
