//! The exact union near crossings: faces are cut along one another, and what bounds the solid is kept.

mod cells;
mod engine;
pub(crate) mod region;
mod sheets;
pub(crate) mod splice;
pub(crate) mod winding;

pub(crate) use engine::hull;
