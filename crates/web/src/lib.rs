//! Cells as one HTML page that opens without a server: the packed coarse mesh is the file, and the reader's graphics
//! card makes the membrane.
//!
//! **Theory.** A coarse mesh takes 22 bytes a tracing point, its surface a hundred times as much. So a page holds the
//! packed mesh, and the shaders of [`neurotess_render`] as they are; a **host** in JavaScript (`host/`) does
//! what that crate's Rust does around them. Where a browser has no WebGPU, naga's translation of the same formulas runs
//! in WebGL 2, at one level everywhere.
//!
//! **Practice.** [`shared_page`] takes cells with their placements, [`page`] also the colorings that a reader may switch
//! between.
//! Every tracing point has a color key of its own: colors, what is hidden, values over time and picking
//! are all tables by that key, which the host writes anew.
#![forbid(unsafe_code)]

mod arrays;
mod base85;
mod cell;
mod content;
#[cfg(feature = "host")]
mod dropping;
mod error;
#[cfg(feature = "host")]
mod glsl;
#[cfg(feature = "host")]
mod host_script;
#[cfg(feature = "host")]
mod layout;
mod markers;
#[cfg(feature = "host")]
mod minified;
#[cfg(feature = "host")]
mod page;
mod recording;
mod schemes;
#[cfg(feature = "host")]
mod shaders;
mod shared;
#[cfg(feature = "host")]
mod shortened;
#[cfg(feature = "host")]
mod texture_source;

pub use cell::{PageCell, packed_parts};
pub use content::{CellsText, MAX_KEYS, PageOptions};
#[cfg(feature = "host")]
pub use dropping::dropping_page;
pub use error::WebError;
#[cfg(feature = "host")]
pub use host_script::widget_script;
pub use markers::PageMarkers;
#[cfg(feature = "host")]
pub use page::{MAX_PAGE_BYTES, Page, page};
pub use recording::PageRecording;
pub use schemes::PageScheme;
#[cfg(feature = "host")]
pub use shaders::modules;
#[cfg(feature = "host")]
pub use shared::shared_page;
pub use shared::{shared_cells, usual_title};
