//! For programs that hold cells in memory, like the Python package: edits and pictures as the commands make them, with
//! their options and checks, without files and messages; what pages show beside cells; and palettes by name or file.
//! Meshes are those of the library (`neurotess::recipe`).

pub use crate::commands::convert::EditRecipe;
#[cfg(feature = "gpu")]
pub use crate::commands::html::{PageContent, page_recording};
#[cfg(feature = "render")]
pub use crate::commands::render::{
    Device, DrawError, Drawing, DrawingColors, DrawingInput, Open, Picked, palette,
};
