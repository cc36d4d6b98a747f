//! Options of a refinement.

use glam::Vec3;

/// What decides on the level of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LodCriterion {
    /// The same level, 1 to 64, everywhere.
    Homogeneous(u32),
    /// A level, 1 to 64, for each tracing point: [`Lod::point_levels`].
    PerPoint,
    /// So fine that the surface is within this distance (µm) of the level-64 surface.
    MaxError(f32),
    /// García-Cantero et al. 2017: `level × clamp(1 − d / far, 0, 1)` with the distance d (µm) to
    /// the eye, as the mean of an edge's two ends.
    Distance {
        /// Level at the eye, 1 to 64.
        level: u32,
        /// Distance (µm) from which on the level is 1.
        far: f32,
    },
    /// So fine that no refined edge is longer than this many pixels.
    PixelSize(f32),
    /// So fine that the surface is within this many pixels of the level-64 surface.
    PixelError(f32),
}

impl Default for LodCriterion {
    /// Half a pixel, which cannot be seen.
    fn default() -> Self {
        Self::PixelError(0.5)
    }
}

impl LodCriterion {
    /// The same criterion in the coordinates of a template that is shown `scale` times its size.
    pub fn scaled(self, scale: f64) -> Self {
        let scale = scale as f32;
        match self {
            Self::MaxError(error) => Self::MaxError(error / scale),
            Self::Distance { level, far } => Self::Distance {
                level,
                far: far / scale,
            },
            other => other,
        }
    }

    /// The same criterion, `factor` times as coarse.
    pub fn coarser(self, factor: f32) -> Self {
        let level = |level: u32| ((level as f32 / factor).round() as u32).max(1);
        match self {
            Self::Homogeneous(l) => Self::Homogeneous(level(l)),
            Self::PerPoint => Self::PerPoint,
            Self::MaxError(error) => Self::MaxError(error * factor),
            Self::Distance { level: l, far } => Self::Distance {
                level: level(l),
                far,
            },
            Self::PixelSize(pixels) => Self::PixelSize(pixels * factor),
            Self::PixelError(pixels) => Self::PixelError(pixels * factor),
        }
    }

    /// Whether levels depend on the view: [`Lod::view`].
    pub fn needs_view(self) -> bool {
        match self {
            Self::Distance { .. } | Self::PixelSize(_) | Self::PixelError(_) => true,
            Self::Homogeneous(_) | Self::PerPoint | Self::MaxError(_) => false,
        }
    }
}

/// All that the levels of one mesh depend on.
///
/// ```
/// use neurotess_refine::{Lod, LodCriterion};
/// let everywhere: Lod<'_> = LodCriterion::Homogeneous(4).into();
/// let levels = [1, 4, 16];
/// let by_point = Lod::per_point(&levels);
/// assert_eq!(everywhere.point_levels.len() + by_point.point_levels.len(), 3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lod<'a> {
    /// What decides on levels.
    pub criterion: LodCriterion,
    /// The view, in the mesh's own coordinates; used if [`LodCriterion::needs_view`].
    pub view: LodView,
    /// A level, 1 to 64, per tracing point; used by [`LodCriterion::PerPoint`]. Missing ones are 1.
    pub point_levels: &'a [u8],
    /// Levels of edges by their kind, instead of the criterion: for meshes that are exported. Devices that
    /// draw have no such rule.
    pub edges: Option<EdgeRule>,
}

/// Levels of edges by their kind: along the path of a neurite or around it.
///
/// As any level, one depends on its edge alone: the surface stays closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeRule {
    /// The same everywhere.
    Levels {
        /// Of edges around a neurite and on somata, 1 to 64.
        around: u32,
        /// Of edges along a neurite, 1 to 64.
        along: u32,
    },
    /// Pieces about as long as a share of the local radius: triangles that solvers like. At most 64 of an edge,
    /// or 256 along a neurite.
    Lengths {
        /// Length of a piece, in radii of the thinner end.
        radii: f32,
        /// How many times as long as that pieces along a neurite may be. With 1 or less they are about as long;
        /// with more only a few are longer, where a neurite bends.
        aspect: f32,
        /// Least length of a piece (µm).
        least: f32,
        /// Greatest length of a piece (µm), whatever the radius.
        most: f32,
    },
}

impl<'a> Lod<'a> {
    /// Levels of edges by their kind.
    pub fn by_edge(rule: EdgeRule) -> Self {
        Self {
            edges: Some(rule),
            ..Self::default()
        }
    }

    /// Levels by a criterion, in this view.
    pub fn seen_from(criterion: LodCriterion, view: LodView) -> Self {
        Self {
            criterion,
            view,
            point_levels: &[],
            edges: None,
        }
    }

    /// A level, 1 to 64, per tracing point of the mesh.
    pub fn per_point(point_levels: &'a [u8]) -> Self {
        Self {
            criterion: LodCriterion::PerPoint,
            view: LodView::default(),
            point_levels,
            edges: None,
        }
    }
}

impl From<LodCriterion> for Lod<'_> {
    fn from(criterion: LodCriterion) -> Self {
        Self::seen_from(criterion, LodView::default())
    }
}

/// What levels depend on of a camera, in the mesh's own coordinates.
///
/// A pixel at depth z (µm along `forward` from `eye`, at least `near`) is `slope z + flat` µm wide:
/// `flat` is 0 in perspective, `slope` 0 without.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LodView {
    /// Position of the eye (µm).
    pub eye: Vec3,
    /// Unit viewing direction.
    pub forward: Vec3,
    /// Growth of a pixel's size with the depth.
    pub slope: f32,
    /// Size (µm) of a pixel at depth 0.
    pub flat: f32,
    /// Depth (µm) of the near plane.
    pub near: f32,
}

/// The shape of the path between tracing points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Path {
    /// A cubic Hermite curve.
    #[default]
    Hermite,
    /// A straight line.
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

/// Options of shape and output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefineOptions {
    /// Shape of the path between tracing points.
    pub path: Path,
    /// Shape of the ends.
    pub caps: Caps,
    /// Whether cells with four different corners are quads instead of two triangles.
    pub quads: bool,
    /// What [`SurfaceVertex::point`](neurotess_mesh::SurfaceVertex::point) says.
    pub numbers: PointNumbers,
}

/// Numbers of the points of a surface's vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointNumbers {
    /// Those that the file has for its samples.
    #[default]
    OfSamples,
    /// Indices of the mesh's tracing points: for what looks up what belongs to each.
    OfTracing,
}
