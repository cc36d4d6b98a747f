//! What a picking id means: an instance, and a patch of its mesh. Reads what surface_id.wgsl
//! writes.

use std::collections::BTreeMap;

use crate::scene::Scene;
use crate::scene::templates::Base;
use crate::sources::adaptive::batch::{Batch, FramePlan};
use crate::sources::adaptive::settings::Placed;
use crate::sources::pick::{BATCH_SHIFT, FINE, PickHit, PickId, PickTarget};

/// Resolves the ids of one frame, also after other frames were drawn.
#[derive(Clone, Debug, Default)]
pub struct PickResolver {
    batches: Vec<Batch>,
    placed: Vec<Placed>,
    /// Parts of templates by their page, first point and first quad.
    parts: BTreeMap<Key, PartNames>,
}

type Key = (usize, u32, u32);

/// Indices in a template's mesh by indices in one of its parts.
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

    /// What was drawn at a pixel with this id; nothing if nothing was.
    pub fn resolve(&self, [first, second]: PickId) -> Option<PickHit> {
        let first = first.checked_sub(1)?;
        let batch = self.batches.get((first >> BATCH_SHIFT) as usize)?;
        let corner = first & ((1 << BATCH_SHIFT) - 1);
        let placed = &self.placed[range(batch)];
        let explicit = corner != FINE && second >= batch.uniforms.slots;
        let begins = |p: &Placed| {
            if explicit {
                p.first_explicit
            } else {
                p.first_slot
            }
        };
        let owner = placed.partition_point(|p| begins(p) <= second);
        let owner = placed.get(owner.checked_sub(1)?)?;
        let part = self.parts.get(&key(batch.page, &owner.base))?;
        let at = (second - begins(owner)) as usize;
        let target = if explicit {
            PickTarget::Vertex(*part.explicit.get(at)?)
        } else {
            // Corners 2 and 3 of a flat patch are on the next point's ring.
            let back = if corner == 2 || corner == 3 { 4 } else { 0 };
            PickTarget::Patch(patch(&part.patches, at.saturating_sub(back))?)
        };
        Some(PickHit {
            instance: owner.instance,
            target,
        })
    }
}

/// The patch at an index of a part. The last ring of a path has no patches: then the last one
/// before it.
fn patch(patches: &[u32], at: usize) -> Option<u32> {
    let before = patches.get(..=at.min(patches.len().checked_sub(1)?))?;
    before.iter().copied().rfind(|&patch| patch != u32::MAX)
}

fn range(batch: &Batch) -> std::ops::Range<usize> {
    let first = batch.uniforms.first as usize;
    first..first + batch.uniforms.placed as usize
}
