//! Pictures of coarse meshes on the GPU.
#![forbid(unsafe_code)]

mod camera;
mod decide;
mod device;
mod error;
mod expand;
mod grids;
mod readback;
mod refiner;
mod refining;
mod scene;
#[cfg(test)]
mod shader_tests;
mod templates;
mod work;

pub use camera::{Ball, Camera, DEFAULT_FOV, Side};
pub use decide::decide;
pub use device::{ADAPTER_VARIABLE, AdapterName, Gpu, adapters, optional_features};
pub use error::{CameraError, DeviceError};
pub use expand::{ExpandedVertex, Wanted};
pub use readback::{Chosen, FrameStats};
pub use refiner::{Batch, FramePlan, Refiner};
pub use refining::{Choice, Refining, Sight};
pub use scene::{Instance, Placement, Scene, SceneError, TemplateId};
pub use templates::{Template, Templates};
