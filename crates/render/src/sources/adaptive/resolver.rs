//! What an id means: instance, and patch of its mesh. Twin of surface_id.wgsl.

use std::collections::BTreeMap;

use crate::scene::Scene;
use crate::scene::templates::Base;
use crate::sources::adaptive::batch::{Batch, FramePlan};
use crate::sources::adaptive::settings::Placed;
use crate::sources::pick::{BATCH_SHIFT, FINE, PickHit, PickId, PickTarget};

/// Knows where everything of a frame stood, also when other frames came after.
#[derive(Clone, Debug, Default)]
pub struct PickResolver {
    batches: Vec<Batch>,
    placed: Vec<Placed>,
    /// By page, first point and first quad of a part.
    parts: BTreeMap<Key, PartNames>,
}

type Key = (usize, u32, u32);

/// What a part's numbers mean in its mesh.
#[derive(Clone, Debug, Default)]
struct PartNames {
    patches: Vec<u32>,
    explicit: Vec<u32>,
}

fn key(page: usize, base: &Base) -> Key {
    (page, base.points, base.soma)
}

impl PickResolver {
    pub(crate) fn new(plan: &FramePlan, scene: &Scene) -> Self {
        let mut parts = BTreeMap::new();
        for batch in &plan.batches {
            for placed in &plan.placed[range(batch)] {
                let instance = scene.instances().get(placed.instance as usize);
                let template = instance.and_then(|i| scene.templates().template(i.template));
                let part = template.into_iter().flat_map(|t| &t.parts);
                let mut part = part.filter(|p| p.page == batch.page && p.base == placed.base);
                if let Some(part) = part.next() {
                    let key = key(batch.page, &placed.base);
                    parts.entry(key).or_insert_with(|| PartNames {
                        patches: part.in_mesh.clone(),
                        explicit: part.explicit.clone(),
                    });
                }
            }
        }
        Self {
            batches: plan.batches.clone(),
            placed: plan.placed.clone(),
            parts,
        }
    }

    /// What an id of the frame means; nothing where nothing was drawn.
    pub fn name(&self, [first, place]: PickId) -> Option<PickHit> {
        let first = first.checked_sub(1)?;
        let batch = self.batches.get((first >> BATCH_SHIFT) as usize)?;
        let how = first & ((1 << BATCH_SHIFT) - 1);
        let placed = &self.placed[range(batch)];
        let explicit = how != FINE && place >= batch.uniforms.slots;
        let begins = |p: &Placed| {
            if explicit {
                p.first_explicit
            } else {
                p.first_slot
            }
        };
        let owner = placed.partition_point(|p| begins(p) <= place);
        let owner = placed.get(owner.checked_sub(1)?)?;
        let part = self.parts.get(&key(batch.page, &owner.base))?;
        let at = (place - begins(owner)) as usize;
        let spot = if explicit {
            PickTarget::Vertex(*part.explicit.get(at)?)
        } else {
            // The far corners of a flat patch are on the ring after its own.
            let back = if how == 2 || how == 3 { 4 } else { 0 };
            PickTarget::Patch(patch(&part.patches, at.saturating_sub(back))?)
        };
        Some(PickHit {
            instance: owner.instance,
            spot,
        })
    }
}

/// The patch at a place; the last ring of a run has none, but the one before it has.
fn patch(patches: &[u32], at: usize) -> Option<u32> {
    let before = patches.get(..=at.min(patches.len().checked_sub(1)?))?;
    before.iter().copied().rfind(|&patch| patch != u32::MAX)
}

fn range(batch: &Batch) -> std::ops::Range<usize> {
    let first = batch.uniforms.first as usize;
    first..first + batch.uniforms.placed as usize
}
