//! From a tracing to the mesh that a purpose needs: one value of options, one call.
//!
//! ```
//! use neurotess_recipe::{MeshOptions, mesh, read};
//!
//! # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples");
//! # let out = std::env::temp_dir().join(format!("neurotess-recipe-{}.ply", std::process::id()));
//! let tracing = read(format!("{folder}/granule.swc"))?;
//! let cell = mesh(&tracing, &MeshOptions::simulation())?;
//! assert!(cell.report().closed);
//! cell.save(&out)?;
//! # std::fs::remove_file(out)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What makes a mesh for simulators of a tracing is here: branches that were traced through one another are moved apart,
//! what still crosses is merged or pressed in, holes that merging leaves are filled, triangles become such as solvers
//! like, and tubes that would close a loop become thinner. The parts are those of `generate`, `refine` and `union`.
#![forbid(unsafe_code)]

/// Raised when the same tracing and options give another mesh than before: what keeps meshes from one build to the next
/// compares it.
pub const MESHES: u32 = 5;

mod cell_mesh;
mod checks;
mod error;
mod files;
pub mod memory;
mod merged;
mod named;
mod names;
mod options;
mod pieces;
mod refined;
mod report;
mod soma_mesh;
mod surface;
mod thinning;
mod tracing;
mod value;
mod verdict;
mod warning;
mod words;

pub use cell_mesh::{CellMesh, mesh, mesh_from, mesh_watched};
pub use error::{MeshError, OptionsError};
pub use files::{
    CellFiles, FileOptions, FileSurface, PartFile, SaveError, SaveOptions, Saved, WrittenFiles,
    part_file,
};
pub use merged::Merged;
pub use named::NamedOptions;
pub use names::{MeshOption, Spelling};
pub use neurotess_mesh::{Progress, Stage, Watch};
pub use options::{Crossings, Levels, MeshOptions, Purpose, Radii, SIMULATION_ASPECT};
pub use report::{CrossingsReport, MeshReport, SeparationReport, SmoothingReport};
pub use surface::CellSurface;
pub use tracing::{Tracing, read, read_with};
pub use value::OptionValue;
pub use warning::{SurfaceWarning, Warning};
pub use words::{KINDS, neurite_kinds};
