//! Triangles as solvers like them.

mod diagonals;
mod edits;
pub(crate) mod improve;
