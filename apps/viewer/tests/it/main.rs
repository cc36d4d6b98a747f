//! The window, driven by commands, keys and mouse.

mod clamped;
mod common;
mod dropping;
mod file_dialog;
mod focusing;
mod input;
mod likeness;
mod lists;
mod measuring;
mod menus;
mod meshes;
mod next_cell;
mod palettes;
mod panels;
mod plots;
mod rebuilds;
mod recordings;
mod saving;
mod screen;
mod sessions;
mod spines;
mod static_mode;
mod synapses;
mod unsaved;
mod window;

neurotess_testing::main!(finally: common::wait_for_threads());
