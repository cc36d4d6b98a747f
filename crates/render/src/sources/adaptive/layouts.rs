//! Which buffers the passes of a frame bind, and how.
//!
//! No pass binds more than eight storage buffers: so many every WebGPU device allows.

use wgpu::ShaderStages;

use crate::gpu::buffers::{group_layout, storage, uniform};

/// Layouts of the groups that work buffers are in.
#[derive(Debug)]
pub(crate) struct WorkLayouts {
    /// Group 1 of all compute passes.
    pub(crate) clusters: wgpu::BindGroupLayout,
    /// Group 2: one read-write buffer, two, or three.
    pub(crate) one: wgpu::BindGroupLayout,
    pub(crate) two: wgpu::BindGroupLayout,
    pub(crate) three: wgpu::BindGroupLayout,
    /// Group 0 of the shaders that compute vertices: binding 0 is a page's, those from 4 on are a
    /// frame's.
    pub(crate) drawing: wgpu::BindGroupLayout,
}

impl WorkLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self {
            clusters: group_layout(device, "clusters", &clusters_entries()),
            one: group_layout(device, "one buffer", &written_entries(1)),
            two: group_layout(device, "two buffers", &written_entries(2)),
            three: group_layout(device, "three buffers", &written_entries(3)),
            drawing: group_layout(device, "drawing", &drawing_entries()),
        }
    }

    /// Group 2 with this number of read-write buffers, 1 to 3.
    pub(crate) fn written(&self, count: u32) -> &wgpu::BindGroupLayout {
        match count {
            1 => &self.one,
            2 => &self.two,
            _ => &self.three,
        }
    }
}

pub(crate) fn clusters_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let compute = ShaderStages::COMPUTE;
    vec![
        uniform(0, compute, false),
        uniform(1, compute, true),
        storage(2, compute, true),
        storage(3, compute, false),
        storage(4, compute, false),
        storage(5, compute, false),
    ]
}

pub(crate) fn written_entries(count: u32) -> Vec<wgpu::BindGroupLayoutEntry> {
    let bindings = 0..count;
    bindings
        .map(|binding| storage(binding, ShaderStages::COMPUTE, false))
        .collect()
}

pub(crate) fn drawing_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let both = ShaderStages::COMPUTE | ShaderStages::VERTEX;
    let mut entries = vec![storage(0, both, true), uniform(4, both, false)];
    entries.extend([5, 6, 7, 8, 9].map(|binding| storage(binding, both, true)));
    entries
}
