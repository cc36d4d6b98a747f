//! Bars above and below the picture: the menu, the line at the bottom, time and traces.

pub(crate) mod menu;
pub(crate) mod status;
pub(crate) mod timeline;
pub(crate) mod traces;
