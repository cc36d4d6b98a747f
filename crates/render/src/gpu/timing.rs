//! How long passes take on the GPU, if it supports timestamps.

use crate::gpu::buffers::read_mapped;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// The passes of a tile. If a scene is drawn in several rounds, the last one is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    Select,
    Draw,
    Occlude,
    Blur,
    Gather,
}

/// Names of the passes in statistics, in the order of [`Pass`].
pub(crate) const PASSES: [&str; 5] = ["choose", "draw", "occlude", "blur", "gather"];

const COUNT: u32 = 2 * PASSES.len() as u32;

/// Adds up the times of passes.
pub(crate) struct Timer {
    queries: Option<Queries>,
    /// Milliseconds by pass.
    milliseconds: [f64; PASSES.len()],
}

struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f64,
}

impl Timer {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let able = gpu
            .device
            .features()
            .contains(wgpu::Features::TIMESTAMP_QUERY);
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("times"),
                size: u64::from(8 * COUNT),
                usage,
                mapped_at_creation: false,
            })
        };
        let queries = able.then(|| Queries {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("times"),
                ty: wgpu::QueryType::Timestamp,
                count: COUNT,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            read: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            period: f64::from(gpu.queue.get_timestamp_period()),
        });
        Self {
            queries,
            milliseconds: [0.0; PASSES.len()],
        }
    }

    pub(crate) fn render(&self, pass: Pass) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let first = 2 * pass as u32;
        self.queries
            .as_ref()
            .map(|queries| wgpu::RenderPassTimestampWrites {
                query_set: &queries.set,
                beginning_of_pass_write_index: Some(first),
                end_of_pass_write_index: Some(first + 1),
            })
    }

    pub(crate) fn compute(&self, pass: Pass) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let first = 2 * pass as u32;
        self.queries
            .as_ref()
            .map(|queries| wgpu::ComputePassTimestampWrites {
                query_set: &queries.set,
                beginning_of_pass_write_index: Some(first),
                end_of_pass_write_index: Some(first + 1),
            })
    }

    pub(crate) fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(Queries {
            set,
            resolved,
            read,
            ..
        }) = &self.queries
        {
            encoder.resolve_query_set(set, 0..COUNT, resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, read, 0, u64::from(8 * COUNT));
        }
    }

    /// Adds the times of the last tile.
    pub(crate) fn read(&mut self, gpu: &Gpu) -> Result<(), DeviceError> {
        if let Some(queries) = &self.queries {
            let bytes = read_mapped(gpu, &queries.read, u64::from(8 * COUNT))?;
            let mut ticks = bytes
                .chunks_exact(8)
                .map(|b| u64::from_le_bytes(b.try_into().unwrap_or_default()));
            for sum in &mut self.milliseconds {
                let (begin, end) = (ticks.next().unwrap_or(0), ticks.next().unwrap_or(0));
                *sum += end.saturating_sub(begin) as f64 * queries.period * 1e-6;
            }
        }
        Ok(())
    }

    /// Forgets the times so far.
    pub(crate) fn reset(&mut self) {
        self.milliseconds = [0.0; PASSES.len()];
    }

    /// Milliseconds of all tiles by pass; none if the GPU does not support timestamps.
    pub(crate) fn milliseconds(&self) -> Option<[f64; PASSES.len()]> {
        self.queries.as_ref().map(|_| self.milliseconds)
    }
}
