//! Options that several commands share.

#[cfg(feature = "render")]
pub(crate) mod cache;
pub(crate) mod cells;
#[cfg(feature = "render")]
pub(crate) mod gpu;
#[cfg(feature = "render")]
pub(crate) mod markers;
#[cfg(feature = "render")]
pub(crate) mod meshes;
pub(crate) mod numbers;
pub(crate) mod out;
pub(crate) mod radius;
pub(crate) mod rings;
#[cfg(feature = "render")]
pub(crate) mod size;
pub(crate) mod soma;
pub(crate) mod time;
pub(crate) mod types;
