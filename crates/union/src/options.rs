//! What a union is told, and why it may fail.

use neurotess_mesh::Stopped;
use thiserror::Error;

/// What a union is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnionOptions {
    /// How often the surface may be cut: rounding can make new crossings, seldom more than once. From the third
    /// time on, what crosses is pressed in a little beforehand.
    pub rounds: u32,
    /// Faces at seams are tidied if their height or shortest side is below this share of the local radius;
    /// 0 leaves them.
    pub needles: f64,
    /// How far vertices of seams go to the middle of their neighbors in each of three steps: 0 not at all,
    /// 1 all the way.
    pub smoothing: f64,
    /// Surfaces that cross are pressed in by up to this share of their radius before they are merged; 0: not.
    pub press: f64,
    /// Holes that merging has made and that a loop of up to this many circumferences of the branches goes around are
    /// filled; 0: none.
    pub fill: f64,
    /// Pieces that merging cut off, where a tube is inside out, are joined again by the hull of the surface between.
    pub rejoin: bool,
    /// Angles (degrees) below this are made larger where the surface allows it, wherever they are, and nearly flat pairs of
    /// triangles get the better diagonal; 0 leaves all as they are.
    pub least_angle: f64,
}

impl Default for UnionOptions {
    /// What gave meshes without crossings that TetGen takes on real cells.
    fn default() -> Self {
        Self {
            rounds: 8,
            needles: 0.05,
            smoothing: 0.4,
            press: 0.0,
            fill: 0.0,
            rejoin: true,
            least_angle: 0.0,
        }
    }
}

/// Why there is no union.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum UnionError {
    /// A face names a vertex that is not there.
    #[error("a face names vertex {0}, which is not there")]
    MissingVertex(u32),
    /// A position is infinite or not a number.
    #[error("the position of vertex {0} is not finite")]
    NotFinite(usize),
    /// The surface has an edge without two faces of opposite direction.
    #[error("the surface is not closed and oriented: what it encloses is not defined")]
    NotClosed,
    /// More faces cross than can be cut in any reasonable time.
    #[error("more than {0} pairs of faces cross")]
    TooMany(usize),
    /// The faces near crossings could not be arranged.
    #[error("the faces that cross could not be cut: {0}")]
    Failed(String),
    /// Another thread stopped it: [`union_watched`](crate::union_watched).
    #[error(transparent)]
    Stopped(#[from] Stopped),
}
