//! Buffers of a frame's work: where parts stand, what was decided, and what is drawn.

use bytemuck::Pod;
use wgpu::{BufferUsages, ShaderStages};

use crate::device::Gpu;
use crate::error::DeviceError;
use crate::grids::BUCKETS;
use crate::refiner::{Batch, DrawIndexed, storage};
use crate::refining::{BatchWords, CLUSTER, FrameWords, Placed, SECTION};
use crate::templates::Page;

/// Layouts of the groups that work buffers are in.
#[derive(Debug)]
pub(crate) struct WorkLayouts {
    /// Group 1 of the pass that decides, group 0 of those that list: bindings from 4.
    pub(crate) decisions: wgpu::BindGroupLayout,
    /// Group 1 of the passes that list.
    pub(crate) lists: wgpu::BindGroupLayout,
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
        Self {
            decisions: layout(
                "decisions",
                &[
                    uniform(4, compute, false),
                    uniform(5, compute, true),
                    storage(6, compute, true),
                    storage(7, compute, false),
                    storage(8, compute, false),
                    storage(9, compute, false),
                ],
            ),
            lists: layout(
                "lists",
                &[0, 1, 2].map(|binding| storage(binding, compute, false)),
            ),
            drawing: layout(
                "drawing",
                &[
                    storage(0, both, true),
                    uniform(4, both, false),
                    storage(5, both, true),
                    storage(6, both, true),
                    storage(7, both, true),
                    storage(8, both, true),
                ],
            ),
        }
    }
}

fn uniform(
    binding: u32,
    visibility: ShaderStages,
    has_dynamic_offset: bool,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset,
            min_binding_size: None,
        },
        count: None,
    }
}

/// The buffers, for batches of up to so many slots.
#[derive(Debug)]
pub(crate) struct Work {
    slots: usize,
    placed_count: usize,
    batch_count: usize,
    batch_stride: usize,
    frame: wgpu::Buffer,
    batches: wgpu::Buffer,
    pub(crate) placed: wgpu::Buffer,
    pub(crate) owners: wgpu::Buffer,
    decisions: wgpu::Buffer,
    pub(crate) counts: wgpu::Buffer,
    pub(crate) list: wgpu::Buffer,
    pub(crate) draws: wgpu::Buffer,
    pub(crate) decisions_group: wgpu::BindGroup,
    pub(crate) lists_group: wgpu::BindGroup,
}

impl Work {
    /// Buffers for at least so many of each.
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &WorkLayouts,
        buckets: &wgpu::Buffer,
        slots: usize,
        placed_count: usize,
        batch_count: usize,
    ) -> Result<Self, DeviceError> {
        // A little more than asked for, so that a moving camera does not make buffers every frame.
        let slots = (slots + slots / 4).next_multiple_of(SECTION);
        let placed_count = (placed_count + placed_count / 4).max(1);
        let batch_count = (batch_count + batch_count / 4).max(1);
        let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment as usize;
        let batch_stride = size_of::<BatchWords>().next_multiple_of(alignment.max(1));
        let make = |label, bytes: usize, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        let written = BufferUsages::COPY_DST;
        let (stored, read) = (BufferUsages::STORAGE, BufferUsages::COPY_SRC);
        let frame = make(
            "frame",
            size_of::<FrameWords>(),
            BufferUsages::UNIFORM | written,
        );
        let batches = make(
            "batches",
            batch_stride * batch_count,
            BufferUsages::UNIFORM | written,
        );
        let placed = make(
            "placed",
            placed_count * size_of::<Placed>(),
            stored | written | read,
        );
        let owners = make("owners", slots / CLUSTER * 4, stored | read);
        let decisions = make("decisions", slots * 4, stored | read);
        let counts = make("counts", BUCKETS * (slots / SECTION) * 4, stored | written);
        let list = make("list", slots * 8, stored | read);
        let bytes = BUCKETS * size_of::<DrawIndexed>();
        let draws = make("draws", bytes, stored | BufferUsages::INDIRECT);
        let group = |label, layout, first, buffers: &[wgpu::BindingResource<'_>]| {
            let entries: Vec<wgpu::BindGroupEntry<'_>> = (first..)
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
            buffer: &batches,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<BatchWords>() as u64),
        });
        let whole = wgpu::Buffer::as_entire_binding;
        let decisions_group = group(
            "decisions",
            &layouts.decisions,
            4,
            &[
                whole(&frame),
                one_batch,
                whole(&placed),
                whole(&owners),
                whole(&decisions),
                whole(&counts),
            ],
        );
        let lists_group = group(
            "lists",
            &layouts.lists,
            0,
            &[whole(&list), whole(buckets), whole(&draws)],
        );
        gpu.check()?;
        Ok(Self {
            slots,
            placed_count,
            batch_count,
            batch_stride,
            frame,
            batches,
            placed,
            owners,
            decisions,
            counts,
            list,
            draws,
            decisions_group,
            lists_group,
        })
    }

    /// Group 0 of whoever makes vertices of a page's templates.
    pub(crate) fn drawing_group(
        &self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        page: &Page,
        buckets: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let entries = [
            (0, &page.heap),
            (4, &self.frame),
            (5, &self.placed),
            (6, &self.owners),
            (7, &self.list),
            (8, buckets),
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

    pub(crate) fn holds(&self, slots: usize, placed: usize, batches: usize) -> bool {
        slots <= self.slots && placed <= self.placed_count && batches <= self.batch_count
    }

    pub(crate) fn write(
        &self,
        gpu: &Gpu,
        frame: &FrameWords,
        placed: &[Placed],
        batches: &[Batch],
    ) {
        let mut words = vec![0_u8; self.batch_stride * batches.len()];
        for (place, batch) in words.chunks_mut(self.batch_stride).zip(batches) {
            place[..size_of::<BatchWords>()].copy_from_slice(bytemuck::bytes_of(&batch.words));
        }
        write(gpu, &self.frame, &[*frame]);
        write(gpu, &self.batches, &words);
        write(gpu, &self.placed, placed);
    }

    pub(crate) fn batch_offset(&self, index: u32) -> u32 {
        index * self.batch_stride as u32
    }

    pub(crate) fn bytes(&self) -> Vec<(&'static str, u64)> {
        vec![
            ("placed", self.placed.size()),
            ("owners", self.owners.size()),
            ("decisions", self.decisions.size()),
            ("counts", self.counts.size()),
            ("list", self.list.size()),
            ("draws", self.draws.size()),
            ("frame", self.frame.size() + self.batches.size()),
        ]
    }
}

fn write<T: Pod>(gpu: &Gpu, buffer: &wgpu::Buffer, data: &[T]) {
    if !data.is_empty() {
        gpu.queue
            .write_buffer(buffer, 0, bytemuck::cast_slice(data));
    }
}
