//! What a frame of exploration mode drew, read back on request: for statistics and for tests.

use super::Exploration;
use super::layout::{Sums, VisibleChunk};
use super::streaming::{StreamedTemplates, Streaming};
use crate::gpu::buffers::read_back;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// Most chunks of a scene that are all asked for statistics.
const MAX_ASKED: u64 = 1 << 23;

/// Sums of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExplorationStats {
    /// Triangles drawn.
    pub triangles: u64,
    /// Most triangles that may be drawn.
    pub budget: u64,
    /// Triangles that it would take to draw everything within half a pixel.
    pub requested: u64,
    /// Whether it may take more: of scenes of more than 8 million chunks only those are asked that
    /// are worth about as much as those drawn.
    pub at_least: bool,
    /// Chunks and somata drawn.
    pub visible_chunks: u64,
    /// Instances that are not hidden and may show in the picture.
    pub instances: u64,
    /// All instances.
    pub all_instances: u64,
    /// If not all templates fit the device: what is there.
    pub streamed: Option<StreamedTemplates>,
}

/// A chunk or a soma that was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnChunk {
    /// Index of the instance.
    pub instance: u32,
    /// Index of the chunk, among those of its template.
    pub chunk: u32,
    /// Its level of detail, as `packed_lod` in budgeted.wgsl packs it.
    pub lod: u32,
    /// Number of quads.
    pub quads: u32,
}

impl Exploration {
    /// What the picture that was prepared last draws. Selects once more, from everything in view
    /// unless that would take seconds, and waits for the device: for statistics, not for every
    /// frame.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn stats(&self, gpu: &Gpu) -> Result<ExplorationStats, DeviceError> {
        let all = self.size().chunks <= MAX_ASKED;
        if all {
            self.work.set_floor(gpu, 0);
        }
        let sums = self.sums(gpu)?;
        Ok(ExplorationStats {
            triangles: 2 * u64::from(sums.quads),
            budget: u64::from(self.budget),
            requested: 2 * u64::from(sums.wanted),
            // Below the budget nothing is left out, so everything was asked.
            at_least: !all && sums.threshold > 1,
            visible_chunks: u64::from(sums.visible_chunks),
            instances: u64::from(sums.instances),
            all_instances: self.instances.len() as u64,
            streamed: self.streaming.as_ref().map(Streaming::stats),
        })
    }

    /// The visible chunks, in the order in which they are drawn. Selects once more, as a frame
    /// does, and waits for the device.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn shown(&self, gpu: &Gpu) -> Result<Vec<DrawnChunk>, DeviceError> {
        let sums = self.sums(gpu)?;
        let count = sums.visible_chunks as usize;
        let visible_chunks: Vec<VisibleChunk> = read_back(gpu, &self.work.visible_chunks, count)?;
        let ends = visible_chunks.iter().skip(1).map(|next| next.first);
        let ends = ends.chain([sums.quads]);
        Ok(visible_chunks
            .iter()
            .zip(ends)
            .map(|(visible_chunk, end)| DrawnChunk {
                instance: visible_chunk.instance,
                chunk: visible_chunk.chunk - self.first_chunk(visible_chunk.instance as usize),
                lod: visible_chunk.lod,
                quads: end - visible_chunk.first,
            })
            .collect())
    }

    /// How many chunks a frame measures to find out which are drawn, for the picture that was
    /// prepared last, if the frame before was the same. Selects once more, as a frame does, and
    /// waits for the device.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn measured(&self, gpu: &Gpu) -> Result<u64, DeviceError> {
        self.sums(gpu)?;
        Ok(u64::from(self.sums(gpu)?.chunks))
    }

    fn first_chunk(&self, instance: usize) -> u32 {
        self.known[self.instances[instance].template.0 as usize].first_chunk
    }

    fn sums(&self, gpu: &Gpu) -> Result<Sums, DeviceError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let (groups, instances) = (self.groups.as_ref(), self.instances.len());
        self.passes
            .record(&mut encoder, &self.work, groups, instances, None);
        gpu.queue.submit([encoder.finish()]);
        let sums = read_back(gpu, &self.work.book, 1)?;
        Ok(sums.first().copied().unwrap_or_default())
    }
}
