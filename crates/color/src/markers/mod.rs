//! Markers of a circuit: synapses where its edges say they are, and points of tables.
//!
//! A marker's color key is a category, in a part of the color table that follows the cells' own
//! ([`Coloring::add_markers`]). Numbers are colored in steps of the scale.

mod points;
mod synapses;

use glam::DVec3;
use neurotess_circuit::CircuitError;
use neurotess_render::color::{Rgb, category};
use neurotess_render::overlay::Legend;
use neurotess_render::{BoundingSphere, Marker};

use crate::own_colors::{ColorTarget, ColoredThing};
use crate::scheme::{ColorScheme, Coloring, NOTHING};

pub use points::points;
pub use synapses::{
    EdgeSynapses, ShownCells, SynapseFacts, SynapseOptions, synapse_markers, synapses,
};

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
         {side}_surface_x, _y and _z"
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
mod tests {
    use std::collections::HashMap;

    use neurotess_circuit::PointTable;
    use neurotess_render::color::{CATEGORY_BIT, ColorMap, Palette};

    use super::*;

    fn scheme() -> ColorScheme {
        ColorScheme {
            palette: Palette::NeuroM,
            background: None,
            scale: ColorMap::Viridis.scale(),
            range: None,
            own_colors: crate::OwnColors::default(),
        }
    }

    fn table(values: &[f64]) -> PointTable {
        PointTable {
            positions: values.iter().map(|&x| DVec3::X * x).collect(),
            columns: vec![("w".into(), values.to_vec())],
        }
    }

    #[test]
    fn numbers_are_colored_from_end_to_end_and_missing_ones_gray() {
        let mut values: Vec<f64> = (0..100).map(f64::from).collect();
        values.extend([1e9, f64::NAN]);
        let set = points("p.csv", &table(&values), Some("w"), &scheme()).expect("markers");
        let color = |index: usize| {
            let key = set.markers[index].color_key & !CATEGORY_BIT;
            set.colors[key as usize]
        };
        let scale = ColorMap::Viridis.scale();
        assert_eq!(color(0), scale[0]);
        assert_eq!(color(99), scale[scale.len() - 1]);
        assert_eq!(color(100), color(99), "far beyond the others");
        assert_eq!(color(101), NOTHING);
        let middle = color(50)[1];
        assert!(scale[100][1] < middle && middle < scale[160][1]);
    }

    #[test]
    fn colors_of_markers_follow_those_that_cells_use() {
        let mut set = points("p.csv", &table(&[1.0, 2.0]), None, &scheme()).expect("markers");
        // Its cells use a category beyond the end of the table.
        let mut coloring = Coloring {
            color_keys: vec![vec![category(0), category(4)]],
            table: neurotess_render::color::ColorTable {
                categories: vec![[1; 3], [2; 3]],
                ..Default::default()
            },
            legend: Legend::swatches("", []),
            things: Vec::new(),
        };
        coloring.add_markers(&mut set);
        let categories = &coloring.table.categories;
        assert_eq!(categories[..5], [[1; 3], [2; 3], [2; 3], [2; 3], [2; 3]]);
        assert_eq!(categories.len(), 6);
        assert!(
            set.markers
                .iter()
                .all(|marker| marker.color_key == category(5))
        );
        assert_eq!(categories[5], set.colors[0]);
    }

    #[test]
    fn a_column_that_is_not_there_is_named_beside_those_that_are() {
        let missing = points("p.csv", &table(&[1.0]), Some("size"), &scheme());
        let said = missing.expect_err("none").to_string();
        assert_eq!(said, "p.csv: has no number 'size': it has w");
        let set = points("p.csv", &table(&[3.0, 3.0]), Some("w"), &scheme()).expect("markers");
        assert_eq!(set.bounds(), Some((DVec3::X * 3.0, 0.0)));
    }

    fn edges(folder: &std::path::Path) -> neurotess_circuit::Edges {
        let at = |x: f64| DVec3::new(x, 1.0, 2.0);
        let synapses = neurotess_circuit::Synapses {
            sources: vec![7, 8, 9, 7],
            targets: vec![1, 2, 1, 3],
            positions: vec![at(0.0), at(10.0), at(20.0), DVec3::NAN],
        };
        let file = folder.join("edges.h5");
        let delays = [("delay", vec![0.5, 1.5, 2.5, 3.5])];
        let to = std::fs::File::create(&file).expect("a file");
        neurotess_circuit::write::edges("syn", ["pre", "post"], &synapses, &delays, to)
            .expect("written");
        neurotess_circuit::Edges {
            name: "syn".into(),
            file,
            source: "pre".into(),
            target: "post".into(),
            count: 4,
        }
    }

    #[test]
    fn synapses_are_read_once_and_shown_in_part() {
        use neurotess_circuit::SynapseSide::Afferent;
        let folder = tempfile::tempdir().expect("a folder");
        let edges = edges(folder.path());
        let read = EdgeSynapses::read(&edges, Afferent, Some("delay")).expect("read");
        assert_eq!(read.len(), 4);
        let facts = read.facts(2).expect("a synapse");
        assert_eq!((facts.cell, facts.partner, facts.number), (1, 9, Some(2.5)));
        assert_eq!(read.facts(4), None);
        // Cell 1 was turned and moved, cell 3 has a synapse without a place.
        let turned = glam::DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let moved = glam::DAffine3::from_rotation_translation(turned, DVec3::Y * 100.0);
        let shown = HashMap::from([(1, moved), (3, glam::DAffine3::IDENTITY)]);
        let shown = ShownCells::from([("post".to_owned(), shown)]);
        let set = synapse_markers(&[(&read, &shown)], Some("delay"), &scheme());
        let rows: Vec<u64> = set.rows.iter().map(|row| row.row).collect();
        assert_eq!((rows, set.left_out), (vec![0, 2], 2));
        let place = DVec3::new(-1.0, 120.0, 2.0);
        assert!(set.markers[1].position.distance(place) < 1e-9);
        assert!(set.legend.is_bar() && set.bounds().is_none());
        let missing = EdgeSynapses::read(&edges, Afferent, Some("size")).expect_err("none");
        assert!(missing.to_string().contains("it has delay"), "{missing}");
    }
}
