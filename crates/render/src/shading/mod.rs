//! From vertices to pixels, whichever source they come from.

pub(crate) mod finish;
pub(crate) mod present;
pub(crate) mod shade;
pub(crate) mod targets;
