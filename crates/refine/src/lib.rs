//! Refinement of a coarse mesh: one integer level per edge, one conforming closed surface.
//!
//! A pure function of the coarse mesh and its **levels**. Levels are given for tracing points or
//! follow from an error; an **edge** takes its level from its own two ends only, so that the two
//! patches beside it always agree, and any mixture of levels gives a closed mesh without cracks or
//! T-junctions. A patch is a grid as fine as its finest sides; on a coarser side the grid's outer
//! row snaps to the edge's own vertices, and triangles that become empty are left out.
//!
//! ```text
//!   ┌──┬──┬──┬──┐   finer side, level 4
//!   ├──┼──┼──┼──┤
//!   │╲ │ ╱│╲ │ ╱│
//!   └─────┴─────┘   coarser side, level 2
//! ```
//!
//! This is the reference for the shaders: plain arrays in, no allocation per patch. Four edges or patches of a kind are
//! evaluated at once, by the formulas that shaders have for one. The WGSL twin
//! of a file is beside it under the same stem; [`gpu`] provides the WGSL files, and [`pack`] the
//! packed form of a mesh that they read.
#![forbid(unsafe_code)]

mod anchors;
mod bounding_sphere;
mod coarse_surface;
mod decode;
mod edge;
mod evaluate;
mod explicit;
mod fours;
pub mod gpu;
mod inner;
mod level;
mod options;
mod pack;
mod packed;
mod packer;
mod part;
mod patch_block;
mod patch_points;
mod plan;
mod refinement;
mod ring_form;
mod runs;
#[cfg(feature = "testing")]
pub mod testing;
pub mod wgsl;

pub use bounding_sphere::{patch_sphere, sphere_around};
pub use coarse_surface::CoarseSurface;
pub use decode::{POINTS_OF_SPHERE, SHAPED_U32S};
pub use evaluate::SOMA_FILLET;
pub use level::{HIGHEST_LEVEL, HIGHEST_LEVEL_BY_LENGTH};
pub use options::{Caps, EdgeRule, Lod, LodCriterion, LodView, Path, PointNumbers, RefineOptions};
pub use pack::{dequantized, pack};
pub use part::{MeshPart, PATCHES_OF_SPHERE, PartLayout};
pub use patch_block::PatchBlock;
pub use patch_points::patch_points;
pub use plan::patch_triangles;
pub use refinement::Refinement;
