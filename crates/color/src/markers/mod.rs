//! Markers of a circuit: synapses where its edges say they are, and points of tables.
//!
//! A marker's color key is a category, in a part of the color table that follows the cells' own
//! ([`Coloring::add_markers`]). Numbers are colored in steps of the scale.

mod edges;
mod points;
mod sites;
mod synapses;

use glam::DVec3;
use neurotess_circuit::CircuitError;
use neurotess_picture::color::{Rgb, category};
use neurotess_picture::overlay::Legend;
use neurotess_picture::{BoundingSphere, Marker};

use crate::own_colors::{ColorTarget, ColoredThing};
use crate::scheme::{ColorScheme, Coloring, NOTHING};

pub use edges::{EdgeSynapses, ShownCell, ShownCells, SynapseFacts, SynapsesOf};
pub use points::points;
pub use synapses::{SynapseOptions, synapse_markers, synapses};

/// Markers, and what their colors mean.
#[derive(Clone, Debug)]
pub struct MarkerSet {
    /// The markers. Color keys are categories from 0 on, until [`Coloring::add_markers`] has moved them.
    pub markers: Vec<Marker>,
    /// The color of each category.
    pub colors: Vec<Rgb>,
    /// The legend.
    pub legend: Legend,
    /// What each marker is.
    pub rows: Vec<MarkerRow>,
    /// How many were left out, because their cell is not drawn.
    pub left_out: usize,
    /// How many were left out, because they have no place on their cell: their section is not there, or the tracing
    /// cannot be read.
    pub placeless: usize,
    /// What has a color that one may set.
    things: Vec<ColoredThing>,
    /// Whether they lie on cells that are drawn.
    on_cells: bool,
}

/// What a marker is: a row of what it was made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MarkerRow {
    /// Index of the population of edges among those that were given; 0 for points.
    pub table: u32,
    /// Number of the edge in its population, or of the point in its table, from 0.
    pub row: u64,
}

/// Why there are no markers.
#[derive(Debug, thiserror::Error)]
pub enum MarkerError {
    /// A file is invalid.
    #[error(transparent)]
    Circuit(#[from] CircuitError),
    /// The circuit has no such population of edges.
    #[error("{file}: has no edges '{name}': it has {there}")]
    NoEdges {
        /// The circuit's file.
        file: String,
        /// What was asked for.
        name: String,
        /// The names that exist.
        there: String,
    },
    /// A file of edges does not say where its synapses are.
    #[error(
        "{file}: edges '{name}' do not say where their synapses are: it needs columns such as \
         {side}_surface_x, _y and _z, or {side}_section_id and {side}_section_pos"
    )]
    NoPlaces {
        /// The file of edges.
        file: String,
        /// The population of edges.
        name: String,
        /// `afferent` or `efferent`.
        side: &'static str,
    },
    /// There is no such number of each synapse or point.
    #[error("{file}: has no number '{name}': it has {there}")]
    NoNumbers {
        /// The file.
        file: String,
        /// What was asked for.
        name: String,
        /// The names that exist.
        there: String,
    },
}

fn listed<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<&str> = names.collect();
    match names.is_empty() {
        true => "none".to_owned(),
        false => names.join(", "),
    }
}

/// Color i for the markers of category i, or the own color of its name.
fn by_name(markers: Vec<Marker>, names: Vec<String>, scheme: &ColorScheme) -> MarkerSet {
    let targets = names.iter().cloned().map(ColorTarget::Category);
    let targets: Vec<ColorTarget> = targets.collect();
    let own = targets.iter().map(|target| scheme.own_colors.get(target));
    let own = own.enumerate().map(|(i, own)| own.unwrap_or(color(i)));
    let colors: Vec<Rgb> = own.collect();
    let things = targets.into_iter().zip(colors.iter().copied());
    let things = things.map(|(target, color)| ColoredThing { target, color });
    let things = things.collect();
    let legend = Legend::swatches("", colors.iter().copied().zip(names));
    MarkerSet {
        markers,
        colors,
        legend,
        things,
        rows: Vec::new(),
        left_out: 0,
        placeless: 0,
        on_cells: false,
    }
}

/// Share of the numbers beyond each end of the scale: a few far ones leave the others' colors apart.
const BEYOND: f64 = 0.02;

/// Colors by a number of each marker.
fn by_number(
    mut markers: Vec<Marker>,
    values: &[f64],
    name: &str,
    scheme: &ColorScheme,
) -> MarkerSet {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    let mut sorted: Vec<f64> = finite.collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
        sorted.get(place).copied().unwrap_or_default()
    };
    let (low, high) = (at(BEYOND), at(1.0 - BEYOND));
    let more = sorted.last().is_some_and(|&last| last > high);
    let steps = scheme.scale.len().max(1);
    let nothing = steps as u32;
    for (marker, &value) in markers.iter_mut().zip(values) {
        let share = (value - low) / (high - low).max(f64::MIN_POSITIVE);
        let step = (share.clamp(0.0, 1.0) * (steps - 1) as f64).round() as u32;
        marker.color_key = category(if share.is_finite() { step } else { nothing });
    }
    let mut colors = scheme.scale.clone();
    colors.resize(steps, NOTHING);
    colors.push(NOTHING);
    // A legend needs two ends.
    let range = match high > low {
        true => [low as f32, high as f32],
        false => [low as f32, low as f32 + 1.0],
    };
    MarkerSet {
        legend: Legend::bar(name, "", scheme.scale.clone(), range, more),
        markers,
        colors,
        things: Vec::new(),
        rows: Vec::new(),
        left_out: 0,
        placeless: 0,
        on_cells: false,
    }
}

/// Colors that stand out from those of the palettes' types and are light enough to be seen on dark neurites.
fn color(index: usize) -> Rgb {
    const COLORS: [Rgb; 6] = [
        [255, 176, 0],
        [0, 170, 140],
        [230, 60, 160],
        [120, 190, 30],
        [70, 150, 255],
        [255, 110, 60],
    ];
    COLORS[index % COLORS.len()]
}

impl MarkerSet {
    /// What has a color that one may set.
    pub fn things(&self) -> &[ColoredThing] {
        &self.things
    }

    /// A sphere (µm) around the points of a table, which may lie away from all cells; none around synapses, which
    /// lie on them.
    pub fn bounds(&self) -> Option<BoundingSphere> {
        if self.on_cells {
            return None;
        }
        let positions = || self.markers.iter().map(|marker| marker.position);
        let low = positions().reduce(DVec3::min)?;
        let center = low.midpoint(positions().reduce(DVec3::max)?);
        let reach = positions().map(|position| position.distance(center));
        Some((center, reach.fold(0.0, f64::max)))
    }
}

impl Coloring {
    /// Adds the colors of markers to the table, and their legend below the cells'. The markers' color keys are
    /// changed accordingly.
    pub fn add_markers(&mut self, set: &mut MarkerSet) {
        let first = self.categories();
        let own = &mut self.table.categories;
        let last = own.last().copied().unwrap_or(NOTHING);
        own.resize(first, last);
        own.extend(&set.colors);
        for marker in &mut set.markers {
            marker.color_key += first as u32;
        }
        self.things.extend(set.things.iter().cloned());
        self.legend = self.legend.clone().with_below(set.legend.clone());
    }
}

#[cfg(test)]
mod tests;
