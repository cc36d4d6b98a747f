//! What is open and how it is shown: values, and the commands that change them. No threads, no
//! device, no widgets.

pub mod changes;
pub(crate) mod circuits;
pub mod command;
pub mod crossings;
pub mod document;
pub(crate) mod film;
pub(crate) mod history;
pub(crate) mod ids;
pub(crate) mod index_set;
pub mod markers;
pub mod measuring;
pub(crate) mod meshes;
pub(crate) mod numbers;
pub mod partners;
pub mod picture;
pub mod placing;
pub mod playback;
pub mod plots;
pub(crate) mod revision;
pub mod save;
pub mod session;
pub(crate) mod session_name;
pub mod settings;
pub(crate) mod shared_list;
pub mod sources;
pub mod split;
pub mod state;
pub(crate) mod targets;
pub(crate) mod totals;
pub mod traces;
pub mod view;
