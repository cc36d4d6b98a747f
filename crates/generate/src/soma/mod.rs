//! Somata: where each neurite's first ring is, and the surface between them.

mod cholesky;
mod draft;
mod elasticity;
pub(crate) mod first_rings;
mod flow;
pub(crate) mod hubs;
mod insertion_quads;
mod measure;
pub(crate) mod near_forks;
mod profile;
mod pull;
mod reference;
mod site;
mod soma_surface;
mod somata;
mod sphere;
pub(crate) mod stems;
pub(crate) mod stubs;
mod surface;
mod trials;
mod warp;

pub(crate) use reference::{AsNeurites, soma_spheres};
pub(crate) use site::collar;
pub(crate) use soma_surface::SomaSurface;
pub(crate) use somata::{BuiltSoma, build};
