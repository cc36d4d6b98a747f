//! The scene in the window, and its pictures: in the window and in files.

mod colors;
pub(crate) mod content;
pub(crate) mod dimensions;
mod explorer;
mod film;
pub(crate) mod headless;
pub(crate) mod locate;
mod markers;
mod meshes;
mod painter;
pub(crate) mod picks;
pub(crate) mod pictures;
pub(crate) mod stage;
mod still_scene;
mod templates;

pub(crate) use colors::color_scheme;
