//! Markers of a circuit: synapses where its edges say they are, and points of tables.
//!
//! A marker's color key is a category, in a part of the color table that follows the cells' own
//! ([`Coloring::add_markers`]). Numbers are colored in steps of the scale.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use neurotess_circuit::{Circuit, CircuitError, Edges, NodeRef, PointTable, SynapseSide};
use neurotess_render::color::{CATEGORY_BIT, Rgb, category};
use neurotess_render::overlay::Legend;
use neurotess_render::{BoundingSphere, Marker};

use crate::own_colors::{ColorTarget, ColoredThing};
use crate::scheme::{ColorScheme, Coloring, NOTHING};

/// Which synapses are shown, and what their colors tell.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SynapseOptions {
    /// Names of populations of edges; none: all.
    pub populations: Vec<String>,
    /// The side whose place and cell are meant.
    pub side: SynapseSide,
    /// A number of each synapse, such as `delay`; none: colors tell the population.
    pub property: Option<String>,
}

/// Markers, and what their colors mean.
#[derive(Clone, Debug)]
pub struct MarkerSet {
    /// The markers. Color keys are categories from 0 on, until [`Coloring::add_markers`] has moved them.
    pub markers: Vec<Marker>,
    /// The color of each category.
    pub colors: Vec<Rgb>,
    /// The legend.
    pub legend: Legend,
    /// How many were left out, because their cell is not drawn.
    pub left_out: usize,
    /// What has a color that one may set.
    things: Vec<ColoredThing>,
    /// Whether they lie on cells that are drawn.
    on_cells: bool,
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

/// Synapses of the cells that are drawn.
///
/// # Errors
/// There are no such edges, they have no places, or a file is invalid.
pub fn synapses(
    circuit: &Circuit,
    drawn: &[NodeRef],
    options: &SynapseOptions,
    scheme: &ColorScheme,
) -> Result<MarkerSet, MarkerError> {
    let chosen = chosen(circuit, &options.populations)?;
    let drawn = ids(circuit, drawn);
    let mut markers = Vec::new();
    let mut values = Vec::new();
    let mut left_out = 0;
    for (edges, number) in chosen.iter().zip(0..) {
        let read = edges.synapses_on(options.side)?;
        let (population, nodes, side) = match options.side {
            SynapseSide::Afferent => (&edges.target, &read.targets, "afferent"),
            SynapseSide::Efferent => (&edges.source, &read.sources, "efferent"),
        };
        if read.positions.is_empty() && !nodes.is_empty() {
            return Err(MarkerError::NoPlaces {
                file: edges.file.display().to_string(),
                name: edges.name.clone(),
                side,
            });
        }
        let numbers = match &options.property {
            Some(name) => Some(property(edges, name)?),
            None => None,
        };
        let here = drawn.get(population.as_str());
        for (row, (node, &position)) in nodes.iter().zip(&read.positions).enumerate() {
            let shown = here.is_some_and(|ids| ids.contains(node)) && position.is_finite();
            if !shown {
                left_out += 1;
                continue;
            }
            let color_key = category(number);
            markers.push(Marker {
                position,
                color_key,
            });
            values.extend(numbers.as_ref().map(|numbers| numbers[row]));
        }
    }
    let mut set = match &options.property {
        Some(name) => by_number(markers, &values, name, scheme),
        None => {
            let names = chosen.iter().map(|edges| edges.name.clone());
            by_name(markers, names.collect(), scheme)
        }
    };
    (set.left_out, set.on_cells) = (left_out, true);
    Ok(set)
}

/// Points of a table. `property`: the column that colors tell; none: all have one color.
///
/// # Errors
/// There is no such column of numbers.
pub fn points(
    file: &str,
    table: &PointTable,
    property: Option<&str>,
    scheme: &ColorScheme,
) -> Result<MarkerSet, MarkerError> {
    let marker = |&position| Marker {
        position,
        color_key: category(0),
    };
    let markers: Vec<Marker> = table.positions.iter().map(marker).collect();
    let Some(name) = property else {
        let stem = std::path::Path::new(file).file_stem().unwrap_or_default();
        return Ok(by_name(
            markers,
            vec![stem.to_string_lossy().into_owned()],
            scheme,
        ));
    };
    let column = table.columns.iter().find(|(column, _)| column == name);
    let (_, values) = column.ok_or_else(|| MarkerError::NoNumbers {
        file: file.to_owned(),
        name: name.to_owned(),
        there: listed(table.columns.iter().map(|(name, _)| name.as_str())),
    })?;
    Ok(by_number(markers, values, name, scheme))
}

fn chosen<'c>(circuit: &'c Circuit, names: &[String]) -> Result<Vec<&'c Edges>, MarkerError> {
    if names.is_empty() && !circuit.edges.is_empty() {
        return Ok(circuit.edges.iter().collect());
    }
    let none = |name: &str| MarkerError::NoEdges {
        file: circuit.file.clone(),
        name: name.to_owned(),
        there: listed(circuit.edges.iter().map(|edges| edges.name.as_str())),
    };
    if names.is_empty() {
        return Err(none("of any name"));
    }
    let found = names.iter().map(|name| {
        let found = circuit.edges.iter().find(|edges| edges.name == *name);
        found.ok_or_else(|| none(name))
    });
    found.collect()
}

/// Ids of nodes by the name of their population.
fn ids<'c>(circuit: &'c Circuit, nodes: &[NodeRef]) -> HashMap<&'c str, HashSet<u64>> {
    let mut ids: HashMap<&str, HashSet<u64>> = HashMap::new();
    for node in nodes {
        let population = &circuit.populations[node.population as usize];
        let id = population.ids[node.row as usize];
        ids.entry(&population.name).or_default().insert(id);
    }
    ids
}

fn property(edges: &Edges, name: &str) -> Result<Vec<f64>, MarkerError> {
    let there = edges.properties()?;
    if there.iter().any(|known| known == name) {
        return Ok(edges.property(name)?);
    }
    Err(MarkerError::NoNumbers {
        file: edges.file.display().to_string(),
        name: name.to_owned(),
        there: listed(there.iter().map(String::as_str)),
    })
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
        // Categories of cells beyond the end of the table have its last color: they keep it.
        let keys = self.color_keys.iter().flatten();
        let categories = keys.filter(|&key| key & CATEGORY_BIT != 0);
        let used = categories
            .map(|key| (key & !CATEGORY_BIT) as usize + 1)
            .max();
        let own = &mut self.table.categories;
        let last = own.last().copied().unwrap_or(NOTHING);
        let first = own.len().max(used.unwrap_or(0));
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
    use neurotess_render::color::{ColorMap, Palette};

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
}
