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

mod cell_mesh;
mod error;
mod merged;
mod options;
mod pieces;
mod refined;
mod report;
mod save;
mod surface;
mod thinning;
mod tracing;
mod verdict;
mod warning;
mod watch;

pub use cell_mesh::{CellMesh, mesh, mesh_watched};
pub use error::{MeshError, OptionsError};
pub use merged::Merged;
pub use options::{Crossings, Levels, MeshOptions, Purpose, SIMULATION_ASPECT};
pub use report::{CrossingsReport, MeshReport, SeparationReport, SmoothingReport};
pub use save::SaveError;
pub use surface::CellSurface;
pub use tracing::{Tracing, read};
pub use warning::{SurfaceWarning, Warning};
pub use watch::Watch;
