//! The window, driven by commands, keys and mouse, with pictures of its main states.
//!
//! Pictures lie in `tests/snapshots`; `UPDATE_SNAPSHOTS=1 cargo test -p neurotess-viewer --test it`
//! renews them. They are compared on software Vulkan: a pixel may be off by 0.8 of dify's measure, and single
//! pixels by more than that. Times that the window has measured are masked.

mod drawing;
mod edits;
mod files;
mod placing;
mod shows;
mod two_views;
