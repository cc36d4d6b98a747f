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
mod error;
mod glsl;
mod host_script;
mod layout;
mod markers;
mod minified;
mod page;
mod recording;
mod schemes;
mod shaders;
mod shared;
mod shortened;
mod texture_source;

pub use cell::{PageCell, packed_parts};
pub use error::WebError;
pub use markers::PageMarkers;
pub use page::{MAX_PAGE_BYTES, Page, PageOptions, page};
pub use recording::PageRecording;
pub use schemes::PageScheme;
pub use shaders::modules;
pub use shared::{shared_page, usual_title};
