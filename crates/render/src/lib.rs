//! Pictures of coarse meshes on the GPU, without a window.
//!
//! A [`Gpu`] is an open device. A **camera** ([`Camera`]) is where one looks from. A **source**
//! ([`VertexSource`]) makes vertices and decides how many: [`Adaptive`] refines a [`Scene`] as it is
//! drawn, [`Prerefined`] keeps a refined surface in memory. A **color key** per tracing point says its
//! color, which a [`ColorTable`] knows. [`paint`] draws a picture of any size, tile by tile, and
//! hands it over in **bands**; an [`Overlay`] lays legend and scale bar over them, a [`PngWriter`]
//! writes them.
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

pub use gpu::device::{
    ADAPTER_VARIABLE, AdapterName, Gpu, adapters, device_descriptor, optional_features,
    select_adapter,
};
pub use gpu::error::DeviceError;
pub use output::image::{Image, PngWriter};
pub use output::legend::{Legend, nice_length, scale_bar};
pub use output::meter::{FrameTime, Meter};
pub use output::overlay::{Overlay, OverlayOptions};
pub use output::progressive::{ProgressiveRenderer, Steps, ViewParams};
pub use output::still::{
    Cost, LARGEST, Occlusion, PictureError, PictureOptions, SAMPLES, StillRenderer, paint,
};
pub use output::watch::Watch;
pub use scene::color::{
    CATEGORY_BIT, ColorMap, ColorTable, InstanceValues, Palette, Rgb, SCALE_ENTRIES, category,
    fraction, is_dark, linear,
};
pub use scene::templates::{Template, Templates};
pub use scene::{Instance, Placement, Scene, SceneError, TemplateId};
pub use shading::present::{HOVERED, Outlines, PICKED, SELECTED};
pub use shading::shade::{
    Clip, GHOSTED, HIGHLIGHTED, Light, Look, OUTLINED, WITHOUT_NEURITES, WITHOUT_SOMA,
};
pub use sources::adaptive::Adaptive;
pub use sources::adaptive::batch::{Batch, FramePlan};
pub use sources::adaptive::cull::decide;
pub use sources::adaptive::expand::{ExpandedVertex, GridPoint};
pub use sources::adaptive::readback::{FrameStats, SelectedPatch};
pub use sources::adaptive::refiner::Refiner;
pub use sources::adaptive::resolver::PickResolver;
pub use sources::adaptive::settings::{AdaptiveSettings, CullView};
pub use sources::budgeted::{
    DEFAULT_BUDGET, DrawnChunk, Exploration, ExplorationError, ExplorationStats, LodRequest,
    MOST_BUDGET, Proxy, ProxyPickResolver, ProxyPickTargets, lod_requests,
};
pub use sources::pick::{PickHit, PickId, PickIds, PickTarget};
pub use sources::prerefined::{Place, Prerefined, PrerefinedSurface, Resident};
pub use sources::{SourceKey, VertexSource};
pub use view::bounds::{any_shows, bounds, merged};
pub use view::camera::Camera;
pub use view::camera::CameraError;
pub use view::frame::{Frame, Tile};
pub use view::framing::{DEFAULT_FOV, Side};
pub use view::frustum::{BoundingSphere, shows};
