//! Pictures of neurons by the processor: no graphics driver, and the same bytes on every machine.
//!
//! A [`Scene`] has templates, and instances of them, as the GPU's have (`neurotess-render`); so have cameras, colors and
//! looks (`neurotess-picture`). [`draw`] draws a picture of any size band by band; [`StaticPicture`] is one that is colored
//! anew without being drawn anew.
//!
//! ```text
//! select (scene) ─▶ refine, project (geometry) ─▶ bins ─▶ samples (triangle, fragment) ─▶ light ─▶ occlusion ─▶ bytes
//! ```
//!
//! **Theory.** Triangles are binned by tile and rasterized with edge functions in whole numbers (Pineda, A parallel
//! algorithm for polygon rasterization, 1988; Abrash, Rasterization on Larrabee, 2009). A sample holds its depth, its
//! normal and its color, and is lit afterwards, when all that hid it is gone (Deering et al., The triangle processor and
//! normal vector shader, 1988). The pictures are those of the shaders, of which the files here name their twins.
//!
//! **Equal bytes.** Steps depend neither on tiles nor on threads, and use what IEEE 754 defines: sums, products, quotients
//! and roots of 32 bits in one order; sines and powers come from tables that `libm` fills.
#![forbid(unsafe_code)]

mod bands;
mod bins;
mod bytes;
mod cost;
mod fragment;
mod geometry;
mod grid;
mod light;
mod markers;
mod masks;
mod meshes;
mod occlusion;
mod painting;
mod picture;
mod projection;
mod recolor;
mod sample;
mod scene;
mod select;
mod sheet;
mod triangle;

pub use bands::bands;
pub use cost::{Cost, PictureError};
pub use markers::SceneMarkers;
pub use meshes::SceneMesh;
pub use picture::draw;
pub use recolor::{StaticPicture, draw_static};
pub use scene::Scene;
