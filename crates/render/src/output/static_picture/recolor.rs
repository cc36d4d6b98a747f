//! The pass from weights and colors to a picture's bytes, with recolor.wgsl.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::wgsl::{Shader, ShaderParts};

use crate::gpu::buffers::{group_layout, make, storage, uniform, upload};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;

use neurotess_picture::recolor::Matrix;

/// Twin of `Recolor` in recolor.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Recolor {
    pub(crate) background: [f32; 4],
    pub(crate) edge: [f32; 4],
    pub(crate) pixels: u32,
    pub(crate) row: u32,
    pub(crate) transparent: u32,
    pub(crate) empty: u32,
}

/// Workgroups in a row of a dispatch, of 64 pixels each.
const ROW: u32 = 4096;

pub(crate) fn recolor_shader() -> Shader {
    let parts = ShaderParts::new(&[shader::file("recolor.wgsl")]);
    shader::shader("recolor", &parts)
}

/// The pass's only bind group.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let compute = wgpu::ShaderStages::COMPUTE;
    vec![
        uniform(0, compute, false),
        storage(1, compute, true),
        storage(2, compute, true),
        storage(3, compute, true),
        storage(4, compute, false),
    ]
}

/// A matrix on the device, and the picture that it was multiplied into last.
pub(crate) struct Product {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    colors: wgpu::Buffer,
    pub(crate) pixels: wgpu::Buffer,
    groups: u32,
    pub(crate) bytes: u64,
}

impl Product {
    /// `settings`: without the numbers that follow from the matrix.
    ///
    /// # Errors
    /// The device has no room for it.
    pub(crate) fn new(gpu: &Gpu, matrix: &Matrix, settings: Recolor) -> Result<Self, DeviceError> {
        let most = gpu.largest_binding();
        let bytes = size_of_val(&*matrix.weights) as u64;
        if bytes > most {
            let what = "the weights of a picture";
            return Err(DeviceError::TooLarge { what, bytes, most });
        }
        let pixels = matrix.rows.len().saturating_sub(1) as u32;
        let settings = Recolor {
            pixels,
            row: ROW * 64,
            ..settings
        };
        let device = &gpu.device;
        let layout = group_layout(device, "recolor", &entries());
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("recolor"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("recolor"),
            layout: Some(&pipeline_layout),
            module: &gpu.shader_module(&recolor_shader()),
            entry_point: Some("recolor_pixels"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let written = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let read = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let uniform = upload(gpu, "recolor", wgpu::BufferUsages::UNIFORM, &[settings]);
        let rows = upload(gpu, "rows", wgpu::BufferUsages::STORAGE, &matrix.rows);
        // Bindings are not empty, not even where nothing shows.
        let none = [Default::default()];
        let weights = match &*matrix.weights {
            [] => &none,
            all => all,
        };
        let weights = upload(gpu, "weights", wgpu::BufferUsages::STORAGE, weights);
        let colors = make(gpu, "colors", 16 * matrix.keys.len() as u64, written);
        let pixel_buffer = make(gpu, "pixels", 4 * u64::from(pixels), read);
        let buffers = [&uniform, &rows, &weights, &colors, &pixel_buffer];
        let group_entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("recolor"),
            layout: &layout,
            entries: &group_entries,
        });
        gpu.check()?;
        Ok(Self {
            pipeline,
            group,
            bytes: buffers.iter().map(|buffer| buffer.size()).sum(),
            colors,
            pixels: pixel_buffer,
            groups: pixels.div_ceil(64),
        })
    }

    /// Multiplies with these colors, one for each of the matrix's keys.
    pub(crate) fn multiply(
        &self,
        gpu: &Gpu,
        colors: &[[f32; 4]],
        encoder: &mut wgpu::CommandEncoder,
    ) {
        if !colors.is_empty() {
            gpu.queue
                .write_buffer(&self.colors, 0, bytemuck::cast_slice(colors));
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("recolor"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(self.groups.min(ROW), self.groups.div_ceil(ROW), 1);
    }
}
