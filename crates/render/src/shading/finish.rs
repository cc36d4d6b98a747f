//! The passes after the drawing: ambient occlusion, and the bytes of the picture.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::wgsl::{Constants, Shader, ShaderParts};

use crate::gpu::buffers::{UNFILTERED, group_layout, storage, texture_binding, uniform};
use crate::gpu::device::Gpu;
use crate::gpu::parallel::{all_of, beside};
use crate::gpu::shader;
use crate::shading::targets::Targets;
use neurotess_picture::Frame;

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
    pub(crate) tiled: u32,
    pub(crate) clear: u32,
    pub(crate) kept: [u32; 2],
    pub(crate) spare: u32,
    pub(crate) empty: u32,
    pub(crate) background: [f32; 4],
    pub(crate) flat: f32,
    pub(crate) pad: f32,
    pub(crate) inset: [u32; 2],
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
    find_blocks: wgpu::ComputePipeline,
    /// For [`Last::Gather`].
    find_pixels: Option<wgpu::ComputePipeline>,
    copy_depths: wgpu::ComputePipeline,
    occlude: wgpu::ComputePipeline,
    blur_rows: wgpu::ComputePipeline,
    blur_columns: wgpu::ComputePipeline,
    pub(crate) last: wgpu::ComputePipeline,
    pub(crate) layout: wgpu::BindGroupLayout,
    dispatch_layout: wgpu::BindGroupLayout,
}

/// A list of blocks of 8 × 8 in which anything shows. Twin of the constants in blocks.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Blocks {
    /// Of sub-pixels.
    Covered,
    /// Of sub-pixels whose occlusion is asked.
    Occluded,
    /// Of pixels.
    Gathered,
}

impl Finisher {
    /// Encodes what comes before a pass with [`Finisher::find_blocks`].
    pub(crate) fn begin(&self, targets: &Targets, encoder: &mut wgpu::CommandEncoder) {
        for buffer in [&targets.raw, &targets.blocks, &targets.dispatches] {
            encoder.clear_buffer(buffer, 0, None);
        }
    }

    /// Finds the blocks of the targets in which anything shows. Group 0 is set.
    pub(crate) fn find_blocks(
        &self,
        gpu: &Gpu,
        targets: &Targets,
        pass: &mut wgpu::ComputePass<'_>,
    ) {
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("dispatches"),
            layout: &self.dispatch_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: targets.dispatches.as_entire_binding(),
            }],
        });
        pass.set_bind_group(1, &group, &[]);
        // An invocation for each block; of pixels there are at most as many as of sub-pixels.
        let [across, down] = targets.size.map(|n| n.div_ceil(8).div_ceil(8));
        for pipeline in [Some(&self.find_blocks), self.find_pixels.as_ref()] {
            let Some(pipeline) = pipeline else { continue };
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(across, down, 1);
        }
    }

    /// How blocks that were found are occluded.
    pub(crate) fn occlude(&self, targets: &Targets, pass: &mut wgpu::ComputePass<'_>) {
        for_blocks(&self.copy_depths, Blocks::Covered, targets, pass);
        for_blocks(&self.occlude, Blocks::Occluded, targets, pass);
    }

    /// Blurs the occlusion.
    pub(crate) fn blur(&self, targets: &Targets, pass: &mut wgpu::ComputePass<'_>) {
        for_blocks(&self.blur_rows, Blocks::Occluded, targets, pass);
        for_blocks(&self.blur_columns, Blocks::Occluded, targets, pass);
    }

    /// Computes the pixels of blocks that were found, for [`Last::Gather`].
    pub(crate) fn gather(&self, targets: &Targets, pass: &mut wgpu::ComputePass<'_>) {
        for_blocks(&self.last, Blocks::Gathered, targets, pass);
    }

    pub(crate) fn new(gpu: &Gpu, samples: u32, last: Last) -> Self {
        let device = &gpu.device;
        let module = gpu.shader_module(&finish_shader(samples, last));
        let layout = group_layout(device, "finish", &entries(samples > 1, last));
        let dispatch_layout = group_layout(device, "dispatches", &dispatch_entries());
        let pipeline = |entry_point: &str| {
            let finding = FINDING.contains(&entry_point).then_some(&dispatch_layout);
            let groups: Vec<_> = [Some(&layout), finding]
                .into_iter()
                .flatten()
                .map(Some)
                .collect();
            let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("finish"),
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let last_entry = match last {
            Last::Gather => "gather",
            Last::Accumulate => "accumulate",
        };
        let entries = [
            FINDING[0],
            "copy_depths",
            "occlude",
            "blur_rows",
            "blur_columns",
            last_entry,
        ];
        let (
            find_pixels,
            [
                find_blocks,
                copy_depths,
                occlude,
                blur_rows,
                blur_columns,
                last,
            ],
        ) = beside(
            gpu,
            || (last == Last::Gather).then(|| pipeline(FINDING[1])),
            || all_of(gpu, |place| pipeline(entries[place])),
        );
        Self {
            find_blocks,
            find_pixels,
            copy_depths,
            occlude,
            blur_rows,
            blur_columns,
            last,
            layout,
            dispatch_layout,
        }
    }
}

/// A pass over the blocks of a list.
fn for_blocks(
    pipeline: &wgpu::ComputePipeline,
    blocks: Blocks,
    targets: &Targets,
    pass: &mut wgpu::ComputePass<'_>,
) {
    pass.set_pipeline(pipeline);
    pass.dispatch_workgroups_indirect(&targets.dispatches, 16 * blocks as u64);
}

/// The entry points that list blocks, and write how many there are.
pub(crate) const FINDING: [&str; 2] = ["find_blocks", "find_pixels"];

/// The passes' shader, for this many samples per sub-pixel.
pub(crate) fn finish_shader(samples: u32, last: Last) -> Shader {
    let mut parts = ShaderParts::new(&[shader::file("occlusion.wgsl")]);
    parts.files.push(match last {
        Last::Gather => shader::file("gather.wgsl"),
        Last::Accumulate => shader::file("accumulate.wgsl"),
    });
    // Textures of normals and depths are then multisampled.
    if samples > 1 {
        parts.constants.flag("MULTISAMPLED");
    }
    parts.constants.u32("SAMPLES", samples);
    parts.constants.extend(&occlusion_constants());
    shader::shader("finish", &parts)
}

/// Constants of obscurance.wgsl.
pub(crate) fn occlusion_constants() -> Constants {
    let mut constants = Constants::default();
    constants.u32("TAPS", TAPS);
    constants.f32("STRENGTH", STRENGTH);
    constants.i32("BLUR", BLUR as i32);
    constants
}

/// Group 1 of the passes that list blocks.
pub(crate) fn dispatch_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    vec![storage(0, wgpu::ShaderStages::COMPUTE, false)]
}

/// Group 0 of all passes. `multisampled`: whether the textures of normals and depths are.
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
        storage(7, compute, false),
    ];
    if last == Last::Accumulate {
        entries.push(storage(8, compute, false));
    }
    entries
}
