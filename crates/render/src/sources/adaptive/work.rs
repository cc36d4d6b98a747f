//! Buffers of the selection: placed parts, decisions, and lists of what is drawn.

use bytemuck::{Pod, Zeroable};
use wgpu::BufferUsages;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::scene::templates::CLUSTER;
use crate::scene::templates::Page;
use crate::sources::adaptive::batch::{Batch, DrawIndexed};
use crate::sources::adaptive::grids::{BUCKETS, FLAT_INDICES};
use crate::sources::adaptive::layouts::WorkLayouts;
use crate::sources::adaptive::settings::{BatchUniforms, FrameUniforms, Placed, SECTION};

/// A ring or an explicit vertex as it is drawn. Twin of the struct of the same name in
/// coarse_point.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct CoarsePoint {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    pub(crate) radius: f32,
    pub(crate) low: u32,
    pub(crate) high: u32,
    pub(crate) color_key: u32,
    pub(crate) instance: u32,
}

/// Dispatch arguments of a pass that takes an empty queue.
const NO_GROUPS: [u32; 3] = [0, 1, 1];
/// Numbers that queues have for each cluster: see clusters.wgsl.
pub(crate) const QUEUE_U32S: usize = 4 + CLUSTER / 4;
/// Most queues that are filled by one pass.
const QUEUES: usize = 3;

/// How many of each thing a frame needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sizes {
    /// Slots of the largest batch.
    pub(crate) slots: usize,
    /// Explicit vertices of the batch with the most.
    pub(crate) explicit: usize,
    pub(crate) placed: usize,
    pub(crate) batches: usize,
}

impl Sizes {
    fn within(&self, other: &Self) -> bool {
        self.slots <= other.slots
            && self.explicit <= other.explicit
            && self.placed <= other.placed
            && self.batches <= other.batches
    }
}

/// The buffers, the sizes that they have room for, and their bind groups.
#[derive(Debug)]
pub(crate) struct Work {
    sizes: Sizes,
    batch_stride: usize,
    pub(crate) buffers: Buffers,
    pub(crate) groups: WorkGroups,
}

/// What the passes of a frame write for one another.
#[derive(Debug)]
pub(crate) struct Buffers {
    frame: wgpu::Buffer,
    batches: wgpu::Buffer,
    pub(crate) placed: wgpu::Buffer,
    pub(crate) owners: wgpu::Buffer,
    pub(crate) queues: wgpu::Buffer,
    marks: wgpu::Buffer,
    /// Dispatch arguments of the passes that take queues, in a buffer for each pass that fills
    /// queues: classify.wgsl (clusters), cull.wgsl (single patches) and note.wgsl (sections and
    /// rings).
    pub(crate) cluster_dispatches: wgpu::Buffer,
    pub(crate) single_dispatch: wgpu::Buffer,
    pub(crate) noted_dispatches: wgpu::Buffer,
    no_groups: wgpu::Buffer,
    pub(crate) decisions: wgpu::Buffer,
    ring_levels: wgpu::Buffer,
    coarse: wgpu::Buffer,
    list: wgpu::Buffer,
    /// Triangles of flat patches.
    pub(crate) flat_indices: wgpu::Buffer,
    pub(crate) draws: wgpu::Buffer,
}

/// Bind groups of the compute passes.
#[derive(Debug)]
pub(crate) struct WorkGroups {
    pub(crate) clusters: wgpu::BindGroup,
    pub(crate) classify: wgpu::BindGroup,
    pub(crate) decide: wgpu::BindGroup,
    pub(crate) decide_singles: wgpu::BindGroup,
    pub(crate) note: wgpu::BindGroup,
    pub(crate) coarse: wgpu::BindGroup,
    pub(crate) scan: wgpu::BindGroup,
    pub(crate) flatten: wgpu::BindGroup,
    pub(crate) list: wgpu::BindGroup,
}

impl Buffers {
    fn new(gpu: &Gpu, sizes: &Sizes, batch_stride: usize) -> Self {
        let make = |label, u32s: usize, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: (u32s * 4).max(16) as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        let u32s = |bytes: usize, count: usize| bytes / 4 * count;
        let (clusters, sections) = (sizes.slots / CLUSTER, sizes.slots / SECTION);
        let (written, uniform) = (BufferUsages::COPY_DST, BufferUsages::UNIFORM);
        let (stored, read) = (BufferUsages::STORAGE, BufferUsages::COPY_SRC);
        let indirect = BufferUsages::INDIRECT;
        let dispatches =
            |label, usage| make(label, NO_GROUPS.len() * QUEUES, usage | written | read);
        let no_groups = dispatches("no workgroups", BufferUsages::empty());
        let none = NO_GROUPS.repeat(QUEUES);
        gpu.queue
            .write_buffer(&no_groups, 0, bytemuck::cast_slice(&none));
        // See clusters.wgsl.
        let queues = QUEUE_U32S * clusters + sections;
        let marks = 3 + 3 * clusters + (1 + BUCKETS) * sections;
        let placed = u32s(size_of::<Placed>(), sizes.placed);
        let coarse = u32s(
            size_of::<CoarsePoint>(),
            sizes.slots / 4 + 2 * sizes.explicit,
        );
        let draws = u32s(size_of::<DrawIndexed>(), 1 + BUCKETS);
        Self {
            frame: make("frame", size_of::<FrameUniforms>() / 4, uniform | written),
            batches: make(
                "batches",
                u32s(batch_stride, sizes.batches),
                uniform | written,
            ),
            placed: make("placed", placed, stored | written | read),
            owners: make("owners", clusters, stored | read),
            queues: make("queues", queues, stored | read),
            marks: make("marks", marks, stored | written),
            cluster_dispatches: dispatches("dispatches", stored | indirect),
            single_dispatch: dispatches("dispatches", stored | indirect),
            noted_dispatches: dispatches("dispatches", stored | indirect),
            no_groups,
            decisions: make("decisions", sizes.slots, stored | read),
            ring_levels: make("ring levels", sizes.slots / 4, stored | written),
            coarse: make("coarse", coarse, stored),
            list: make("list", 2 * sizes.slots, stored),
            flat_indices: make(
                "flat patches",
                FLAT_INDICES as usize * sizes.slots,
                stored | BufferUsages::INDEX,
            ),
            draws: make("draws", draws, stored | indirect),
        }
    }
}

impl WorkGroups {
    fn new(gpu: &Gpu, layouts: &WorkLayouts, buffers: &Buffers, buckets: &wgpu::Buffer) -> Self {
        let group = |label, layout, buffers: &[wgpu::BindingResource<'_>]| {
            let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
                .zip(buffers)
                .map(|(binding, resource)| wgpu::BindGroupEntry {
                    binding,
                    resource: resource.clone(),
                })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout,
                entries: &entries,
            })
        };
        let one_batch = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &buffers.batches,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<BatchUniforms>() as u64),
        });
        let whole = wgpu::Buffer::as_entire_binding;
        let b = buffers;
        Self {
            clusters: group(
                "clusters",
                &layouts.clusters,
                &[
                    whole(&b.frame),
                    one_batch,
                    whole(&b.placed),
                    whole(&b.owners),
                    whole(&b.queues),
                    whole(&b.marks),
                ],
            ),
            classify: group(
                "classify",
                &layouts.two,
                &[whole(&b.cluster_dispatches), whole(&b.single_dispatch)],
            ),
            decide: group(
                "decide",
                &layouts.three,
                &[
                    whole(&b.decisions),
                    whole(&b.ring_levels),
                    whole(&b.single_dispatch),
                ],
            ),
            decide_singles: group(
                "decide singles",
                &layouts.two,
                &[whole(&b.decisions), whole(&b.ring_levels)],
            ),
            note: group(
                "note",
                &layouts.two,
                &[whole(&b.decisions), whole(&b.noted_dispatches)],
            ),
            coarse: group("coarse", &layouts.one, &[whole(&b.coarse)]),
            scan: group("scan", &layouts.two, &[whole(buckets), whole(&b.draws)]),
            flatten: group(
                "flatten",
                &layouts.two,
                &[whole(&b.decisions), whole(&b.flat_indices)],
            ),
            list: group(
                "list",
                &layouts.three,
                &[whole(&b.decisions), whole(&b.list), whole(buckets)],
            ),
        }
    }
}

impl Work {
    /// Buffers of at least these sizes.
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &WorkLayouts,
        buckets: &wgpu::Buffer,
        least: Sizes,
    ) -> Result<Self, DeviceError> {
        // A little more than needed, so that a moving camera does not need new buffers every frame.
        let more = |n: usize| n + n / 4;
        let sizes = Sizes {
            slots: more(least.slots).next_multiple_of(SECTION),
            explicit: more(least.explicit),
            placed: more(least.placed).max(1),
            batches: more(least.batches).max(1),
        };
        let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment as usize;
        let batch_stride = size_of::<BatchUniforms>().next_multiple_of(alignment.max(1));
        let buffers = Buffers::new(gpu, &sizes, batch_stride);
        let groups = WorkGroups::new(gpu, layouts, &buffers, buckets);
        gpu.check()?;
        Ok(Self {
            sizes,
            batch_stride,
            buffers,
            groups,
        })
    }

    /// Group 0 of the shaders that compute vertices of a page's templates.
    pub(crate) fn drawing_group(
        &self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        page: &Page,
        buckets: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let entries = [
            (0, &page.packed),
            (4, &self.buffers.frame),
            (5, &self.buffers.placed),
            (6, &self.buffers.owners),
            (7, &self.buffers.list),
            (8, buckets),
            (9, &self.buffers.coarse),
        ]
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("drawing"),
            layout,
            entries: &entries,
        })
    }

    pub(crate) fn holds(&self, sizes: &Sizes) -> bool {
        sizes.within(&self.sizes)
    }

    pub(crate) fn write(
        &self,
        gpu: &Gpu,
        frame: &FrameUniforms,
        placed: &[Placed],
        batches: &[Batch],
    ) {
        let mut bytes = vec![0_u8; self.batch_stride * batches.len()];
        for (bytes, batch) in bytes.chunks_mut(self.batch_stride).zip(batches) {
            bytes[..size_of::<BatchUniforms>()]
                .copy_from_slice(bytemuck::bytes_of(&batch.uniforms));
        }
        write(gpu, &self.buffers.frame, &[*frame]);
        write(gpu, &self.buffers.batches, &bytes);
        write(gpu, &self.buffers.placed, placed);
    }

    /// Empties the queues and marks before a batch is selected.
    pub(crate) fn begin(&self, encoder: &mut wgpu::CommandEncoder) {
        let b = &self.buffers;
        encoder.clear_buffer(&b.marks, 0, None);
        encoder.clear_buffer(&b.ring_levels, 0, None);
        for dispatches in [
            &b.cluster_dispatches,
            &b.single_dispatch,
            &b.noted_dispatches,
        ] {
            encoder.copy_buffer_to_buffer(&b.no_groups, 0, dispatches, 0, dispatches.size());
        }
    }

    pub(crate) fn batch_offset(&self, index: u32) -> u32 {
        index * self.batch_stride as u32
    }

    pub(crate) fn bytes(&self) -> Vec<(&'static str, u64)> {
        let b = &self.buffers;
        let dispatches = 4 * b.no_groups.size();
        vec![
            ("placed", b.placed.size()),
            ("owners", b.owners.size()),
            ("queues", b.queues.size() + dispatches),
            ("marks", b.marks.size()),
            ("decisions", b.decisions.size() + b.ring_levels.size()),
            ("coarse_points", b.coarse.size()),
            ("list", b.list.size()),
            ("flat_patches", b.flat_indices.size()),
            ("draws", b.draws.size()),
            ("frame", b.frame.size() + b.batches.size()),
        ]
    }
}

fn write<T: Pod>(gpu: &Gpu, buffer: &wgpu::Buffer, data: &[T]) {
    if !data.is_empty() {
        gpu.queue
            .write_buffer(buffer, 0, bytemuck::cast_slice(data));
    }
}
