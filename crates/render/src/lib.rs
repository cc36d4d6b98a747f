//! Pictures of coarse meshes on the GPU, without a window.
//!
//! A [`Gpu`] is an open device. What a picture is, its cameras, colors and looks, is in `neurotess-picture`, whose names
//! are here, too. A **vertex source** ([`VertexSource`]) makes vertices and selects how many: [`Adaptive`] refines a
//! [`Scene`] as it is drawn, [`Prerefined`] keeps a refined surface in memory, and [`Exploration`] draws within a number
//! of triangles. [`render_still`] draws a picture of any size, tile by tile, and hands it over in **bands** of rows.
//! [`Composite`] draws into a render pass of another program.
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

#[cfg(test)]
mod shader_tests;

/// Adapters: their names, how one is selected, and what a device needs.
pub mod adapter {
    pub use crate::gpu::adapter::{ADAPTER_VARIABLE, AdapterName, adapters, select_adapter};
    pub use crate::gpu::capabilities::Capabilities;
    pub use crate::gpu::device::device_descriptor;
    pub use crate::gpu::requirements::optional_features;
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

/// Picking: what is drawn at a pixel.
pub mod pick {
    pub use crate::sources::adaptive::resolver::PickResolver;
    pub use crate::sources::budgeted::{ProxyPickResolver, ProxyPickTargets};
    pub use crate::sources::pick::{PickHit, PickId, PickIds, PickTarget};
}

/// For our tests and benchmarks: not part of the interface, and may change at any time.
#[doc(hidden)]
pub mod testing {
    pub use crate::sources::adaptive::batch::{Batch, FramePlan};
    pub use crate::sources::adaptive::cull::decide;
    pub use crate::sources::adaptive::expand::{ExpandedVertex, GridPoint};
    pub use crate::sources::adaptive::readback::SelectedPatch;
    pub use crate::sources::adaptive::refiner::Refiner;
    pub use crate::sources::budgeted::lod_requests::{LodRequest, lod_requests};
    pub use crate::sources::budgeted::stats::DrawnChunk;
    pub use neurotess_picture::SAMPLES;
}

/// Numbers of vectors and matrices, in the version that cameras and views are made of.
pub use glam;
/// The graphics library, in the version that devices, textures and passes must be of.
pub use wgpu;

pub use gpu::device::Gpu;
pub use gpu::error::DeviceError;
pub use gpu::requirements::Requirements;
pub use neurotess_picture::markers::{Marker, MarkerSettings, MarkerShape};
pub use neurotess_picture::meshes::MeshLook;
pub use neurotess_picture::recolor::{KeyColors, VisibleKey};
pub use neurotess_picture::{
    AdaptiveSettings, BoundingSphere, Camera, CameraError, Clip, CullView, DEFAULT_BUDGET,
    DEFAULT_FOV, Frame, Image, Instance, LARGEST, Lens, Light, Look, MAX_BUDGET, Occlusion,
    PictureOptions, PixelSize, Placement, PngWriter, Projection, SceneError, Side, Template,
    TemplateId, Tile, Viewpoint, Watch, bounds, color, overlay, state, usual_least_width,
};
pub use output::composite::{Composite, CompositeError, HostPass, HostView, HostViewError};
pub use output::meter::{FrameTime, Meter};
pub use output::progressive::{ProgressiveRenderer, Steps, ViewParams};
pub use output::static_picture::StaticPicture;
pub use output::still::{Cost, PictureError, StaticError, StillRenderer, render_still};
pub use output::tiling::tiles;
pub use scene::Scene;
pub use scene::templates::Templates;
pub use sources::adaptive::Adaptive;
pub use sources::adaptive::readback::FrameStats;
pub use sources::budgeted::{
    Exploration, ExplorationError, ExplorationStats, Proxy, StreamedTemplates,
};
pub use sources::combined::Combined;
pub use sources::markers::Markers;
pub use sources::meshes::{MeshGeometry, Meshes};
pub use sources::prerefined::{Place, Prerefined, PrerefinedSurface, Resident};
pub use sources::{SourceKey, VertexSource};
