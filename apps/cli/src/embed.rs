//! For programs that hold cells in memory, like the Python package: what the commands do, with their options
//! and checks, without files and messages.

pub use crate::commands::convert::EditRecipe;
#[cfg(feature = "render")]
pub use crate::commands::render::{DrawError, Drawing, DrawingInput, Picked};
