//! What was chosen and drawn, read back after a frame on request: for statistics and for tests.

use bytemuck::Pod;
use neurotess_mesh::PatchKind;
use neurotess_refine::{Caps, HIGHEST_LEVEL, patch_triangles};

use crate::device::Gpu;
use crate::error::DeviceError;
use crate::grids::{BUCKETS, Bucket};
use crate::refiner::{Batch, Refiner};
use crate::refining::{CLUSTER, DECIDED_TUBE, DECISION_WHOLE, Placed, decided};
use crate::scene::Scene;

/// A patch that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chosen {
    /// Its place in the batch's list.
    pub place: u32,
    /// Place of the instance in the scene.
    pub instance: u32,
    /// Index of the patch in the template's mesh.
    pub patch: u32,
    /// First column of its grid: other than 0 where patches around a tube are drawn as one.
    pub column: u32,
    /// Whether it is drawn with the other three around the tube.
    pub whole: bool,
    /// Levels of its four sides.
    pub levels: [u32; 4],
    /// What it covers.
    pub kind: PatchKind,
}

/// What a frame drew.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Patches of all instances that are not hidden.
    pub patches: u64,
    /// Patches that were drawn.
    pub patches_drawn: u64,
    /// Vertices that were evaluated, each once per patch.
    pub vertices: u64,
    /// Triangles with an area.
    pub triangles: u64,
    /// Number of sides of drawn patches by level, from 0 to 64.
    pub level_histogram: Vec<u64>,
}

impl FrameStats {
    /// Nothing drawn yet, of so many patches.
    pub fn new(patches: u64) -> Self {
        Self {
            patches,
            level_histogram: vec![0; HIGHEST_LEVEL as usize + 1],
            ..Self::default()
        }
    }

    /// Adds what a batch drew.
    pub fn add(&mut self, chosen: &[Chosen], caps: Caps) {
        for patch in chosen {
            let (nx, ny, triangles) = patch_triangles(patch.kind, caps, patch.levels);
            self.patches_drawn += 1;
            self.vertices += match (patch.whole, patch.column) {
                (true, 0) => 10,
                (true, _) => 0,
                (false, _) => u64::from((nx + 1) * (ny + 1)),
            };
            self.triangles += triangles as u64;
            for level in patch.levels {
                self.level_histogram[level.min(HIGHEST_LEVEL) as usize] += 1;
            }
        }
    }
}

impl Refiner {
    /// Patches that [`Refiner::choose`] last listed, in the order in which they are drawn. Waits for
    /// the device.
    ///
    /// # Errors
    /// What the device complained of.
    pub fn read_chosen(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        batch: &Batch,
    ) -> Result<Vec<Chosen>, DeviceError> {
        let slots = batch.words.slots as usize;
        let buckets: Vec<Bucket> = read(gpu, self.bucket_buffer(), BUCKETS)?;
        let count: u32 = buckets.iter().map(|bucket| bucket.count).sum();
        let list: Vec<[u32; 2]> = read(gpu, &self.work.list, count as usize)?;
        let owners: Vec<u32> = read(gpu, &self.work.owners, slots / CLUSTER)?;
        let last = batch.words.first + batch.words.placed;
        let placed: Vec<Placed> = read(gpu, &self.work.placed, last as usize)?;
        let mut chosen = Vec::with_capacity(list.len());
        for (place, [slot, word]) in (0..).zip(list) {
            let owner: &Placed = &placed[owners[slot as usize / CLUSTER] as usize];
            let instance = scene.instances()[owner.instance as usize];
            let parts = scene.templates().template(instance.template);
            let part = parts
                .into_iter()
                .flat_map(|t| &t.parts)
                .find(|part| part.page == batch.page && part.base == owner.base);
            let (kind, levels) = decided(word);
            let whole = word & DECISION_WHOLE != 0;
            for column in 0..if whole { 4 } else { 1 } {
                let at = (slot - owner.first_slot + column) as usize;
                chosen.push(Chosen {
                    place,
                    instance: owner.instance,
                    patch: part.map_or(0, |part| part.in_mesh[at]),
                    column,
                    whole,
                    levels,
                    kind: match kind {
                        0 | DECIDED_TUBE => PatchKind::Lateral,
                        1 => PatchKind::Cap,
                        _ => PatchKind::Soma,
                    },
                });
            }
        }
        Ok(chosen)
    }
}

/// The first elements of a buffer. Waits for the device.
pub(crate) fn read<T: Pod>(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    count: usize,
) -> Result<Vec<T>, DeviceError> {
    let bytes = (count * size_of::<T>()) as u64;
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
    gpu.queue.submit([encoder.finish()]);
    let slice = copy.slice(..);
    slice.map_async(wgpu::MapMode::Read, |_| ());
    gpu.wait()?;
    let lost = |e: &dyn std::fmt::Display| DeviceError::Lost(e.to_string());
    let view = slice.get_mapped_range().map_err(|e| lost(&e))?;
    Ok(bytemuck::pod_collect_to_vec(&view))
}
