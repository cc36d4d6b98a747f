//! Colors by data: a color key for every tracing point, the table of colors and the legend.
//!
//! Color keys belong to a cell and are shared by all neurons that show it. What differs between
//! neurons of one cell is in the table's values: a color for each ([`each`], [`by_attribute`],
//! [`given`]), or values of a recording ([`Recording`]).
//!
//! Colors are those of a named palette, over which one may have [`OwnColors`], also from a [`PaletteFile`].
//! [`closest`] says whether those of a legend can be told apart.
#![forbid(unsafe_code)]

#[cfg(feature = "circuit")]
mod by_node;
mod by_tracing;
#[cfg(feature = "circuit")]
mod categorical;
#[cfg(feature = "circuit")]
mod compartments;
#[cfg(feature = "circuit")]
mod cut;
#[cfg(feature = "circuit")]
mod film;
#[cfg(feature = "circuit")]
mod markers;
mod meshes;
mod own_colors;
#[cfg(feature = "circuit")]
mod own_numbers;
#[cfg(feature = "circuit")]
mod own_series;
mod own_values;
mod palette_file;
mod path_distance;
#[cfg(feature = "circuit")]
mod recording;
#[cfg(feature = "circuit")]
mod report_frame;
mod scheme;
#[cfg(feature = "circuit")]
mod traces;
#[cfg(feature = "circuit")]
mod visible;
mod vision;

#[cfg(feature = "circuit")]
pub use by_node::{NoAttribute, Node, attributes, by_attribute, each, given};
pub use by_tracing::{ColorBy, coloring};
#[cfg(feature = "circuit")]
pub use cut::{cuts, with_middles};
#[cfg(feature = "circuit")]
pub use film::Film;
#[cfg(feature = "circuit")]
pub use markers::{
    EdgeSynapses, MarkerError, MarkerRow, MarkerSet, ShownCell, ShownCells, SynapseFacts,
    SynapseOptions, SynapsesOf, points, synapse_markers, synapses,
};
pub use meshes::{MeshValues, mesh_color};
pub use own_colors::{ColorTarget, ColoredThing, OwnColors, kinds, rgb};
#[cfg(feature = "circuit")]
pub use own_numbers::OwnNumbers;
#[cfg(feature = "circuit")]
pub use own_series::{CellSeries, OwnSeries};
pub use own_values::{CellValues, OwnValues, by_values};
pub use palette_file::{PaletteError, PaletteFile};
pub use path_distance::path_distances;
#[cfg(feature = "circuit")]
pub use recording::{DECAY, Recording, RecordingError, UnknownSections};
#[cfg(feature = "circuit")]
pub use report_frame::ReportFrame;
pub use scheme::{Cell, ColorScheme, Coloring, NOTHING};
#[cfg(feature = "circuit")]
pub use traces::TracedCompartment;
#[cfg(feature = "circuit")]
pub use visible::{VisibleValues, fractions};
pub use vision::{ClosestColors, MIN_DIFFERENCE, Vision, closest, difference};
