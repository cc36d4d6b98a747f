//! Pictures of coarse meshes on the GPU.
#![forbid(unsafe_code)]

mod camera;
mod colour;
mod device;
mod error;
mod finish;
mod frame;
mod image;
mod legend;
mod maker;
mod overlay;
mod painter;
mod picture;
mod prerefined;
mod shade;
mod text;
mod timing;

pub use camera::{Ball, Camera, DEFAULT_FOV, Side};
pub use colour::{
    CATEGORY_BIT, ColourMap, ColourTable, Palette, Rgb, SCALE_ENTRIES, category, fraction, is_dark,
    linear,
};
pub use device::{ADAPTER_VARIABLE, AdapterName, Gpu, adapters, optional_features};
pub use error::{CameraError, DeviceError};
pub use finish::finish_text;
pub use frame::{Frame, Tile, shows};
pub use image::{Image, PngWriter};
pub use legend::{Legend, nice_length, scale_bar};
pub use maker::{SURFACE_VERTEX_WGSL, VertexMaker};
pub use overlay::{Overlay, OverlayOptions};
pub use picture::{Cost, LARGEST, Occlusion, PictureError, PictureOptions, SAMPLES, paint};
pub use prerefined::{Painted, Prerefined, Resident};
pub use shade::{Light, Look, shader_text};
