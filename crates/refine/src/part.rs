//! A part of a packed mesh: its packed buffer, and where the arrays begin in it.

use glam::Vec3;
use neurotess_mesh::TracingPoint;

use crate::decode::POINTS_OF_SPHERE;

/// Number of patches that share a bounding sphere.
pub const PATCHES_OF_SPHERE: usize = 4 * POINTS_OF_SPHERE;
/// Most different color keys of a part's points: their indices have 10 bits.
pub(crate) const MAX_COLOR_KEYS: usize = 1 << 10;

/// Where the arrays of a part begin in its packed buffer, in u32s, and how many there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PartLayout {
    /// Points.
    pub points: u32,
    /// Number of points.
    pub point_count: u32,
    /// Bounding spheres.
    pub spheres: u32,
    /// Explicit vertices.
    pub explicit: u32,
    /// Anchors.
    pub anchors: u32,
    /// Shaped rings.
    pub shaped: u32,
    /// Somata's patches.
    pub soma: u32,
    /// Number of somata's patches.
    pub soma_count: u32,
    /// Other explicit patches.
    pub quads: u32,
    /// Caps.
    pub caps: u32,
    /// Color keys.
    pub color_keys: u32,
}

/// A part of a coarse mesh, small enough for a device to bind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshPart {
    /// The buffer to be uploaded.
    pub packed: Vec<u32>,
    /// Where its arrays begin.
    pub layout: PartLayout,
    /// By slot: index of the mesh's patch, or `u32::MAX` if the slot is empty.
    pub patches: Vec<u32>,
    /// Index of the mesh's vertex by explicit vertex, then by corner of each shaped ring.
    pub explicit: Vec<u32>,
    /// Bounding sphere (µm) of each [`PATCHES_OF_SPHERE`] slots, at any level.
    pub spheres: Vec<(Vec3, f32)>,
    /// Vertices of the mesh in this part: index, and position and normal as shaders read them.
    pub(crate) vertices: Vec<(u32, Vec3, Vec3)>,
    /// Tracing points in this part: index, and the point as shaders read it.
    pub(crate) tracing: Vec<(u32, TracingPoint)>,
}

impl MeshPart {
    /// Bytes of each array, by its name.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let p = &self.layout;
        let names = [
            "points",
            "spheres",
            "explicit_vertices",
            "anchors",
            "shaped_rings",
            "soma_patches",
            "explicit_patches",
            "caps",
            "color_keys",
        ];
        let starts = [
            p.points,
            p.spheres,
            p.explicit,
            p.anchors,
            p.shaped,
            p.soma,
            p.quads,
            p.caps,
            p.color_keys,
        ];
        let ends = starts[1..]
            .iter()
            .copied()
            .chain([self.packed.len() as u32]);
        let sizes = starts
            .iter()
            .zip(ends)
            .map(|(start, end)| u64::from(end - start) * 4);
        names.into_iter().zip(sizes).collect()
    }
}
