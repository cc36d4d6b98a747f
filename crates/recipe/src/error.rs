//! What keeps a cell from being meshed.

use neurotess_generate::GenerateError;
use neurotess_mesh::Unsound;
use neurotess_union::UnionError;

/// Options that do not fit together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OptionsError {
    /// Quads are asked for where what crosses is merged.
    #[error("merging leaves triangles only: leave out quads, or keep crossings")]
    MergedQuads,
    /// A mesh for solvers whose crossings are kept.
    #[error(
        "solvers take no mesh that crosses itself: its crossings are to be separated or merged"
    )]
    CrossingSimulation,
}

/// Why there is no mesh of a cell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// Options that do not fit together.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// There is no coarse mesh.
    #[error(transparent)]
    Generate(#[from] GenerateError),
    /// The options leave nothing of the cell.
    #[error("nothing is left to mesh")]
    Empty,
    /// What crosses cannot be merged.
    #[error("what crosses cannot be merged: {0}")]
    Merge(#[from] UnionError),
    /// Triangles cross after merging.
    #[error("{pairs} pairs of triangles still cross after merging, first near sample {sample}")]
    StillCrosses {
        /// Pairs of triangles.
        pairs: usize,
        /// The file's number of a sample nearby; −1 where none is known.
        sample: i32,
    },
    /// A fault of ours.
    #[error(transparent)]
    Unsound(#[from] Unsound),
    /// The mesh for solvers is not closed.
    #[error("the merged surface is not a closed manifold")]
    NotManifold,
    /// A piece of the mesh for solvers hangs on nothing.
    #[error("a piece of the tracing near sample {sample} was cut off")]
    CutOff {
        /// The file's number of a sample nearby.
        sample: i32,
    },
    /// The mesh for solvers has more pieces than the tracing.
    #[error("the surface fell into {pieces} pieces, of {traced} in the tracing")]
    FellApart {
        /// Pieces of the mesh.
        pieces: usize,
        /// Pieces of the tracing.
        traced: usize,
    },
    /// Another thread stopped it.
    #[error("stopped")]
    Stopped,
}
