//! Pictures of coarse meshes on the GPU.
#![forbid(unsafe_code)]

mod camera;
mod colour;
mod decide;
mod device;
mod error;
mod expand;
mod finish;
mod frame;
mod grids;
mod image;
mod maker;
mod painter;
mod picture;
mod prerefined;
mod readback;
mod refiner;
mod refining;
mod scene;
mod shade;
#[cfg(test)]
mod shader_tests;
mod templates;
mod timing;
mod work;

pub use camera::{Ball, Camera, DEFAULT_FOV, Side};
pub use colour::{
    CATEGORY_BIT, ColourMap, ColourTable, Palette, Rgb, SCALE_ENTRIES, category, fraction, linear,
};
pub use decide::decide;
pub use device::{ADAPTER_VARIABLE, AdapterName, Gpu, adapters, optional_features};
pub use error::{CameraError, DeviceError};
pub use expand::{ExpandedVertex, Wanted};
pub use finish::finish_text;
pub use frame::{Frame, Tile, shows};
pub use image::{Image, PngWriter};
pub use maker::{SURFACE_VERTEX_WGSL, VertexMaker};
pub use picture::{Cost, LARGEST, Occlusion, PictureError, PictureOptions, SAMPLES, paint};
pub use prerefined::{Painted, Prerefined, Resident};
pub use readback::{Chosen, FrameStats};
pub use refiner::{Batch, FramePlan, Refiner};
pub use refining::{Choice, Refining, Sight};
pub use scene::{Instance, Placement, Scene, SceneError, TemplateId};
pub use shade::{Light, Look, shader_text};
pub use templates::{Template, Templates};
