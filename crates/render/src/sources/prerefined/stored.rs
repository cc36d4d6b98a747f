//! What the shader reads: vertices, corners, and where an instance is.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use neurotess_mesh::{Role, SurfaceVertex};
use neurotess_refine::wgsl::ShaderParts;

use super::PrerefinedSurface;
use crate::gpu::buffers::{storage, uniform};
use crate::gpu::shader;
use neurotess_picture::octahedral::pack_normal;

/// Twin of `StoredVertex` in `prerefined.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct StoredVertex {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    /// 0 on somata.
    pub(crate) radius: f32,
    pub(crate) normal: u32,
    pub(crate) color_key: u32,
}

impl StoredVertex {
    /// Stores a vertex whose number of a sample is the index of its tracing point.
    pub(super) fn new(vertex: &SurfaceVertex, source: &PrerefinedSurface<'_>) -> Self {
        let tracing = vertex.point as usize;
        let soma = source.mesh.tracing[tracing].role == Role::Soma;
        Self {
            x: vertex.position.x,
            y: vertex.position.y,
            z: vertex.position.z,
            radius: if soma { 0.0 } else { vertex.radius },
            normal: pack_normal(vertex.normal),
            color_key: source.color_keys.get(tracing).copied().unwrap_or(0),
        }
    }

    pub(super) fn position(&self) -> Vec3 {
        Vec3::new(self.x, self.y, self.z)
    }
}

/// Twin of `Placement` in `prerefined.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Placement {
    pub(crate) relative_from_mesh: [f32; 3],
    pub(crate) instance: u32,
}

/// Defines `surface_vertex`. `barycentric`: no two triangles share corners.
pub(crate) fn vertex_shader(barycentric: bool) -> ShaderParts {
    let mut parts = ShaderParts::new(&[shader::file("prerefined.wgsl")]);
    parts.constants.bool("BARYCENTRIC", barycentric);
    parts
}

/// Group 0: vertices, corners, and the placement of an instance.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let vertex = wgpu::ShaderStages::VERTEX;
    vec![
        storage(0, vertex, true),
        storage(1, vertex, true),
        uniform(2, vertex, true),
    ]
}
