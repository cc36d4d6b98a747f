//! Pictures of coarse meshes on the GPU.
#![forbid(unsafe_code)]

mod camera;
mod device;
mod error;

pub use camera::{Ball, Camera, DEFAULT_FOV, Side};
pub use device::{ADAPTER_VARIABLE, AdapterName, Gpu, adapters, optional_features};
pub use error::{CameraError, DeviceError};
