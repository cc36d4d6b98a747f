//! Pictures of coarse meshes on the GPU, without a window.
//!
//! A [`Gpu`] is an open device. A **camera** ([`Camera`]) is where one looks from. A **maker**
//! ([`VertexMaker`]) makes vertices and decides how many: [`Adaptive`] refines a [`Scene`] as it is
//! drawn, [`Prerefined`] keeps a refined surface in memory. A **word** per tracing point says its
//! color, which a [`ColorTable`] knows. [`paint`] draws a picture of any size, tile by tile, and
//! hands it over in **bands**; an [`Overlay`] lays legend and scale bar over them, a [`PngWriter`]
//! writes them.
//!
//! ```text
//! maker: levels, vertices ─▶ shade.wgsl: light, lines, wires ─▶ occlusion.wgsl ─▶ finish.wgsl: bytes
//! ```
#![forbid(unsafe_code)]

mod adaptive;
mod bounds;
mod camera;
mod color;
mod decide;
mod device;
mod error;
mod expand;
mod explore;
mod finish;
mod frame;
mod framing;
mod grids;
mod ids;
mod image;
mod layouts;
mod legend;
mod live;
mod maker;
mod meter;
mod named;
mod overlay;
mod painter;
mod passes;
mod picture;
#[cfg(test)]
mod picture_shader_tests;
mod prerefined;
mod present;
mod readback;
mod refiner;
mod refining;
mod scene;
mod shade;
#[cfg(test)]
mod shader_tests;
mod targets;
mod templates;
mod text;
mod timing;
mod watch;
mod work;

pub use adaptive::Adaptive;
pub use bounds::{any_shows, bounds, merged};
pub use camera::Camera;
pub use color::{
    CATEGORY_BIT, ColorMap, ColorTable, InstanceValues, Palette, Rgb, SCALE_ENTRIES, category,
    fraction, is_dark, linear,
};
pub use decide::decide;
pub use device::{
    ADAPTER_VARIABLE, AdapterName, Gpu, adapters, choose_adapter, device_descriptor,
    optional_features,
};
pub use error::{CameraError, DeviceError};
pub use expand::{ExpandedVertex, Wanted};
pub use explore::{
    Asked, DEFAULT_BUDGET, Exploration, ExplorationError, ExplorationStats, MOST_BUDGET,
    ShownPiece, Sketch, SketchNamer, SketchNames, asked,
};
pub use frame::{Frame, Tile, shows};
pub use framing::{Ball, DEFAULT_FOV, Side};
pub use ids::{Id, Ids};
pub use image::{Image, PngWriter};
pub use legend::{Legend, nice_length, scale_bar};
pub use live::{Live, Shot, Steps};
pub use maker::{SURFACE_VERTEX_WGSL, VertexMaker};
pub use meter::{FrameTime, Meter};
pub use named::{Named, Namer, Spot};
pub use overlay::{Overlay, OverlayOptions};
pub use picture::{Cost, LARGEST, Occlusion, PictureError, PictureOptions, SAMPLES, Studio, paint};
pub use prerefined::{Painted, Place, Prerefined, Resident};
pub use present::{HOVERED, Outlines, PICKED, SELECTED};
pub use readback::{Chosen, FrameStats};
pub use refiner::{Batch, FramePlan, Refiner};
pub use refining::{Choice, Refining, Sight};
pub use scene::{Instance, Placement, Scene, SceneError, TemplateId};
pub use shade::{Clip, FAINT, Light, Look, MARKED, OUTLINED, WITHOUT_NEURITES, WITHOUT_SOMA};
pub use templates::{Template, Templates};
pub use watch::Watch;
