//! Stored vertices, made on the device by the functions that draws use: the proof that what one sees
//! is what is exported.

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

/// A vertex as the shading stage gets it. Twin of `SurfaceVertex` in surface_vertex.wgsl.
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
    /// Place of the instance in the scene.
    pub instance: u32,
    /// Place in the refinement grid, as wireframe need it.
    pub grid: [f32; 2],
}

/// A place in the grid of a patch that is drawn.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct GridPoint {
    /// See [`SelectedPatch::slot`](crate::testing::SelectedPatch::slot).
    pub slot: u32,
    /// See [`SelectedPatch::slot`](crate::testing::SelectedPatch::slot).
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

/// Group 1 of the pass: the places in grids, and their vertices.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let compute = ShaderStages::COMPUTE;
    vec![storage(0, compute, true), storage(1, compute, false)]
}

impl Refiner {
    /// Makes vertices of a batch that was chosen just before, in the order wanted. Waits for the
    /// device. At most 2²⁶ at a time.
    ///
    /// # Errors
    /// What the device complained of.
    pub fn expand(
        &self,
        gpu: &Gpu,
        batch: &Batch,
        wanted: &[GridPoint],
    ) -> Result<Vec<ExpandedVertex>, DeviceError> {
        if wanted.is_empty() {
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
        let asked = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("wanted"),
            contents: bytemuck::cast_slice(wanted),
            usage: BufferUsages::STORAGE,
        });
        let made = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("made"),
            size: (wanted.len() * size_of::<ExpandedVertex>()) as u64,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let entries = [(0, &asked), (1, &made)].map(|(binding, buffer)| wgpu::BindGroupEntry {
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
        let groups = wanted.len().div_ceil(64) as u32;
        pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        read_back(gpu, &made, wanted.len())
    }
}
