//! The window: open, look, pick, tune, save.
//!
//! [`run`] opens it. The [`State`](state::State) holds all that is shown. Panels are functions of
//! it that request [`Command`]s. Edits change the [`Document`](document::Document), and the history
//! keeps earlier ones. Background threads send their results as messages. No geometry is computed
//! here: cells are meshed and drawn by the library.
//!
//! ```text
//! mouse, keys, menus, palette, tests ─▶ Command ─▶ State ─▶ panels
//!                     threads: read, mesh, save ◀─▶ │ ─▶ Stage: drafts, pictures, ids
//! ```
#![forbid(unsafe_code)]

mod io;
mod model;
mod scene;
mod ui;

pub use io::background::wait_for_background;
pub use model::command::Command;
pub use model::{
    changes, command, crossings, document, markers, measuring, partners, picture, placing,
    playback, plots, save, session, settings, sources, split, state, traces, view,
};
pub use scene::headless::{ChooseAdapter, SessionPicture, draw_session};
pub use scene::stage::Stage;
pub use ui::app::{CommandListener, Viewer};
pub use ui::window::{Options, ViewError, run, wgpu_setup};
