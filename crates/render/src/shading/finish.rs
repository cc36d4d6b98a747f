//! The passes after the drawing: ambient occlusion, and the bytes of the picture.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::wgsl::{Shader, ShaderParts};

use crate::gpu::buffers::{UNFILTERED, group_layout, storage, texture_binding, uniform};
use crate::gpu::device::Gpu;
use crate::gpu::shader;
use crate::view::frame::Frame;

/// Twin of `Finish` in `finish.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Finish {
    pub(crate) tile_size: [u32; 2],
    pub(crate) tile_origin: [i32; 2],
    pub(crate) half_size: [f32; 2],
    pub(crate) slope: f32,
    pub(crate) scale: u32,
    pub(crate) radius: f32,
    pub(crate) most: f32,
    pub(crate) margin: u32,
    pub(crate) clear: u32,
    pub(crate) kept: [u32; 2],
    pub(crate) spare: u32,
    pub(crate) empty: u32,
    pub(crate) background: [f32; 4],
    pub(crate) flat: f32,
    pub(crate) pad: [f32; 3],
}

impl Finish {
    /// The fields that follow from the frame; the others are 0.
    pub(crate) fn of(frame: &Frame) -> Self {
        Self {
            tile_size: [frame.tile.width, frame.tile.height],
            tile_origin: [frame.tile.x, frame.tile.y],
            half_size: frame.size.map(|n| n as f32 / 2.0),
            slope: frame.pixel().slope as f32,
            flat: frame.pixel().flat as f32,
            ..Self::default()
        }
    }
}

/// Number of samples that the occlusion of a sub-pixel takes around it.
const TAPS: u32 = 14;
/// How dark corners are. Chosen by eye: it shows at forks and where neurites leave the soma, but
/// not on tubes.
const STRENGTH: f32 = 3.0;
/// Sub-pixels that the occlusion is blurred over, to each side: its pattern of turns repeats after
/// four.
pub(crate) const BLUR: u32 = 4;

/// What the last pass does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Last {
    /// Computes pixels from sub-pixels.
    Gather,
    /// Adds sub-pixels, which are pixels here, to the sums of the steps before; has one more
    /// binding.
    Accumulate,
}

/// The passes after the drawing.
pub(crate) struct Finisher {
    pub(crate) copy_depths: wgpu::ComputePipeline,
    pub(crate) occlude: wgpu::ComputePipeline,
    pub(crate) blur_rows: wgpu::ComputePipeline,
    pub(crate) blur_columns: wgpu::ComputePipeline,
    pub(crate) last: wgpu::ComputePipeline,
    pub(crate) layout: wgpu::BindGroupLayout,
}

impl Finisher {
    /// What ambient occlusion takes, in this order.
    pub(crate) fn occlusion(&self) -> [&wgpu::ComputePipeline; 4] {
        [
            &self.copy_depths,
            &self.occlude,
            &self.blur_rows,
            &self.blur_columns,
        ]
    }

    pub(crate) fn new(gpu: &Gpu, samples: u32, last: Last) -> Self {
        let device = &gpu.device;
        let module = gpu.shader_module(&finish_shader(samples, last));
        let layout = group_layout(device, "finish", &entries(samples > 1, last));
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("finish"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = |entry_point: &str| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        Self {
            copy_depths: pipeline("copy_depths"),
            occlude: pipeline("occlude"),
            blur_rows: pipeline("blur_rows"),
            blur_columns: pipeline("blur_columns"),
            last: pipeline(match last {
                Last::Gather => "gather",
                Last::Accumulate => "accumulate",
            }),
            layout,
        }
    }
}

/// The passes' shader, for this many samples per sub-pixel.
pub(crate) fn finish_shader(samples: u32, last: Last) -> Shader {
    let mut parts =
        ShaderParts::new(&[shader::file("finish.wgsl"), shader::file("occlusion.wgsl")]);
    if last == Last::Accumulate {
        parts.files.push(shader::file("accumulate.wgsl"));
    }
    // Textures of normals and depths are then multisampled.
    if samples > 1 {
        parts.constants.flag("MULTISAMPLED");
    }
    parts.constants.u32("SAMPLES", samples);
    parts.constants.u32("TAPS", TAPS);
    parts.constants.f32("STRENGTH", STRENGTH);
    parts.constants.i32("BLUR", BLUR as i32);
    shader::shader("finish", &parts)
}

/// The passes' only bind group. `multisampled`: whether the textures of normals and depths are.
pub(crate) fn entries(multisampled: bool, last: Last) -> Vec<wgpu::BindGroupLayoutEntry> {
    let compute = wgpu::ShaderStages::COMPUTE;
    let mut entries = vec![
        uniform(0, compute, false),
        texture_binding(1, compute, UNFILTERED, false),
        texture_binding(2, compute, UNFILTERED, multisampled),
        texture_binding(3, compute, UNFILTERED, multisampled),
        storage(4, compute, false),
        storage(5, compute, false),
        storage(6, compute, false),
    ];
    if last == Last::Accumulate {
        entries.push(storage(7, compute, false));
    }
    entries
}
