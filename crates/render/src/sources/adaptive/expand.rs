//! Stores vertices on the device, computed by the functions that the vertex shaders use. With it
//! tests prove that what is drawn is what is exported.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::wgsl::{Shader, ShaderParts};
use wgpu::util::DeviceExt;
use wgpu::{BufferUsages, ShaderStages};

use crate::gpu::buffers::read_back;
use crate::gpu::buffers::{group_layout, storage};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::sources::adaptive::batch::Batch;
use crate::sources::adaptive::refiner::{Refiner, drawing_constants};

/// Workgroups in a row of a dispatch.
const ROW: u32 = 1024;

/// A vertex as the shading gets it. Twin of `SurfaceVertex` in surface_vertex.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ExpandedVertex {
    /// Relative to the eye, in the world's directions (µm).
    pub position: [f32; 3],
    pad: f32,
    /// Unit normal.
    pub normal: [f32; 3],
    pad2: f32,
    /// Point of the tube's center line; the position itself on somata.
    pub axis: [f32; 3],
    /// Radius (µm) there; 0 on somata.
    pub radius: f32,
    /// The color key of the tracing point.
    pub color_key: u32,
    /// Index of the instance in the scene.
    pub instance: u32,
    /// Position in the refinement grid, which wireframes are drawn by.
    pub grid: [f32; 2],
}

/// A vertex of the grid of a patch that is drawn.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct GridPoint {
    /// See [`SelectedPatch::slot`](crate::testing::SelectedPatch::slot).
    pub slot: u32,
    /// See [`SelectedPatch::decided`](crate::testing::SelectedPatch::decided).
    pub decided: u32,
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
}

/// The module of the pass.
pub(crate) fn expand_shader() -> Shader {
    let mut parts = ShaderParts::new(&[shader::file("expand.wgsl")]);
    parts.constants = drawing_constants(Refiner::SHADERS - 1);
    parts.constants.u32("EXPAND_ROW", ROW);
    shader::shader("expand", &parts)
}

/// Group 1 of the pass: the grid points, and their vertices.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let compute = ShaderStages::COMPUTE;
    vec![storage(0, compute, true), storage(1, compute, false)]
}

impl Refiner {
    /// Computes the vertices at these grid points of a batch that was selected just before, in the
    /// same order. Waits for the device. At most 2²⁶ at a time.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn expand(
        &self,
        gpu: &Gpu,
        batch: &Batch,
        points: &[GridPoint],
    ) -> Result<Vec<ExpandedVertex>, DeviceError> {
        if points.is_empty() {
            return Ok(Vec::new());
        }
        let device = &gpu.device;
        let module = gpu.shader_module(&expand_shader());
        let own = group_layout(device, "expand", &entries());
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("expand"),
            bind_group_layouts: &[Some(self.layout()), Some(&own)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("expand"),
            layout: Some(&layout),
            module: &module,
            entry_point: Some("expand"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let requested = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("grid points"),
            contents: bytemuck::cast_slice(points),
            usage: BufferUsages::STORAGE,
        });
        let vertices = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("expanded vertices"),
            size: (points.len() * size_of::<ExpandedVertex>()) as u64,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let buffers = [(0, &requested), (1, &vertices)];
        let entries = buffers.map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("expand"),
            layout: &own,
            entries: &entries,
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, self.drawing_group(batch), &[]);
        pass.set_bind_group(1, &group, &[]);
        let groups = points.len().div_ceil(64) as u32;
        pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        read_back(gpu, &vertices, points.len())
    }
}
