//! The commands.

#[cfg(feature = "render")]
pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod diff;
pub(crate) mod info;
pub(crate) mod man;
pub(crate) mod mesh;
#[cfg(feature = "render")]
pub(crate) mod render;
pub(crate) mod synth;
pub(crate) mod tables;
pub(crate) mod version;
#[cfg(feature = "view")]
pub(crate) mod view;
