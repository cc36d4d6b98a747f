//! The core for browsers: a file's bytes in; warnings, measures, a page's cells and files of meshes out.
//!
//! ```text
//! worker of the page ─ memory.rs: bytes in linear memory ─▶ calls.rs ─▶ cell.rs ─▶ formats, generate, refine, web
//! ```
//!
//! **Why not** wasm-bindgen: there are three calls, which take bytes and return bytes, so nothing has to be generated, and
//! no program has to be installed. Where this crate is no WebAssembly, tests call [`Calls`] as the worker does.
//!
//! All runs in one thread: where rayon can start no threads, it works on the one that calls.

mod calls;
mod cell;
#[cfg(target_arch = "wasm32")]
pub mod memory;

pub use calls::{Answer, Calls};
