//! What keeps a cell from being meshed.

use std::path::PathBuf;

use neurotess_generate::GenerateError;
use neurotess_mesh::{Format, Unsound};
use neurotess_union::UnionError;

use crate::memory::TooLittleMemory;
use crate::words::RINGS;
use crate::{MeshOption, Spelling};

/// Options that are wrong, or do not fit together. Displayed with the names of fields;
/// [`told`](OptionsError::told) has others.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", self.told(Spelling::Field))]
#[non_exhaustive]
pub enum OptionsError {
    /// A value that an option does not take.
    Value {
        /// The option.
        option: MeshOption,
        /// The value.
        value: String,
        /// What is wrong with it, or what is needed.
        needed: String,
    },
    /// A word that an option does not know.
    Word {
        /// The option.
        option: MeshOption,
        /// The word.
        value: String,
        /// Those that it knows.
        words: String,
    },
    /// No option has this name.
    Unknown {
        /// The name.
        name: String,
    },
    /// Two options say the same, or opposite things.
    Conflict {
        /// One of them.
        option: MeshOption,
        /// The other.
        with: MeshOption,
    },
    /// Limits of edges, which have no lengths of their own.
    NeedsIsotropic,
    /// Subdivisions along neurites of the coarse mesh.
    NeedsLevel,
    /// The shortest edge is longer than the longest one.
    EdgeLimits,
    /// Radii that make up for polygons whose sides are not known.
    UnknownSides,
    /// Quads are asked for where what crosses is merged.
    MergedQuads,
    /// A mesh for solvers whose crossings are kept.
    CrossingSimulation,
    /// A format without quads.
    NoQuads(Format),
    /// A format that does not tell walls from the membrane.
    NoRegions(Format),
    /// Walls in a surface of quads.
    WalledQuads,
    /// A format without materials.
    NoMaterials(Format),
    /// A format without colors of vertices.
    NoColors(Format),
    /// A format that is not compressed.
    NoCompression(Format),
    /// Materials where triangles are compressed.
    CompressedMaterials,
    /// A value that has no name.
    Unnamed(MeshOption),
}

impl OptionsError {
    /// A first ring that there cannot be.
    pub(crate) fn ring(neurite: u32, position: f64) -> Self {
        Self::Value {
            option: MeshOption::Ring,
            value: format!("{neurite}={position}"),
            needed: RINGS.to_owned(),
        }
    }

    /// What is wrong, with options named as whoever set them wrote them.
    pub fn told(&self, spelling: Spelling) -> String {
        use MeshOption as O;
        let name = |option: MeshOption| option.spelled(spelling);
        match self {
            Self::Value {
                option,
                value,
                needed,
            } => format!("invalid value '{value}' for '{}': {needed}", name(*option)),
            Self::Word {
                option,
                value,
                words,
            } => format!(
                "invalid value '{value}' for '{}' [possible values: {words}]",
                name(*option)
            ),
            Self::Unknown { name } => format!("there is no option '{name}'"),
            Self::Conflict { option, with } => {
                format!("'{}' cannot be used with '{}'", name(*option), name(*with))
            }
            Self::NeedsIsotropic => format!(
                "{}, {} and {} are for {}: add it",
                name(O::MaxEdge),
                name(O::MinEdge),
                name(O::MaxAspect),
                name(O::Isotropic)
            ),
            Self::NeedsLevel => {
                format!(
                    "{} needs a {} of 1 or more",
                    name(O::LevelAlong),
                    name(O::Level)
                )
            }
            Self::EdgeLimits => match spelling {
                Spelling::Field => "the shortest edge of levels is longer than the longest".into(),
                _ => format!("{} is longer than {}", name(O::MinEdge), name(O::MaxEdge)),
            },
            Self::UnknownSides => format!(
                "{} must know how many sides neurites get: use {} or {} instead of {}",
                O::Radii.set_to("equal-area", spelling),
                name(O::Level),
                name(O::Isotropic),
                name(O::MaxError)
            ),
            Self::MergedQuads => format!(
                "merging leaves triangles only: leave out {} or {}",
                name(O::Quads),
                name(O::Crossings)
            ),
            Self::CrossingSimulation => format!(
                "solvers take no mesh that crosses itself: use {} or {}",
                O::Crossings.set_to("separate", spelling),
                O::Crossings.set_to("merge", spelling)
            ),
            Self::NoQuads(format) => format!(
                "{format} holds triangles only: leave out {}, or write ply, obj, off or vtu",
                name(O::Quads)
            ),
            Self::NoRegions(format) => format!(
                "{format} cannot tell walls from the membrane: leave out {}, or write msh, msh2, poly or smesh",
                name(O::Walls)
            ),
            Self::WalledQuads => format!(
                "walls are made of triangles: leave out {}, or {} and level 0",
                name(O::Walls),
                name(O::Quads)
            ),
            Self::NoMaterials(format) => format!(
                "{format} knows no materials: leave out {}, or write obj or glb",
                name(O::Materials)
            ),
            Self::NoColors(format) => format!(
                "{format} has no colors of vertices: leave out {}{}, or write glb, ply or vtu",
                name(O::ColorBy),
                match format {
                    Format::Obj => format!(", use {}", name(O::Materials)),
                    _ => String::new(),
                }
            ),
            Self::NoCompression(format) => format!(
                "only glb is compressed, {format} is not: leave out {}, or write glb",
                name(O::Compress)
            ),
            Self::CompressedMaterials => format!(
                "compressed types could not share their vertices, and the mesh would not be closed: use {} instead of {}",
                O::ColorBy.set_to("type", spelling),
                name(O::Materials)
            ),
            Self::Unnamed(option) => format!("this value of {} has no name", name(*option)),
        }
    }
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
    /// The file with the soma's surface cannot be used.
    #[error("{}: {found}", file.display())]
    SomaMesh {
        /// The file.
        file: PathBuf,
        /// What is wrong, and what to do.
        found: String,
    },
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
    /// Indices of vertices have 32 bits.
    #[error("the surface would have {0} vertices, of which 4294967295 at most can be told apart")]
    TooManyVertices(usize),
    /// There is too little memory to merge what crosses.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
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

impl MeshError {
    /// What is wrong, and what to do, with options named as whoever set them wrote them.
    pub fn told(&self, spelling: Spelling) -> String {
        use MeshOption as O;
        let name = |option: MeshOption| option.spelled(spelling);
        let remedy = match self {
            Self::Options(error) => return error.told(spelling),
            Self::Empty => format!(": check {} and {}", name(O::Types), name(O::Soma)),
            Self::TooManyVertices(_) | Self::Memory(_) => format!(
                ": lower {}, or choose {}",
                name(O::Level),
                name(O::MaxError)
            ),
            Self::StillCrosses { .. } => format!(": try another {}", name(O::Level)),
            Self::CutOff { .. } => format!(
                ": mend the tracing there, or use {}",
                O::Crossings.set_to("merge", spelling)
            ),
            Self::NotManifold | Self::FellApart { .. } => format!(
                ": use {} and look at it with neurotess check",
                O::Crossings.set_to("merge", spelling)
            ),
            Self::Generate(_)
            | Self::SomaMesh { .. }
            | Self::Merge(_)
            | Self::Unsound(_)
            | Self::Stopped => String::new(),
        };
        format!("{self}{remedy}")
    }
}
