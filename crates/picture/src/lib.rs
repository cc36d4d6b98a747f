//! What a picture of neurons is, whoever draws it.
//!
//! A **camera** ([`Camera`]) has a position, a direction and a field of view. A **template** is a coarse mesh, and an
//! [`Instance`] shows one at a [`Placement`]. Each tracing point has a **color key**, and a
//! [`ColorTable`](color::ColorTable) has their colors. [`PictureOptions`] say how large and in what light a picture is
//! drawn; `neurotess-raster` draws it on the processor, `neurotess-render` on the GPU, both in **bands** of rows. An
//! [`Overlay`](overlay::Overlay) draws legend and scale bar over them, and a [`PngWriter`] writes them to a file.
//!
//! This crate draws nothing and knows no device.
#![forbid(unsafe_code)]

pub mod color;
mod image;
mod instance;
mod least_width;
mod look;
pub mod markers;
pub mod meshes;
pub mod octahedral;
mod options;
pub mod overlay;
mod placement;
pub mod recolor;
mod refined;
mod view;
mod watch;

/// Bounding spheres of meshes, and whether they are in view.
pub mod bounds {
    pub use crate::view::bounds::{any_shows, bounds, merged, surface_points, traced};
    pub use crate::view::frustum::shows;
}

/// States of instances, bits of [`Instance::state`](crate::Instance::state).
pub mod state {
    pub use crate::look::{GHOSTED, HIGHLIGHTED, OUTLINED, WITHOUT_NEURITES, WITHOUT_SOMA};
}

pub use image::{Image, PngWriter, png_text};
pub use instance::{Instance, SceneError, Template, TemplateId, check_placement};
pub use least_width::usual_least_width;
pub use look::{Clip, HALF_WIDTH, KEY, Light, Look, edge_color};
pub use markers::{Marker, MarkerSettings, MarkerShape};
pub use meshes::MeshLook;
pub use options::{LARGEST, Occlusion, PictureOptions, SAMPLES, Viewpoint};
pub use placement::Placement;
pub use recolor::{KeyColors, VisibleKey};
pub use refined::{AdaptiveSettings, CullView, DEFAULT_BUDGET, MAX_BUDGET};
pub use view::camera::{Camera, CameraError};
pub use view::frame::{Frame, Tile};
pub use view::framing::{DEFAULT_FOV, Side};
pub use view::frustum::BoundingSphere;
pub use view::lens::{Lens, PixelSize, Projection};
pub use watch::Watch;
