//! The picture, and what lies over it: handles, lines, chips, hints.

mod area;
mod cell_tip;
mod chips;
mod dimensions;
mod gizmo;
mod measuring;
mod overlay;
pub(crate) mod panes;
mod traced_somata;
mod viewport;
