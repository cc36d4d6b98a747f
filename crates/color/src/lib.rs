//! What colors tell: a color_key for every tracing point, the table of colors and the legend.
//!
//! Words belong to a cell, whatever shows it. What differs from neuron to neuron of one cell is in the
//! table's values: a color for each ([`each`], [`by_attribute`], [`given`]), or those of a recording
//! ([`Recording`]).
#![forbid(unsafe_code)]

mod by_node;
mod by_tracing;
mod compartments;
mod cut;
mod recording;
mod report_frame;

pub use by_node::{NoAttribute, Node, attributes, by_attribute, each, given};
pub use by_tracing::{Cell, ColorBy, ColorScheme, Coloring, NOTHING, coloring, path_distances};
pub use cut::{cuts, with_middles};
pub use recording::{DECAY, Recording, RecordingError};
pub use report_frame::ReportFrame;
