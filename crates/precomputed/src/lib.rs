//! Tracings and circuits as [neuroglancer's precomputed data](https://github.com/google/neuroglancer): what connectomics
//! shares its neurons as.
//!
//! ```text
//! files, circuit ─▶ ids ─▶ plan: files and their cells ─▶ workers ─▶ mesh/ skeletons/
//!                    └────▶ what all share: info, properties/, synapses/, view.json, a link
//! ```
//!
//! [`Export`] writes a folder, [`Server`] shows it to this machine's browsers. A mesh has several levels of detail, each a
//! closed surface of its own, and a place in the world for each cell. All lengths in files are nm.
//!
//! Most faults in such files are silent: neuroglancer shows nothing and says nothing. The rules against them are beside what
//! follows them, each with a test: [`multilod()`], `grid`, `cut`, `octree`, [`skeleton()`], [`write_properties`], [`Sharding`].
#![forbid(unsafe_code)]

mod annotations;
mod cut;
mod error;
mod event;
mod export;
mod facts;
mod folder;
mod grid;
mod gzip;
mod levels;
mod multilod;
mod octree;
mod plan;
mod properties;
mod read_mesh;
mod run;
mod serve;
mod shards;
mod shared;
mod skeleton;
mod source;
mod synapses;
mod table;
mod templates;
mod view;

pub use error::{ExportError, Failure, Fault, IdError};
pub use event::{CellDone, Event, ExportReport};
pub use export::{Export, LOCAL_URL};
pub use grid::Grid;
pub use levels::{LevelOptions, TemplateMesh};
pub use multilod::{MultilodMesh, PlacedLevel, mesh_info, multilod};
pub use properties::{Column, Of, Tag, write_properties};
pub use read_mesh::{MeshReadError, read_mesh};
pub use serve::{ServeError, Server};
pub use shards::{ShardPlace, Sharding};
pub use skeleton::{skeleton, skeleton_info};
pub use view::{View, link_to};
