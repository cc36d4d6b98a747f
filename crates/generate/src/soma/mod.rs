//! Somata: where each neurite's first ring is, and the surface between them.

mod cholesky;
mod elasticity;
pub(crate) mod first_rings;
mod flow;
mod insertion_quads;
mod profile;
mod somata;
mod sphere;
pub(crate) mod stems;
mod surface;
mod trials;
mod warp;

pub(crate) use first_rings::SOMA_LIFT;
pub(crate) use somata::{BuiltSoma, build, soma_spheres};
pub(crate) use surface::SomaSurface;
