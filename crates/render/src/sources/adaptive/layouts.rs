//! Which buffers the passes of a frame see, and how.
//!
//! No pass has more than eight storage buffers: what every WebGPU device has.

use wgpu::ShaderStages;

use crate::gpu::buffers::{storage, uniform};

/// Layouts of the groups that work buffers are in.
#[derive(Debug)]
pub(crate) struct WorkLayouts {
    /// Group 1 of all passes that choose.
    pub(crate) clusters: wgpu::BindGroupLayout,
    /// Group 2: one read-write buffer, two, or three.
    pub(crate) one: wgpu::BindGroupLayout,
    pub(crate) two: wgpu::BindGroupLayout,
    pub(crate) three: wgpu::BindGroupLayout,
    /// Group 0 of whoever makes vertices: binding 0 of a page, those of a frame from 4.
    pub(crate) drawing: wgpu::BindGroupLayout,
}

impl WorkLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries,
            })
        };
        let compute = ShaderStages::COMPUTE;
        let both = ShaderStages::COMPUTE | ShaderStages::VERTEX;
        let written = |count: u32| -> Vec<wgpu::BindGroupLayoutEntry> {
            (0..count)
                .map(|binding| storage(binding, compute, false))
                .collect()
        };
        Self {
            clusters: layout(
                "clusters",
                &[
                    uniform(0, compute, false),
                    uniform(1, compute, true),
                    storage(2, compute, true),
                    storage(3, compute, false),
                    storage(4, compute, false),
                    storage(5, compute, false),
                ],
            ),
            one: layout("one buffer", &written(1)),
            two: layout("two buffers", &written(2)),
            three: layout("three buffers", &written(3)),
            drawing: layout(
                "drawing",
                &[
                    storage(0, both, true),
                    uniform(4, both, false),
                    storage(5, both, true),
                    storage(6, both, true),
                    storage(7, both, true),
                    storage(8, both, true),
                    storage(9, both, true),
                ],
            ),
        }
    }
}
