//! Options that belong together.

mod camera;
mod cells;
mod colors;
mod device;
mod edits;
mod look;
mod markers;
mod refinement;
mod shape;

pub use camera::CameraOptions;
pub use cells::CellSelection;
pub use colors::ColorOptions;
pub use device::DeviceOptions;
pub use edits::EditOptions;
pub use look::LookOptions;
pub use markers::MarkerOptions;
pub use refinement::RefinementOptions;
pub use shape::{MissingRadii, Rings, ShapeOptions};
