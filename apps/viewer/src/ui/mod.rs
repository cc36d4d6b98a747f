//! The window: panels, keys and mouse, and what holds them together.

pub mod app;
pub mod file_panel;
mod input;
mod panels;
pub(crate) mod window;
