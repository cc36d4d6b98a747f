//! The window: open, look, pick, tune, save.
//!
//! [`run`] opens it. The [`State`](state::State) holds all that shows; panels are functions of it that ask
//! for [`Command`]s; an edit changes the [`Document`](document::Document), of which the history keeps those
//! before. Work goes to threads and comes back as messages. No geometry is made here: cells are meshed
//! and drawn by the library.
//!
//! ```text
//! mouse, keys, menus, palette, tests ─▶ Command ─▶ State ─▶ panels
//!                     threads: read, mesh, save ◀─▶ │ ─▶ Stage: drafts, pictures, ids
//! ```
#![forbid(unsafe_code)]

pub mod app;
pub mod circuits;
mod colors;
pub mod command;
pub mod document;
mod explorer;
pub mod files;
mod headless;
pub mod history;
mod input;
mod panels;
mod paths;
pub mod picks;
pub mod playback;
mod reader;
pub mod save;
mod scene;
pub mod session;
pub mod settings;
pub mod sources;
pub mod stage;
pub mod state;
pub mod view;
mod window;
pub mod worker;

pub use app::{Hears, Viewer};
pub use command::Command;
pub use headless::{Drawn, draw_session};
pub use window::{Options, ViewError, run, wgpu_setup};
