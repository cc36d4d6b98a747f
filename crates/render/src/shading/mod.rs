//! From vertices to pixels, for all sources.

#[cfg(feature = "gpu")]
pub(crate) mod finish;
#[cfg(feature = "gpu")]
pub(crate) mod keyed;
pub(crate) mod least_width;
#[cfg(feature = "gpu")]
pub(crate) mod present;
#[cfg(feature = "gpu")]
pub(crate) mod shade;
#[cfg(feature = "gpu")]
pub(crate) mod targets;
