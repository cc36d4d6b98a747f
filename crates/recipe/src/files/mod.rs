//! Files of a cell: its mesh, or one for each part, and what is written beside.

mod error;
mod observed;
mod options;
mod save;
mod surface;
mod write;

pub use error::SaveError;
pub use options::{FileOptions, part_file};
pub use save::{SaveOptions, Saved};
pub use surface::FileSurface;
pub use write::{CellFiles, PartFile, WrittenFiles};
