//! The core for browsers: a file's bytes in; warnings, measures, a page's cells, pictures and files of meshes out.
//!
//! ```text
//! worker of the page ─ memory.rs: bytes in linear memory ─▶ calls.rs ─▶ cell.rs ─▶ formats, generate, refine, web
//!                                                               └────▶ drawing.rs ─▶ raster
//! ```
//!
//! **Why not** wasm-bindgen: there are five calls, which take bytes and return bytes, so nothing has to be generated, and
//! no program has to be installed. Where this crate is no WebAssembly, tests call [`Calls`] as the worker does.
//!
//! **Pictures** are drawn here where a browser has neither WebGPU nor WebGL 2: a draft at once while something moves, a
//! finished one at rest. They have the bytes that the command draws.
//!
//! All runs in one thread: where rayon can start no threads, it works on the one that calls.

mod calls;
mod cell;
mod drawing;
#[cfg(target_arch = "wasm32")]
pub mod memory;

pub use calls::{Answer, Calls};
