//! What a refinement can be told.

/// How finely each edge is refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Levels<'a> {
    /// The same level, 1 to 64, everywhere.
    Homogeneous(u32),
    /// A level, 1 to 64, per tracing point of the mesh.
    PerPoint(&'a [u8]),
    /// As fine as keeps the surface within this distance (µm) of the level-64 surface.
    MaxError(f32),
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
