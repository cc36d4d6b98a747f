//! For programs that hold cells in memory, like the Python package: edits and pictures as the commands make them, with
//! their options and checks, without files and messages; what pages show beside cells; and palettes by name or file.
//! Meshes are those of the library (`neurotess::recipe`).

pub use crate::commands::convert::EditRecipe;
