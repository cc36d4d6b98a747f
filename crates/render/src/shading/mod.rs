//! From vertices to pixels, for all sources.

pub(crate) mod finish;
pub(crate) mod keyed;
pub(crate) mod present;
pub(crate) mod shade;
pub(crate) mod targets;
