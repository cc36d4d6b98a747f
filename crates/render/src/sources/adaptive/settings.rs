//! What one frame depends on: the view, the settings, and where parts are placed.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3, Vec4};
use neurotess_picture::{AdaptiveSettings, CullView};
use neurotess_refine::gpu::{self, GpuLodCriterion};
use neurotess_refine::wgsl::Constants;

use crate::scene::templates::{Base, CLUSTER};
use crate::sources::adaptive::grids::{
    BUCKETS, FLAT_CORNER_SHIFT, FLAT_INDICES, GRID_SIZE, INDEX_BUCKET_SHIFT, INDEX_PATCH_MASK,
    INDEX_PATCH_SHIFT, INDEX_PLACE_MASK, INDEX_ROW_SHIFT,
};
use neurotess_picture::Placement;

/// Number of slots that are counted and listed together.
pub(crate) const SECTION: usize = 1024;
const DECISION_KIND_SHIFT: u32 = 28;
/// Bits of a decision's levels if all four are 1.
const FLAT_LEVELS: u32 = 1 | (1 << 7) | (1 << 14) | (1 << 21);
/// Queued clusters have their level above these bits.
const QUEUED_LEVEL_SHIFT: u32 = 24;
/// Queues, by their index among the arguments of indirect dispatches.
pub(crate) const QUEUE_PLAIN: u32 = 0;
pub(crate) const QUEUE_ASKED: u32 = 1;
pub(crate) const QUEUE_SHOWN: u32 = 2;
pub(crate) const QUEUE_SECTIONS: u32 = 0;
pub(crate) const QUEUE_RINGS: u32 = 1;
/// Kind of a lateral patch between two points with implicit rings, in a decision.
pub(crate) const DECIDED_TUBE: u32 = 4;

/// Twin of `Frame` in placed.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct FrameUniforms {
    pub(crate) planes: [[f32; 4]; 5],
    pub(crate) slope: f32,
    pub(crate) flat: f32,
    pub(crate) smallest: f32,
    /// Number of a [`FlatIndices`].
    pub(crate) flat_indices: u32,
    /// Index of the first explicit vertex, the same in every batch.
    pub(crate) first_explicit: u32,
    pad: [u32; 3],
    pub(crate) levels: GpuLodCriterion,
    pad_end: [u32; 3],
}

/// What the index of a vertex of a flat patch says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum FlatIndices {
    /// The corner's place among the batch's corners, which patches share.
    #[default]
    Places,
    /// The same, and which corner of its patch it is: for wireframes.
    Corners,
    /// The patch's slot, and which of its corners it is: for color keys.
    Slots,
}

impl FrameUniforms {
    pub(crate) fn new(view: &CullView, settings: &AdaptiveSettings, flat: FlatIndices) -> Self {
        Self {
            planes: view.planes.map(|plane| plane.to_array()),
            slope: view.pixel.slope as f32,
            flat: view.pixel.flat as f32,
            smallest: settings.smallest.max(0.0),
            flat_indices: flat as u32,
            first_explicit: 0,
            pad: [0; 3],
            levels: GpuLodCriterion::new(settings.lod, &settings.options()),
            pad_end: [0; 3],
        }
    }
}

/// One part of a template where an instance puts it. Twin of the struct of the same name in
/// placed.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Placed {
    /// Rows of the transform from the part's coordinates to those relative to the eye.
    pub(crate) row_x: [f32; 4],
    pub(crate) row_y: [f32; 4],
    pub(crate) row_z: [f32; 4],
    /// The eye in the part's coordinates.
    pub(crate) eye: [f32; 3],
    pub(crate) scale: f32,
    pub(crate) forward: [f32; 3],
    pub(crate) near: f32,
    pub(crate) base: Base,
    pub(crate) first_slot: u32,
    pub(crate) patches: u32,
    pub(crate) instance: u32,
    pub(crate) state: u32,
    pub(crate) first_explicit: u32,
}

impl Placed {
    /// With a transform and a view only; the fields from `base` on are for the caller to set.
    pub(crate) fn new(view: &CullView, placement: &Placement, origin: DVec3) -> Self {
        let linear = placement.linear();
        // Subtracted in f64, where large coordinates cancel; the difference fits an f32.
        let at = placement.world_from_cell(origin) - view.eye;
        let rows = linear.transpose();
        let row = |axis: DVec3, at: f64| axis.as_vec3().extend(at as f32).to_array();
        let view = view.local_view(placement, origin);
        Self {
            row_x: row(rows.x_axis, at.x),
            row_y: row(rows.y_axis, at.y),
            row_z: row(rows.z_axis, at.z),
            eye: view.eye.to_array(),
            scale: placement.scale as f32,
            forward: view.forward.to_array(),
            near: view.near,
            ..Self::default()
        }
    }

    /// Coordinates relative to the eye, as `relative` in placed.wgsl.
    pub(crate) fn relative(&self, p: Vec3) -> Vec3 {
        let q = p.extend(1.0);
        let along = |row: [f32; 4]| Vec4::from_array(row).dot(q);
        Vec3::new(along(self.row_x), along(self.row_y), along(self.row_z))
    }
}

/// Placed parts that are drawn together. Twin of the struct `Batch` in placed.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct BatchUniforms {
    /// First and number of placed parts.
    pub(crate) first: u32,
    pub(crate) placed: u32,
    pub(crate) slots: u32,
    pub(crate) clusters: u32,
    pub(crate) sections: u32,
    /// Number of explicit vertices.
    pub(crate) explicit_vertices: u32,
}

/// Levels of the four sides and the kind of a patch in one u32. Twin of `decision` in placed.wgsl.
#[cfg(test)]
pub(crate) fn decision(kind: u32, levels: [u32; 4]) -> u32 {
    let sides = levels[0] | (levels[1] << 7) | (levels[2] << 14) | (levels[3] << 21);
    sides | (kind << DECISION_KIND_SHIFT)
}

/// Kind and levels of a decision that is not 0.
pub(crate) fn decided(bits: u32) -> (u32, [u32; 4]) {
    let levels = [0, 7, 14, 21].map(|shift| (bits >> shift) & 0x7f);
    ((bits >> DECISION_KIND_SHIFT) & 7, levels)
}

/// Constants that the shaders of a frame share with Rust.
pub(crate) fn constants() -> Constants {
    let mut constants = gpu::constants();
    for (name, value) in [
        ("CLUSTER", CLUSTER as u32),
        ("POINTS_OF_CLUSTER", CLUSTER as u32 / 4),
        ("CLUSTERS_OF_GROUP", 4),
        ("FLAT_INDICES", FLAT_INDICES),
        ("FLAT_CORNER_SHIFT", FLAT_CORNER_SHIFT),
        ("FLAT_LEVELS", FLAT_LEVELS),
        ("FLAT_PLACES", FlatIndices::Places as u32),
        ("FLAT_SLOTS", FlatIndices::Slots as u32),
        ("QUEUED_LEVEL_SHIFT", QUEUED_LEVEL_SHIFT),
        ("QUEUE_PLAIN", QUEUE_PLAIN),
        ("QUEUE_ASKED", QUEUE_ASKED),
        ("QUEUE_SHOWN", QUEUE_SHOWN),
        ("QUEUE_SECTIONS", QUEUE_SECTIONS),
        ("QUEUE_RINGS", QUEUE_RINGS),
        ("SECTION", SECTION as u32),
        ("BUCKETS", BUCKETS as u32),
        ("GRID_SIZES", GRID_SIZE.len() as u32),
        ("DECISION_KIND_SHIFT", DECISION_KIND_SHIFT),
        ("DECIDED_TUBE", DECIDED_TUBE),
        ("INDEX_PLACE_MASK", INDEX_PLACE_MASK),
        ("INDEX_ROW_SHIFT", INDEX_ROW_SHIFT),
        ("INDEX_PATCH_SHIFT", INDEX_PATCH_SHIFT),
        ("INDEX_PATCH_MASK", INDEX_PATCH_MASK),
        ("INDEX_BUCKET_SHIFT", INDEX_BUCKET_SHIFT),
    ] {
        constants.u32(name, value);
    }
    constants.u32s("GRID_SIZE", &GRID_SIZE);
    constants
}

#[cfg(test)]
mod tests {
    use neurotess_picture::Camera;

    use super::*;

    #[test]
    fn decisions_keep_their_levels_and_kind() {
        for levels in [[1, 2, 3, 4], [64, 64, 64, 64], [1, 64, 17, 33]] {
            for kind in 0..=DECIDED_TUBE {
                assert_eq!(decided(decision(kind, levels)), (kind, levels));
            }
        }
    }

    #[test]
    fn far_instances_keep_their_digits() {
        let placement = Placement {
            translation: DVec3::new(1e6, -2e6, 3e6),
            ..Placement::default()
        };
        let camera = Camera::new(
            placement.translation + DVec3::Z,
            placement.translation,
            DVec3::Y,
            0.5,
        )
        .expect("a camera");
        let view = CullView::new(&camera, 100, 100, 0.01);
        let placed = Placed::new(&view, &placement, DVec3::ZERO);
        let p = Vec3::new(0.125, 0.25, 0.001);
        assert_eq!(placed.relative(p), p - Vec3::Z);
        assert_eq!(placed.eye, [0.0, 0.0, 1.0]);
    }
}
