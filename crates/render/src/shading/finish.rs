//! What comes after the drawing: ambient occlusion, and the bytes of the picture. Twin of the uniform
//! in `finish.wgsl`.

use bytemuck::{Pod, Zeroable};

use crate::gpu::device::Gpu;
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
}

impl Finish {
    /// What the frame says; the rest is 0.
    pub(crate) fn of(frame: &Frame) -> Self {
        Self {
            tile_size: [frame.tile.width, frame.tile.height],
            tile_origin: [frame.tile.x, frame.tile.y],
            half_size: frame.size.map(|n| n as f32 / 2.0),
            slope: frame.slope() as f32,
            ..Self::default()
        }
    }
}

/// Taps of the occlusion around a sub-pixel.
const TAPS: u32 = 14;
/// How dark corners are. SelectedPatch by eye: forks and the feet of stems show, tubes stay clean.
const STRENGTH: f32 = 3.0;
/// Sub-pixels that the occlusion is blurred over, to each side: the turns repeat after four.
pub(crate) const BLUR: u32 = 4;

/// What the last pass does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Last {
    /// Makes pixels of sub-pixels.
    Gather,
    /// Adds sub-pixels, which are pixels, to those before: one more binding.
    Accumulate,
}

/// The passes after the drawing.
pub(crate) struct Finisher {
    pub(crate) occlude: wgpu::ComputePipeline,
    pub(crate) blur: wgpu::ComputePipeline,
    pub(crate) last: wgpu::ComputePipeline,
    pub(crate) layout: wgpu::BindGroupLayout,
}

impl Finisher {
    pub(crate) fn new(gpu: &Gpu, samples: u32, last: Last) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("finish"),
            source: wgpu::ShaderSource::Wgsl(finish_text(samples, last).into()),
        });
        let layout = layout(device, samples > 1, last);
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
            occlude: pipeline("occlude"),
            blur: pipeline("blur"),
            last: pipeline(match last {
                Last::Gather => "gather",
                Last::Accumulate => "accumulate",
            }),
            layout,
        }
    }
}

/// The passes' text, for this many samples per sub-pixel.
pub(crate) fn finish_text(samples: u32, last: Last) -> String {
    // Of several samples the first stands for the sub-pixel; of one, there is only that.
    let texture = if samples > 1 {
        "texture_multisampled_2d<f32>"
    } else {
        "texture_2d<f32>"
    };
    let shared = include_str!("finish.wgsl").replace("SAMPLED_TEXTURE", texture);
    let occlusion = include_str!("occlusion.wgsl");
    let last = match last {
        Last::Gather => "",
        Last::Accumulate => include_str!("accumulate.wgsl"),
    };
    format!(
        "const TAPS: u32 = {TAPS}u;\nconst STRENGTH: f32 = {STRENGTH:?};\n\
         const BLUR: i32 = {BLUR};\n{shared}{occlusion}{last}"
    )
}

fn layout(device: &wgpu::Device, multisampled: bool, last: Last) -> wgpu::BindGroupLayout {
    let binding = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let buffer = |ty| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = |sample_type, multisampled| wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled,
    };
    let plain = wgpu::TextureSampleType::Float { filterable: false };
    let storage = wgpu::BufferBindingType::Storage { read_only: false };
    let mut entries = vec![
        binding(0, buffer(wgpu::BufferBindingType::Uniform)),
        binding(1, texture(plain, false)),
        binding(2, texture(plain, multisampled)),
        binding(3, texture(plain, multisampled)),
        binding(4, buffer(storage)),
        binding(5, buffer(storage)),
        binding(6, buffer(storage)),
    ];
    if last == Last::Accumulate {
        entries.push(binding(7, buffer(storage)));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("finish"),
        entries: &entries,
    })
}
