//! What a refinement can be told.

use glam::Vec3;

/// How finely each edge is refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Levels<'a> {
    /// The same level, 1 to 64, everywhere.
    Homogeneous(u32),
    /// A level, 1 to 64, per tracing point of the mesh.
    PerPoint(&'a [u8]),
    /// As fine as keeps the surface within this distance (µm) of the level-64 surface.
    MaxError(f32),
    /// García-Cantero et al. 2017: `level × clamp(1 − d / far, 0, 1)`, d the distance to the eye,
    /// the mean of an edge's two ends.
    Distance {
        /// From where.
        view: View,
        /// Level at the eye, 1 to 64.
        level: u32,
        /// Distance (µm) from which on the level is 1.
        far: f32,
    },
    /// No piece of an edge longer than this many pixels.
    PixelSize {
        /// From where.
        view: View,
        /// Pixels.
        pixels: f32,
    },
    /// As fine as keeps the surface within this many pixels of the level-64 surface.
    PixelError {
        /// From where.
        view: View,
        /// Pixels.
        pixels: f32,
    },
}

/// What a level needs to know of a camera, in the mesh's own coordinates.
///
/// A pixel at depth z (µm along `forward` from `eye`, at least `near`) is `slope z + flat` µm wide:
/// `flat` is 0 in perspective, `slope` 0 without.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Position of the eye (µm).
    pub eye: Vec3,
    /// Unit direction of sight.
    pub forward: Vec3,
    /// Growth of a pixel's size with the depth.
    pub slope: f32,
    /// Size (µm) of a pixel at depth 0.
    pub flat: f32,
    /// Depth (µm) of the nearest thing seen.
    pub near: f32,
}

/// How the path runs between tracing points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Path {
    /// A cubic Hermite curve.
    #[default]
    Hermite,
    /// Straight.
    Linear,
}

/// How the end of a neurite is closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Caps {
    /// A half sphere.
    #[default]
    Round,
    /// A disk.
    Flat,
}

/// Choices of shape and output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefineOptions {
    /// Course of the path between tracing points.
    pub path: Path,
    /// Shape of the ends.
    pub caps: Caps,
    /// Quads where all four corners differ, instead of two triangles.
    pub quads: bool,
}
