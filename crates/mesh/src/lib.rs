//! Model 2 of neurotess: the **coarse mesh** of quad **patches**, and the **surfaces** refined from
//! it. No morphology and no GPU: what a face shows of the cell travels as attributes.
#![forbid(unsafe_code)]

mod coarse;
mod surface;

pub use coarse::{CoarseMesh, Patch, PatchKind, Role, TracingPoint, Vertex};
pub use surface::{Faces, Surface, SurfaceMesh, SurfaceVertex};
