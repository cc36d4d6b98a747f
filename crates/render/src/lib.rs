//! Pictures of coarse meshes on the GPU, without a window.
//!
//! A [`Gpu`] is an open device. A **camera** ([`Camera`]) has a position, a direction and a field
//! of view. A **vertex source** ([`VertexSource`]) makes vertices and selects how many:
//! [`Adaptive`] refines a [`Scene`] as it is drawn, [`Prerefined`] keeps a refined surface in
//! memory, and [`Exploration`] draws within a number of triangles. Each tracing point has a **color
//! key**, and a [`ColorTable`](color::ColorTable) has their colors. [`render_still`] draws a
//! picture of any size, tile by tile, and hands it over in **bands** of rows; an
//! [`Overlay`](overlay::Overlay) draws legend and scale bar over them, and a [`PngWriter`] writes
//! them to a file.
//!
//! ```text
//! source: levels, vertices ─▶ shade.wgsl: light, lines, wireframe ─▶ occlusion.wgsl ─▶ finish.wgsl: bytes
//! ```
#![forbid(unsafe_code)]

mod gpu;
mod output;
mod scene;
mod shading;
mod sources;
mod view;

#[cfg(test)]
mod shader_tests;

/// Adapters: their names, how one is selected, and what a device needs.
pub mod adapter {
    pub use crate::gpu::adapter::{ADAPTER_VARIABLE, AdapterName, adapters, select_adapter};
    pub use crate::gpu::capabilities::Capabilities;
    pub use crate::gpu::device::{device_descriptor, optional_features};
}

/// Bounding spheres of meshes, and whether they are in view.
pub mod bounds {
    pub use crate::view::bounds::{any_shows, bounds, merged, surface_points, traced};
    pub use crate::view::frustum::shows;
}

/// Color keys, the tables that they are looked up in, palettes and color maps.
pub mod color {
    pub use crate::scene::color::{
        CATEGORY_BIT, ColorMap, ColorTable, InstanceValues, Palette, Rgb, SCALE_ENTRIES, category,
        fraction, is_dark, linear,
    };
}

/// The shaders of pictures for a host that is not this crate, such as a browser.
pub mod host {
    pub use crate::output::host::{
        composed, drawing_shaders, finishing_shader, grid_sizes, id_shaders, key_light,
        marker_shader, numbers, selection_entries, selection_shaders,
    };
}

/// Outlines in the window.
pub mod outline {
    pub use crate::shading::present::{HOVERED, Outlines, PICKED, SELECTED};
}

/// Drawn over a picture: legends, scale bars, and lines with labels.
pub mod overlay {
    pub use crate::output::annotation::{Annotation, AnnotationLine, Annotations};
    pub use crate::output::legend::{Legend, nice_length, scale_bar};
    pub use crate::output::overlay::{MARGIN, Overlay, OverlayOptions};
}

/// Picking: what is drawn at a pixel.
pub mod pick {
    pub use crate::sources::adaptive::resolver::PickResolver;
    pub use crate::sources::budgeted::{ProxyPickResolver, ProxyPickTargets};
    pub use crate::sources::pick::{PickHit, PickId, PickIds, PickTarget};
}

/// States of instances, bits of [`Instance::state`](crate::Instance::state).
pub mod state {
    pub use crate::shading::shade::{
        GHOSTED, HIGHLIGHTED, OUTLINED, WITHOUT_NEURITES, WITHOUT_SOMA,
    };
}

/// For our tests and benchmarks: not part of the interface, and may change at any time.
#[doc(hidden)]
pub mod testing {
    pub use crate::output::options::SAMPLES;
    pub use crate::sources::adaptive::batch::{Batch, FramePlan};
    pub use crate::sources::adaptive::cull::decide;
    pub use crate::sources::adaptive::expand::{ExpandedVertex, GridPoint};
    pub use crate::sources::adaptive::readback::SelectedPatch;
    pub use crate::sources::adaptive::refiner::Refiner;
    pub use crate::sources::budgeted::lod_requests::{LodRequest, lod_requests};
    pub use crate::sources::budgeted::stats::DrawnChunk;
}

pub use gpu::device::Gpu;
pub use gpu::error::DeviceError;
pub use output::image::{Image, PngWriter};
pub use output::meter::{FrameTime, Meter};
pub use output::options::{LARGEST, Occlusion, PictureOptions, Viewpoint};
pub use output::progressive::{ProgressiveRenderer, Steps, ViewParams};
pub use output::static_picture::{KeyColors, StaticPicture, VisibleKey};
pub use output::still::{Cost, PictureError, StaticError, StillRenderer, render_still};
pub use output::watch::Watch;
pub use scene::templates::{Template, Templates};
pub use scene::{Instance, Placement, Scene, SceneError, TemplateId};
pub use shading::shade::{Clip, Light, Look};
pub use sources::adaptive::Adaptive;
pub use sources::adaptive::readback::FrameStats;
pub use sources::adaptive::settings::{AdaptiveSettings, CullView};
pub use sources::budgeted::{
    DEFAULT_BUDGET, Exploration, ExplorationError, ExplorationStats, MAX_BUDGET, Proxy,
    StreamedTemplates,
};
pub use sources::combined::Combined;
pub use sources::markers::{Marker, MarkerSettings, MarkerShape, Markers};
pub use sources::meshes::{MeshGeometry, MeshLook, Meshes};
pub use sources::prerefined::{Place, Prerefined, PrerefinedSurface, Resident};
pub use sources::{SourceKey, VertexSource};
pub use view::camera::{Camera, CameraError};
pub use view::frame::{Frame, Tile};
pub use view::framing::{DEFAULT_FOV, Side};
pub use view::frustum::BoundingSphere;
pub use view::lens::{Lens, PixelSize, Projection};
