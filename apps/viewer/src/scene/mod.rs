//! What stands in the picture, and the pictures of it: in the window, in files.

mod colors;
pub(crate) mod content;
mod explorer;
pub(crate) mod headless;
pub(crate) mod picks;
pub(crate) mod pictures;
pub(crate) mod stage;
mod templates;
