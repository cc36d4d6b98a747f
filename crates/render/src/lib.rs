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
//!
//! # Features
//! `gpu`, on by default, is all that draws, with wgpu. Without it colors, legends and placements are left, which is what
//! a page needs of this crate.
#![forbid(unsafe_code)]
#![cfg_attr(
    not(feature = "gpu"),
    allow(
        dead_code,
        unused_imports,
        reason = "without devices nothing looks colors up"
    ),
    // Its links lead to what draws.
    allow(rustdoc::broken_intra_doc_links)
)]

#[cfg(feature = "gpu")]
mod gpu;
mod output;
mod scene;
mod shading;
#[cfg(feature = "gpu")]
mod sources;
#[cfg(feature = "gpu")]
mod view;

#[cfg(all(test, feature = "gpu"))]
mod shader_tests;

/// Adapters: their names, how one is selected, and what a device needs.
#[cfg(feature = "gpu")]
pub mod adapter {
    pub use crate::gpu::adapter::{ADAPTER_VARIABLE, AdapterName, adapters, select_adapter};
    pub use crate::gpu::capabilities::Capabilities;
    pub use crate::gpu::device::{device_descriptor, optional_features};
}

/// Bounding spheres of meshes, and whether they are in view.
#[cfg(feature = "gpu")]
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
#[cfg(feature = "gpu")]
pub mod host {
    pub use crate::output::host::{
        composed, drawing_shaders, finishing_shader, grid_sizes, id_shaders, key_light,
        marker_shader, numbers, selection_entries, selection_shaders,
    };
}

/// Outlines in the window.
#[cfg(feature = "gpu")]
pub mod outline {
    pub use crate::shading::present::{HOVERED, Outlines, PICKED, SELECTED};
}

/// Drawn over a picture: legends, scale bars, and lines with labels.
pub mod overlay {
    #[cfg(feature = "gpu")]
    pub use crate::output::annotation::{Annotation, AnnotationLine, Annotations};
    pub use crate::output::legend::{Legend, nice_length, scale_bar};
    #[cfg(feature = "gpu")]
    pub use crate::output::overlay::{MARGIN, Overlay, OverlayOptions};
}

/// Picking: what is drawn at a pixel.
#[cfg(feature = "gpu")]
pub mod pick {
    pub use crate::sources::adaptive::resolver::PickResolver;
    pub use crate::sources::budgeted::{ProxyPickResolver, ProxyPickTargets};
    pub use crate::sources::pick::{PickHit, PickId, PickIds, PickTarget};
}

/// States of instances, bits of [`Instance::state`](crate::Instance::state).
#[cfg(feature = "gpu")]
pub mod state {
    pub use crate::shading::shade::{
        GHOSTED, HIGHLIGHTED, OUTLINED, WITHOUT_NEURITES, WITHOUT_SOMA,
    };
}

/// For our tests and benchmarks: not part of the interface, and may change at any time.
#[cfg(feature = "gpu")]
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

#[cfg(feature = "gpu")]
pub use gpu::device::Gpu;
#[cfg(feature = "gpu")]
pub use gpu::error::DeviceError;
pub use output::image::{Image, PngWriter};
#[cfg(feature = "gpu")]
pub use output::meter::{FrameTime, Meter};
#[cfg(feature = "gpu")]
pub use output::options::{LARGEST, Occlusion, PictureOptions, Viewpoint};
#[cfg(feature = "gpu")]
pub use output::progressive::{ProgressiveRenderer, Steps, ViewParams};
#[cfg(feature = "gpu")]
pub use output::static_picture::{KeyColors, StaticPicture, VisibleKey};
#[cfg(feature = "gpu")]
pub use output::still::{Cost, PictureError, StaticError, StillRenderer, render_still};
#[cfg(feature = "gpu")]
pub use output::watch::Watch;
pub use scene::Placement;
#[cfg(feature = "gpu")]
pub use scene::templates::{Template, Templates};
#[cfg(feature = "gpu")]
pub use scene::{Instance, Scene, SceneError, TemplateId};
pub use shading::least_width::usual_least_width;
#[cfg(feature = "gpu")]
pub use shading::shade::{Clip, Light, Look};
#[cfg(feature = "gpu")]
pub use sources::adaptive::Adaptive;
#[cfg(feature = "gpu")]
pub use sources::adaptive::readback::FrameStats;
#[cfg(feature = "gpu")]
pub use sources::adaptive::settings::{AdaptiveSettings, CullView};
#[cfg(feature = "gpu")]
pub use sources::budgeted::{
    DEFAULT_BUDGET, Exploration, ExplorationError, ExplorationStats, MAX_BUDGET, Proxy,
    StreamedTemplates,
};
#[cfg(feature = "gpu")]
pub use sources::combined::Combined;
#[cfg(feature = "gpu")]
pub use sources::markers::{Marker, MarkerSettings, MarkerShape, Markers};
#[cfg(feature = "gpu")]
pub use sources::meshes::{MeshGeometry, MeshLook, Meshes};
#[cfg(feature = "gpu")]
pub use sources::prerefined::{Place, Prerefined, PrerefinedSurface, Resident};
#[cfg(feature = "gpu")]
pub use sources::{SourceKey, VertexSource};
#[cfg(feature = "gpu")]
pub use view::camera::{Camera, CameraError};
#[cfg(feature = "gpu")]
pub use view::frame::{Frame, Tile};
#[cfg(feature = "gpu")]
pub use view::framing::{DEFAULT_FOV, Side};
#[cfg(feature = "gpu")]
pub use view::frustum::BoundingSphere;
#[cfg(feature = "gpu")]
pub use view::lens::{Lens, PixelSize, Projection};
