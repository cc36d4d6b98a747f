//! The compute passes of exploration mode and the buffers that they share: see `select.wgsl`.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::gpu;
use neurotess_refine::wgsl::{Shader, ShaderParts};
use wgpu::BufferUsages;

use super::buffers::Buffers;
use super::layout::{
    BINS, BINS_OF_OCTAVE, BLOCK, CLUSTER, Extent, Eye, LOWEST_OCTAVE, ROW, Sums, VisibleChunk,
    WIDE, constants,
};
use crate::gpu::buffers::{group_layout, storage, uniform};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::growable::GrowableBuffer;
use crate::gpu::parallel::side_by_side;
use crate::gpu::shader;

/// Twin of the struct in `selection.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct VisibleCluster {
    pub(crate) cluster: u32,
    pub(crate) first_instance: u32,
    pub(crate) last_instance: u32,
    pub(crate) quads: u32,
    pub(crate) visible_chunks: u32,
}

/// Twin of the struct in `selection.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Measured {
    pub(crate) instance: u32,
    pub(crate) best: u32,
}

/// Twin of the struct in `selection.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Arguments {
    pub(crate) clusters: [u32; 3],
    pub(crate) visible: [u32; 3],
    pub(crate) draws: [u32; 10],
    pub(crate) again: [u32; 3],
}

/// What the passes read: templates and instances.
pub(crate) struct Resident<'a> {
    pub(super) buffers: &'a Buffers,
    pub(crate) gpu_instances: &'a GrowableBuffer,
}

/// A pass: its entry point, and the bindings that it uses.
pub(crate) struct Step {
    pub(crate) entry: &'static str,
    bindings: &'static [u32],
}

impl Step {
    /// Group 0 of the pass.
    pub(crate) fn entries(&self) -> Vec<wgpu::BindGroupLayoutEntry> {
        self.bindings.iter().map(|&b| binding(b)).collect()
    }
}

/// Group 0 of the shaders that compute vertices.
pub(crate) fn drawing_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let vertex = wgpu::ShaderStages::VERTEX;
    let mut entries = vec![uniform(0, vertex, false)];
    entries.extend([1, 2, 3, 4, 5, 6].map(|binding| storage(binding, vertex, true)));
    entries
}

pub(crate) const STEPS: [Step; 7] = [
    Step {
        entry: "cull_instances",
        bindings: &[0, 1, 2, 3, 4],
    },
    Step {
        entry: "sum_chunks",
        bindings: &[0, 4, 6, 7],
    },
    Step {
        entry: "measure",
        bindings: &[0, 1, 2, 3, 4, 5, 7, 8],
    },
    Step {
        entry: "limit",
        bindings: &[0, 4, 6, 7, 8, 9],
    },
    Step {
        entry: "count",
        bindings: &[0, 1, 2, 3, 4, 5, 9],
    },
    Step {
        entry: "sum_visible",
        bindings: &[0, 4, 6, 9, 10, 11],
    },
    Step {
        entry: "write",
        bindings: &[0, 1, 2, 3, 4, 5, 9, 10, 11],
    },
];

/// The first steps, which are repeated until the least worth is known; and how often: the floor is
/// a guess, falls three times, and then is 0.
const MEASURING: usize = 4;
const ROUNDS: usize = 5;
/// The first guess (binary logarithm) for scenes of at least so many chunks: the worth of a soma of three pixels. In
/// smaller ones everything is measured.
const MANY: u64 = 1 << 20;
const FIRST_FLOOR: f32 = 9.6;

/// Pipelines of all passes: made once.
#[derive(Debug)]
pub(crate) struct Passes {
    layouts: Vec<wgpu::BindGroupLayout>,
    pipelines: Vec<wgpu::ComputePipeline>,
    pub(crate) drawing: wgpu::BindGroupLayout,
}

/// The most that a frame may have to handle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Size {
    pub(crate) instances: usize,
    pub(crate) chunks: u64,
    /// Most quads.
    pub(crate) budget: u32,
}

/// Buffers of a frame, for scenes of up to this size.
#[derive(Debug)]
pub(crate) struct Work {
    size: Size,
    pub(crate) eye: wgpu::Buffer,
    /// Sums, then what is selected from each instance.
    pub(crate) book: wgpu::Buffer,
    arguments: wgpu::Buffer,
    measured: wgpu::Buffer,
    histogram: wgpu::Buffer,
    visible: wgpu::Buffer,
    pub(crate) visible_chunks: wgpu::Buffer,
    quads: wgpu::Buffer,
    indices: wgpu::Buffer,
}

/// Bind groups of all passes and of the draw.
#[derive(Debug)]
pub(crate) struct Groups {
    passes: Vec<wgpu::BindGroup>,
    drawing: wgpu::BindGroup,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, DeviceError> {
        let device = &gpu.device;
        let module = gpu.shader_module(&select_shader());
        let made = side_by_side(gpu, STEPS.len(), |step| {
            let step = &STEPS[step];
            let layout = group_layout(device, step.entry, &step.entries());
            let of_pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(step.entry),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(step.entry),
                layout: Some(&of_pipeline),
                module: &module,
                entry_point: Some(step.entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
            (pipeline, layout)
        });
        let (pipelines, layouts) = made.into_iter().unzip();
        let drawing = group_layout(device, "visible chunks", &drawing_entries());
        gpu.check()?;
        Ok(Self {
            layouts,
            pipelines,
            drawing,
        })
    }

    pub(crate) fn groups(&self, gpu: &Gpu, work: &Work, resident: &Resident<'_>) -> Groups {
        let buffer = |binding: u32| match binding {
            0 => &work.eye,
            1 => &resident.buffers.chunks.buffer,
            2 => &resident.buffers.shapes.buffer,
            3 => &resident.gpu_instances.buffer,
            4 => &work.book,
            5 => &resident.buffers.packed.buffer,
            6 => &work.arguments,
            7 => &work.measured,
            8 => &work.histogram,
            9 => &work.visible,
            10 => &work.visible_chunks,
            _ => &work.quads,
        };
        let group = |layout, buffers: Vec<(u32, &wgpu::Buffer)>| {
            let entries: Vec<_> = buffers
                .iter()
                .map(|&(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("exploration"),
                layout,
                entries: &entries,
            })
        };
        let passes = STEPS.iter().zip(&self.layouts).map(|(step, layout)| {
            let buffers = step.bindings.iter().map(|&b| (b, buffer(b)));
            group(layout, buffers.collect())
        });
        let drawn = vec![
            (0, &work.eye),
            (1, &resident.buffers.chunks.buffer),
            (2, &work.visible_chunks),
            (3, &resident.gpu_instances.buffer),
            (4, &work.quads),
            (5, &resident.buffers.packed.buffer),
            (6, &resident.buffers.color_keys.buffer),
        ];
        Groups {
            passes: passes.collect(),
            drawing: group(&self.drawing, drawn),
        }
    }

    /// Records all passes of a frame; without groups, an empty one.
    pub(crate) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        work: &Work,
        groups: Option<&Groups>,
        instances: usize,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        if groups.is_some() {
            encoder.clear_buffer(&work.histogram, 0, None);
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("exploration"),
            timestamp_writes: timestamps,
        });
        let Some(groups) = groups else { return };
        let mut dispatch = |step: usize, round: usize| {
            pass.set_pipeline(&self.pipelines[step]);
            pass.set_bind_group(0, &groups.passes[step], &[]);
            match STEPS[step].entry {
                "cull_instances" if round == 0 => {
                    let all = (instances.div_ceil(WIDE) as u32).max(1);
                    pass.dispatch_workgroups(all.min(ROW as u32), all.div_ceil(ROW as u32), 1);
                }
                "cull_instances" => pass.dispatch_workgroups_indirect(&work.arguments, 64),
                "measure" => pass.dispatch_workgroups_indirect(&work.arguments, 0),
                "count" | "write" => pass.dispatch_workgroups_indirect(&work.arguments, 12),
                _ => pass.dispatch_workgroups(1, 1, 1),
            }
        };
        for round in 0..ROUNDS {
            for step in 0..MEASURING {
                dispatch(step, round);
            }
        }
        for step in MEASURING..STEPS.len() {
            dispatch(step, 0);
        }
    }

    /// Draws what was selected, with the pipeline that is set. Sets group 0.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, work: &Work, groups: &Groups) {
        pass.set_bind_group(0, &groups.drawing, &[]);
        pass.set_index_buffer(work.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.multi_draw_indexed_indirect(&work.arguments, 24, 2);
    }
}

impl Work {
    /// Buffers for scenes of up to this size.
    ///
    /// # Errors
    /// A buffer would be larger than the device can bind, or the device reports another error.
    pub(crate) fn new(gpu: &Gpu, size: Size) -> Result<Self, DeviceError> {
        let quads = u64::from(size.budget).max(1);
        let stored = BufferUsages::STORAGE;
        let make = |what: &'static str, bytes: u64, usage| {
            let (bytes, most) = (bytes.max(16), gpu.largest_binding());
            if bytes > most {
                return Err(DeviceError::TooLarge { what, bytes, most });
            }
            Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                size: bytes,
                usage: usage | BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }))
        };
        // Every visible cluster draws at least one quad, and so does every visible chunk.
        let clusters = size.chunks.div_ceil(CLUSTER as u64);
        let most_visible = clusters.min(quads);
        let extents = size_of::<Extent>() as u64 * (size.instances as u64).max(1);
        let book = size_of::<Sums>() as u64 + extents;
        let most_visible_chunks = size.chunks.min(quads);
        let work = Self {
            size,
            eye: make("eye", size_of::<Eye>() as u64, BufferUsages::UNIFORM)?,
            book: make("extents of instances", book, stored)?,
            arguments: make(
                "arguments",
                size_of::<Arguments>() as u64,
                stored | BufferUsages::INDIRECT,
            )?,
            measured: make(
                "clusters of chunks",
                size_of::<Measured>() as u64 * clusters,
                stored,
            )?,
            histogram: make("histogram", 4 * BINS as u64, stored)?,
            visible: make(
                "visible clusters",
                size_of::<VisibleCluster>() as u64 * most_visible.max(1),
                stored,
            )?,
            visible_chunks: make(
                "visible_chunks",
                size_of::<VisibleChunk>() as u64 * most_visible_chunks,
                stored,
            )?,
            quads: make("quads", 4 * (quads + 1), stored)?,
            indices: make("indices", 4 * INDICES as u64, BufferUsages::INDEX)?,
        };
        if size.chunks >= MANY {
            let bin = (FIRST_FLOOR - LOWEST_OCTAVE) * BINS_OF_OCTAVE;
            work.set_floor(gpu, bin as u32);
        }
        gpu.queue
            .write_buffer(&work.indices, 0, bytemuck::cast_slice(&indices()));
        gpu.check()?;
        Ok(work)
    }

    /// Sets the bin from which on the next frame measures chunks at first; 0: all in view.
    pub(crate) fn set_floor(&self, gpu: &Gpu, bin: u32) {
        let at = std::mem::offset_of!(Sums, floor) as u64;
        gpu.queue
            .write_buffer(&self.book, at, bytemuck::bytes_of(&bin));
    }

    /// Whether a scene of this size fits into the buffers.
    pub(crate) fn holds(&self, size: &Size) -> bool {
        let Size {
            instances,
            chunks,
            budget,
        } = self.size;
        instances >= size.instances && chunks >= size.chunks && budget >= size.budget
    }

    pub(crate) fn bytes(&self) -> Vec<(&'static str, u64)> {
        vec![
            ("extents", self.book.size()),
            ("clusters", self.measured.size() + self.visible.size()),
            ("visible_chunks", self.visible_chunks.size()),
            ("quads", self.quads.size()),
            ("histogram", self.histogram.size() + self.arguments.size()),
            ("frame", self.eye.size()),
            ("indices", self.indices.size()),
        ]
    }
}

/// Number of indices: those of a full block, and those of the rest.
const INDICES: usize = 12 * BLOCK;

/// Two triangles a quad, split along the diagonal from corner 1 to 3. Vertex indices of the rest
/// follow those of a full block.
fn indices() -> Vec<u32> {
    let quads = 0..2 * BLOCK as u32;
    quads
        .flat_map(|quad| [0, 1, 3, 1, 2, 3].map(|corner| 4 * quad + corner))
        .collect()
}

/// The shader module of all passes.
pub(crate) fn select_shader() -> Shader {
    let mut parts = ShaderParts::new(&[shader::file("select.wgsl")]);
    parts.constants = constants();
    shader::shader("select", &parts)
}

/// The shader that computes vertices. It has refine's constants too, since near somata are
/// evaluated by evaluate.wgsl.
pub(crate) fn vertex_shader() -> ShaderParts {
    let mut parts = ShaderParts::new(&[shader::file("visible_chunks.wgsl")]);
    parts.constants = gpu::constants();
    parts.constants.extend(&constants());
    parts
}

fn binding(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let compute = wgpu::ShaderStages::COMPUTE;
    match binding {
        0 => uniform(0, compute, false),
        1 | 2 | 3 | 5 => storage(binding, compute, true),
        _ => storage(binding, compute, false),
    }
}

const _: () = assert!(CLUSTER == 64 && size_of::<VisibleCluster>() == 20);
