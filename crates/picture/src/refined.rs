//! How a scene is refined as it is drawn, and for which view.

use glam::{DVec3, Vec4};
use neurotess_refine::{Caps, LodCriterion, LodView, Path, RefineOptions};

use crate::placement::Placement;
use crate::view::camera::Camera;
use crate::view::lens::PixelSize;

/// A camera and a picture's size, in the form that culling and the selection of levels take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CullView {
    /// Position of the eye (µm).
    pub eye: DVec3,
    /// Unit direction of view.
    pub forward: DVec3,
    /// Planes of the frustum relative to the eye, unit normals inwards. Those of the tile if a
    /// picture is drawn in tiles.
    pub planes: [Vec4; 5],
    /// Size (µm) of a pixel by depth.
    pub pixel: PixelSize,
    /// Depth (µm) of the near plane.
    pub near: f64,
}

impl CullView {
    /// The view of a whole picture of this size (pixels).
    pub fn new(camera: &Camera, width: u32, height: u32, near: f64) -> Self {
        let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
        Self {
            eye: camera.eye(),
            forward: -camera.axes()[2],
            planes: camera.frustum(aspect, near),
            pixel: camera.pixel_size(f64::from(height.max(1))),
            near,
        }
    }

    /// The view that levels are selected for, in the coordinates of a template at a placement.
    pub fn local_view(&self, placement: &Placement, origin: DVec3) -> LodView {
        LodView {
            eye: (placement.cell_from_world(self.eye) - origin).as_vec3(),
            forward: (placement.rotation.inverse() * self.forward).as_vec3(),
            slope: self.pixel.slope as f32,
            flat: self.pixel.flat as f32 / placement.scale as f32,
            near: (self.near / placement.scale) as f32,
        }
    }
}

/// How a frame is refined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AdaptiveSettings {
    /// What decides on the levels.
    pub lod: LodCriterion,
    /// Shape of the path between tracing points.
    pub path: Path,
    /// Shape of the ends.
    pub caps: Caps,
    /// What is smaller than this many pixels is left out; 0 leaves out nothing.
    pub smallest: f32,
    /// Whether vertices know their position in their patch's grid, as [`Look::wire`](crate::Look)
    /// needs. Patches at level 1 then do not share corners, which costs time.
    pub wireframe: bool,
}

impl AdaptiveSettings {
    /// The same settings for refinement on the CPU.
    pub fn options(&self) -> RefineOptions {
        RefineOptions {
            path: self.path,
            caps: self.caps,
            ..RefineOptions::default()
        }
    }
}

/// Triangles of a frame by default: so many a laptop draws smoothly.
pub const DEFAULT_BUDGET: u32 = 100_000;
/// Most triangles of a frame.
pub const MAX_BUDGET: u32 = 1 << 23;
