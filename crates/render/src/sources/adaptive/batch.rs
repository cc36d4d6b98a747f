//! Which parts of templates a frame draws, and in which batches.

use bytemuck::{Pod, Zeroable};

use crate::scene::Scene;
use crate::scene::templates::{CLUSTER, MAX_PATCHES};
use crate::sources::adaptive::cull::shows;
use crate::sources::adaptive::settings::{BatchUniforms, FrameUniforms, Placed, SECTION};
use neurotess_picture::CullView;

/// Most slots of a batch.
pub(crate) const MAX_SLOTS: usize = MAX_PATCHES;

/// Arguments of an indexed indirect draw. Twin of the struct of the same name in scan.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct DrawIndexed {
    pub(crate) index_count: u32,
    pub(crate) instance_count: u32,
    pub(crate) first_index: u32,
    pub(crate) base_vertex: u32,
    pub(crate) first_instance: u32,
}

/// Placed parts that are selected and drawn together, all of one page.
#[derive(Clone, Copy, Debug)]
pub struct Batch {
    pub(crate) page: usize,
    pub(crate) uniforms: BatchUniforms,
    /// Index among the batches of its frame.
    pub(crate) index: u32,
}

/// What one frame draws.
#[derive(Clone, Debug, Default)]
pub struct FramePlan {
    /// Batches, in the order in which they are drawn.
    pub batches: Vec<Batch>,
    /// Patches of all instances that are not hidden.
    pub patches: u64,
    /// The placed parts: each batch has a range of them.
    pub(crate) placed: Vec<Placed>,
}

/// Parts of instances that may show, each with its page; and the number of patches of all instances
/// that are not hidden. `only`: indices of the instances; none: all.
pub(crate) fn place_all(
    scene: &Scene,
    only: Option<&[usize]>,
    view: &CullView,
    frame: &FrameUniforms,
) -> (Vec<(usize, Placed)>, u64) {
    let mut placed = Vec::new();
    let mut patches = 0;
    let all = 0..only.map_or(scene.instances().len(), <[usize]>::len);
    let indices = all.map(|k| only.map_or(k, |only| only[k]));
    for i in indices {
        let Some(instance) = scene.instances().get(i) else {
            continue;
        };
        let Some(template) = scene.templates().template(instance.template) else {
            continue;
        };
        if instance.hidden {
            continue;
        }
        let at_placement = Placed::new(view, &instance.placement, template.origin);
        for part in &template.parts {
            patches += u64::from(part.patches);
            let placed_part = Placed {
                base: part.base,
                patches: part.slots,
                instance: i as u32,
                state: instance.state,
                ..at_placement
            };
            if shows(frame, &placed_part, part.sphere.0, part.sphere.1) {
                placed.push((part.page, placed_part));
            }
        }
    }
    (placed, patches)
}

/// Gives every placed part its slots, a whole number of clusters, and begins a new batch when the
/// page changes or a batch is full. Also returns the index of every batch's first explicit vertex.
pub(crate) fn cut(placed: &mut [(usize, Placed)]) -> (Vec<Batch>, u32) {
    let mut batches: Vec<Batch> = Vec::new();
    for (i, (page, part)) in placed.iter_mut().enumerate() {
        let slots = (part.patches as usize).next_multiple_of(CLUSTER);
        let fits = |b: &Batch| b.page == *page && b.uniforms.slots as usize + slots <= MAX_SLOTS;
        if !batches.last().is_some_and(fits) {
            batches.push(Batch {
                page: *page,
                index: batches.len() as u32,
                uniforms: BatchUniforms {
                    first: i as u32,
                    ..BatchUniforms::default()
                },
            });
        }
        let Some(batch) = batches.last_mut() else {
            continue;
        };
        part.first_slot = batch.uniforms.slots;
        batch.uniforms.placed += 1;
        batch.uniforms.slots += slots as u32;
        batch.uniforms.clusters = batch.uniforms.slots / CLUSTER as u32;
        batch.uniforms.sections = batch.uniforms.slots.div_ceil(SECTION as u32);
    }
    let slots = batches.iter().map(|batch| batch.uniforms.slots);
    let first_explicit = slots.max().unwrap_or(0);
    for batch in &mut batches {
        place_explicit(batch, first_explicit, placed);
    }
    (batches, first_explicit)
}

/// Gives the explicit vertices of a batch's parts their indices, behind all slots.
fn place_explicit(batch: &mut Batch, first_explicit: u32, placed: &mut [(usize, Placed)]) {
    let uniforms = &mut batch.uniforms;
    let first = uniforms.first as usize;
    for (_, part) in &mut placed[first..first + uniforms.placed as usize] {
        part.first_explicit = first_explicit + uniforms.explicit_vertices;
        uniforms.explicit_vertices += part.base.explicit_count();
    }
}
