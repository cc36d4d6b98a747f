//! Options that several commands share.

#[cfg(feature = "render")]
pub(crate) mod cache;
pub(crate) mod numbers;
pub(crate) mod out;
