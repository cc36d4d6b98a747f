//! What is open and how it shows: values and the commands that change them. No threads, no device, no
//! widgets.

pub mod circuits;
pub mod command;
pub mod document;
pub mod history;
pub mod playback;
pub mod session;
pub mod settings;
pub mod state;
pub mod view;
