//! Model 2 of neurotess: the **coarse mesh** of quad **patches**, and the **surfaces** refined from
//! it. No morphology and no GPU: what a face shows of the cell travels as attributes.
//!
//! A [`CoarseMesh`] or a [`SurfaceMesh`] is judged by its indices ([`topology`]), by what it
//! encloses ([`measure`]) and by whether it crosses itself ([`self_intersections`]); [`check`] does
//! all three. Surfaces go to files with [`write()`], block by block, and come back with [`read()`].
//!
//! ```
//! use neurotess_mesh::{Format, SurfaceMesh, SurfaceVertex, check, read_bytes, write};
//!
//! let at = |x: f32, y: f32, z: f32| SurfaceVertex {
//!     position: [x, y, z].into(),
//!     ..SurfaceVertex::default()
//! };
//! let mut mesh = SurfaceMesh::default();
//! mesh.vertices = vec![at(0., 0., 0.), at(1., 0., 0.), at(0., 1., 0.), at(0., 0., 1.)];
//! mesh.faces.triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
//! let mut file = std::io::Cursor::new(Vec::new());
//! write(&mesh, Format::Ply, &mut file)?;
//! let report = check(&read_bytes(&file.into_inner(), Format::Ply)?);
//! assert!(report.closed && report.oriented && report.self_intersections == 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod areas;
mod bvh;
mod bytes;
mod check;
mod coarse;
mod coarse_bytes;
mod crossing;
pub mod draco;
mod face_types;
mod forest;
mod format;
mod forward;
mod gaps;
mod in_unit;
mod intersect;
mod label;
mod measure;
pub mod palette;
mod parting;
mod parts;
mod placed;
mod quality;
mod read;
mod sound;
mod steps;
mod surface;
mod table;
mod topology;
mod unit;
mod walls;
mod watch;
mod watched;
mod weld;
mod write;

pub use areas::{areas_by, section_areas};
pub use bytes::{ByteReader, ByteWriter, BytesError};
pub use check::{Report, check};
pub use coarse::{
    CoarseMesh, Patch, PatchKind, Role, SampleId, SectionNumber, SwcType, TracingPoint, Vertex,
};
pub use forest::Forest;
pub use format::{Format, UnknownFormat};
/// What signatures here name.
pub use glam;
pub use in_unit::InUnit;
pub use intersect::{
    Search, search_self_intersections, search_self_intersections_watched, self_intersections,
    self_intersections_of,
};
pub use label::{FaceLabel, WALL, region_code, region_name, type_of_region};
pub use measure::{Measure, measure, measure_surface};
pub use parts::{Part, Parts};
pub use placed::Placed;
pub use quality::{Quality, quality};
pub use read::{
    FilePosition, OwnAttribute, ReadError, read, read_as, read_bytes, read_bytes_with_attributes,
    read_with_attributes,
};
pub use sound::{Extent, Soundness, Unsound};
pub use steps::Steps;
pub use surface::{Faces, Region, Surface, SurfaceMesh, SurfaceVertex, VertexAttribute};
pub use table::{SurfaceTriangle, write_triangles};
pub use topology::{Topology, genus_by_component, topology};
pub use unit::Unit;
pub use walls::{Walled, with_walls};
pub use watch::{Progress, Stage, Stopped, Watch};
pub use watched::Watched;
pub use weld::merge_identical;
pub use write::{
    ColorBy, Compression, GlbNode, WriteError, WriteOptions, obj_materials, write, write_glb,
    write_with,
};
