//! What was selected and drawn, read back after a frame on request: for statistics and for tests.

use neurotess_mesh::PatchKind;
use neurotess_refine::{Caps, HIGHEST_LEVEL, patch_triangles};

use crate::gpu::buffers::read_back;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::scene::Scene;
use crate::scene::templates::CLUSTER;
use crate::sources::adaptive::batch::Batch;
use crate::sources::adaptive::refiner::Refiner;
use crate::sources::adaptive::settings::{
    BatchUniforms, DECIDED_TUBE, Placed, QUEUE_SHOWN, decided,
};

/// A patch that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SelectedPatch {
    /// Its slot in the batch, as [`GridPoint`](crate::testing::GridPoint) takes it.
    pub slot: u32,
    /// The bits of its decision, as [`GridPoint`](crate::testing::GridPoint) takes them.
    pub decided: u32,
    /// Index of the instance in the scene.
    pub instance: u32,
    /// Index of the patch in the template's mesh.
    pub patch: u32,
    /// Levels of its four sides.
    pub levels: [u32; 4],
    /// Whether it is a lateral patch, a cap or a part of a soma.
    pub kind: PatchKind,
}

/// What a frame drew.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Patches of all instances that are not hidden.
    pub patches: u64,
    /// Patches that were drawn.
    pub patches_drawn: u64,
    /// Vertices that were evaluated, each once per patch. Patches at level 1 share their corners
    /// and count as one vertex each.
    pub vertices: u64,
    /// Triangles with an area.
    pub triangles: u64,
    /// Number of sides of drawn patches by level, from 0 to 64.
    pub level_histogram: Vec<u64>,
}

impl FrameStats {
    /// Nothing drawn yet, of this number of patches.
    pub fn new(patches: u64) -> Self {
        Self {
            patches,
            level_histogram: vec![0; HIGHEST_LEVEL as usize + 1],
            ..Self::default()
        }
    }

    /// Adds what a batch drew.
    pub fn add(&mut self, selected: &[SelectedPatch], caps: Caps) {
        for patch in selected {
            let (nx, ny, triangles) = patch_triangles(patch.kind, caps, patch.levels);
            self.patches_drawn += 1;
            self.vertices += match patch.levels {
                [1, 1, 1, 1] => 1,
                _ => u64::from((nx + 1) * (ny + 1)),
            };
            self.triangles += triangles as u64;
            for level in patch.levels {
                self.level_histogram[level.min(HIGHEST_LEVEL) as usize] += 1;
            }
        }
    }
}

impl Refiner {
    /// Patches that [`Refiner::select`] last decided to draw, in the order of their slots. Waits
    /// for the device.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn read_selected(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        batch: &Batch,
    ) -> Result<Vec<SelectedPatch>, DeviceError> {
        let BatchUniforms {
            slots,
            clusters,
            first,
            placed,
            ..
        } = batch.uniforms;
        let buffers = &self.work.buffers;
        let first_shown = QUEUE_SHOWN * clusters;
        let groups: Vec<[u32; 3]> = read_back(gpu, &buffers.cluster_dispatches, 3)?;
        let queues: Vec<u32> = read_back(gpu, &buffers.queues, 3 * clusters as usize)?;
        let shown = first_shown..first_shown + groups[QUEUE_SHOWN as usize][0];
        let mut shown = queues[shown.start as usize..shown.end as usize].to_vec();
        // Workgroups queue them in any order.
        shown.sort_unstable();
        let decisions: Vec<u32> = read_back(gpu, &buffers.decisions, slots as usize)?;
        let owners: Vec<u32> = read_back(gpu, &buffers.owners, clusters as usize)?;
        let placed: Vec<Placed> = read_back(gpu, &buffers.placed, (first + placed) as usize)?;
        let mut selected = Vec::new();
        for cluster in shown {
            let owner: &Placed = &placed[owners[cluster as usize] as usize];
            let instance = scene.instances()[owner.instance as usize];
            let parts = scene.templates().template(instance.template);
            let part = parts
                .into_iter()
                .flat_map(|t| &t.parts)
                .find(|part| part.page == batch.page && part.base == owner.base);
            let cluster = cluster * CLUSTER as u32..(cluster + 1) * CLUSTER as u32;
            let slots = cluster.map(|slot| (slot, decisions[slot as usize]));
            selected.extend(
                slots
                    .filter(|&(_, decided)| decided != 0)
                    .map(|(slot, bits)| {
                        let at = (slot - owner.first_slot) as usize;
                        let (kind, levels) = decided(bits);
                        SelectedPatch {
                            slot,
                            decided: bits,
                            instance: owner.instance,
                            patch: part.map_or(0, |part| part.in_mesh[at]),
                            levels,
                            kind: match kind {
                                0 | DECIDED_TUBE => PatchKind::Lateral,
                                1 => PatchKind::Cap,
                                3 => PatchKind::Loft,
                                _ => PatchKind::Soma,
                            },
                        }
                    }),
            );
        }
        Ok(selected)
    }
}
