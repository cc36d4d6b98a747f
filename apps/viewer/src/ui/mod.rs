//! The window: panels, keys and mouse, and what holds them together.

pub(crate) mod app;
mod file_panel;
mod input;
mod motion;
mod panels;
mod path_line;
mod plot;
pub(crate) mod window;
