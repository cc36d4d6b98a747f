//! Synapses and points of the picture: which of those that were read show, where, and in which color.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use neurotess::circuit::{NodeRef, PointTable};
use neurotess::coloring::{
    self, ColorScheme, ColoredThing, MarkerRow, MarkerSet, OwnColors, ShownCell, ShownCells,
    SynapseOptions, SynapsesOf,
};
use neurotess::render::color::{ColorMap, Rgb};
use neurotess::render::overlay::Legend;
use neurotess::render::{
    DeviceError, Gpu, Marker, MarkerSettings, MarkerShape, Markers, Placement,
};

use crate::model::circuits::Circuits;
use crate::model::document::MarkerOptions;
use crate::model::ids::CircuitId;
use crate::model::markers::{CircuitSynapses, MarkerRef};
use crate::model::revision::Revision;
use crate::model::state::{PlacementsKey, State};
use crate::scene::colors::color_scheme;
use crate::scene::content::SceneContent;

/// Least diameter (pixels) of a marker.
const LEAST: f64 = 3.0;
/// Share of a budget of triangles that markers may take beside it.
const SHARE_OF_BUDGET: f64 = 0.2;
/// Categories of the color table before those of markers, at least: with others for the cells, markers
/// keep their color keys.
const FEWEST_CATEGORIES: usize = 1024;

/// What the markers of the picture depend on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MarkerInputs {
    data: Revision,
    options: MarkerOptions,
    cells: CellsKey,
    own: OwnColors,
    scale: (ColorMap, bool, Rgb),
    first: usize,
}

/// Which cells show, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CellsKey {
    placements: PlacementsKey,
    hidden: Revision,
    selection: Option<Revision>,
    grid: bool,
}

impl MarkerInputs {
    /// None if there are no markers to show.
    pub(crate) fn new(state: &State, content: &SceneContent) -> Option<Self> {
        let (document, data) = (&state.document, &state.marker_data);
        let options = &document.markers;
        let synapses = options.synapses && data.synapses().is_some();
        let points = state.shows_points() && data.points().is_some();
        if !(synapses || points) {
            return None;
        }
        let (look, revisions) = (&document.look, document.neurons.revisions());
        Some(Self {
            data: data.revision(),
            options: MarkerOptions {
                // How large they are is told to the device when they are drawn, and so is their shape, but for
                // where contacts lie.
                size: 0.0,
                shape: match options.shape {
                    MarkerShape::Contact => MarkerShape::Contact,
                    MarkerShape::Point | MarkerShape::Sphere => MarkerShape::Sphere,
                },
                ..options.clone()
            },
            cells: CellsKey {
                placements: state.placements_key(),
                hidden: revisions.hidden,
                selection: options.of_selected.then_some(revisions.selection),
                grid: document.grid,
            },
            own: look.own_colors.clone(),
            scale: (look.color_map, look.trim_map, look.background),
            first: first_category(content),
        })
    }
}

/// The first category of markers, after those of the cells.
fn first_category(content: &SceneContent) -> usize {
    let cells = content.categories.max(FEWEST_CATEGORIES);
    cells.next_power_of_two()
}

/// All that markers are made of, for another thread.
pub(crate) struct MarkerRequest {
    synapses: Option<Arc<Vec<CircuitSynapses>>>,
    points: Option<(PathBuf, Arc<PointTable>)>,
    options: MarkerOptions,
    circuits: Circuits,
    /// Nodes that show, and how each was moved (µm) and turned.
    shown: Vec<(CircuitId, NodeRef, DAffine3)>,
    scheme: ColorScheme,
    first: usize,
}

/// Markers, and what their colors mean.
#[derive(Clone, Debug)]
pub(crate) struct SceneMarkers {
    /// Where they are; their color keys belong to the table of [`SceneMarkers::add_to`].
    pub(crate) markers: Vec<Marker>,
    rows: Vec<MarkerRow>,
    /// How many of them are synapses, before the points.
    synapses: usize,
    colors: Vec<Rgb>,
    first: usize,
    legend: Legend,
    pub(crate) things: Vec<ColoredThing>,
}

impl MarkerRequest {
    /// None if there are no markers to show.
    pub(crate) fn new(state: &State, content: &SceneContent) -> Option<Self> {
        MarkerInputs::new(state, content)?;
        let (document, data) = (&state.document, &state.marker_data);
        let options = document.markers.clone();
        let neurons = &document.neurons;
        let selected = neurons.selected();
        let of_selected = options.of_selected && !selected.is_empty();
        let placements = state.placements();
        let placed = neurons.iter().zip(placements.iter()).enumerate();
        let placed =
            placed.filter(|(i, _)| neurons.shows(*i) && (!of_selected || selected.contains(*i)));
        let shown = placed.filter_map(|(_, (neuron, placement))| {
            let node = neuron.node?;
            Some((node.circuit, node.node, moved(&neuron.traced, placement)))
        });
        let points = data.points().filter(|_| state.shows_points());
        Some(Self {
            synapses: data.synapses().filter(|_| options.synapses).cloned(),
            points: points.map(|(file, table)| (file.to_path_buf(), Arc::clone(table))),
            shown: shown.collect(),
            circuits: state.circuits.clone(),
            scheme: color_scheme(&document.look),
            first: first_category(content),
            options,
        })
    }

    /// The markers; and why some are not shown as asked for.
    pub(crate) fn markers(&self) -> (SceneMarkers, Option<(String, String)>) {
        let mut problem = None;
        let synapses = self.synapses.as_ref().map(|read| self.of_synapses(read));
        if synapses.as_ref().is_some_and(|set| set.placeless > 0) {
            // Without their number, which changes with the selection: it is told once.
            let why = "some have no place, or name sections that the tracings of their cells do not have: they are left out";
            problem = Some(("synapses".to_owned(), why.to_owned()));
        }
        let points = self.points.as_ref().map(|(file, table)| {
            let name = file.display().to_string();
            let column = self.options.column.as_deref();
            let points = |column| coloring::points(&name, table, column, &self.scheme);
            points(column).or_else(|e| {
                problem = Some(("points".to_owned(), e.to_string()));
                points(None)
            })
        });
        let points = points.and_then(Result::ok);
        let mut all = SceneMarkers {
            markers: Vec::new(),
            rows: Vec::new(),
            synapses: synapses.as_ref().map_or(0, |set| set.markers.len()),
            colors: Vec::new(),
            first: self.first,
            legend: Legend::swatches("", []),
            things: Vec::new(),
        };
        let sets = synapses.into_iter().chain(points);
        let mut legends = Vec::new();
        for set in sets.filter(|set| !set.markers.is_empty()) {
            all.add(&set);
            legends.push(set.legend);
        }
        // The last one is below the others.
        if let Some(legend) = legends
            .into_iter()
            .rev()
            .reduce(|below, l| l.with_below(below))
        {
            all.legend = legend;
        }
        (all, problem)
    }

    fn of_synapses(&self, read: &[CircuitSynapses]) -> MarkerSet {
        let mut shown: HashMap<CircuitId, ShownCells> = HashMap::new();
        for &(id, node, moved) in &self.shown {
            let Some(circuit) = self.circuits.get(id) else {
                continue;
            };
            let population = &circuit.populations[node.population as usize];
            let cells = shown.entry(id).or_default();
            if !cells.contains_key(&population.name) {
                cells.insert(population.name.clone(), HashMap::new());
            }
            if let Some(cells) = cells.get_mut(&population.name) {
                let cell = ShownCell { node, moved };
                cells.insert(population.ids[node.row as usize], cell);
            }
        }
        let none = ShownCells::new();
        let cells = |id: &CircuitId| shown.get(id).unwrap_or(&none);
        let of = read.iter().filter_map(|read| {
            Some(SynapsesOf {
                edges: &read.edges,
                circuit: self.circuits.get(read.circuit)?,
                shown: cells(&read.circuit),
            })
        });
        let of: Vec<SynapsesOf<'_>> = of.collect();
        let options = SynapseOptions {
            property: self.options.property.clone(),
            contacts: self.options.shape == MarkerShape::Contact,
            ..SynapseOptions::default()
        };
        coloring::synapse_markers(&of, &options, &self.scheme)
    }
}

/// From places where a cell was to places where it is.
fn moved(from: &Placement, to: &Placement) -> DAffine3 {
    if from == to {
        return DAffine3::IDENTITY;
    }
    let [from, to] = [from, to].map(|place| {
        let scale = DVec3::splat(place.scale);
        DAffine3::from_scale_rotation_translation(scale, place.rotation, place.translation)
    });
    to * from.inverse()
}

impl SceneMarkers {
    fn add(&mut self, set: &MarkerSet) {
        let first = (self.first + self.colors.len()) as u32;
        let moved = set.markers.iter().map(|marker| Marker {
            color_key: marker.color_key + first,
            ..*marker
        });
        self.markers.extend(moved);
        self.rows.extend_from_slice(&set.rows);
        self.colors.extend_from_slice(&set.colors);
        self.things.extend_from_slice(set.things());
    }

    /// Uploads them, if there are any.
    pub(crate) fn upload(&self, gpu: &Gpu) -> Result<Option<Markers>, DeviceError> {
        if self.markers.is_empty() {
            return Ok(None);
        }
        Markers::new(gpu, &self.markers, MarkerSettings::default()).map(Some)
    }

    /// Whether cells have so few categories that those of markers can follow them.
    pub(crate) fn fits(&self, content: &SceneContent) -> bool {
        content.categories <= self.first
    }

    /// Whether others are at the same places with the same color keys, so that only colors differ.
    pub(crate) fn is_recolored(&self, other: &Self) -> bool {
        self.markers == other.markers && self.rows == other.rows && self.first == other.first
    }

    /// Adds their colors to the table and the legend of the cells.
    pub(crate) fn add_to(&self, content: &mut SceneContent) {
        let cells = std::mem::take(&mut content.table.categories);
        content.table.categories = self.categories(&cells);
        content.legend = self.legend_below(content.legend.clone());
    }

    /// The colors of all, cells and markers.
    pub(crate) fn categories(&self, cells: &[Rgb]) -> Vec<Rgb> {
        let mut all = cells.to_vec();
        let last = all.last().copied().unwrap_or(coloring::NOTHING);
        all.resize(self.first, last);
        all.extend_from_slice(&self.colors);
        all
    }

    /// The cells' legend, with that of markers below.
    pub(crate) fn legend_below(&self, cells: Legend) -> Legend {
        match self.markers.is_empty() {
            true => cells,
            false => cells.with_below(self.legend.clone()),
        }
    }

    /// Colors with names.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (Rgb, String)> {
        let things = self.things.iter();
        things.map(|thing| (thing.color, thing.target.to_string()))
    }

    /// What the marker of an index is.
    pub(crate) fn marker(&self, index: usize) -> Option<MarkerRef> {
        let row = *self.rows.get(index)?;
        Some(match index < self.synapses {
            true => MarkerRef::Synapse(row),
            false => MarkerRef::Point(row.row),
        })
    }
}

/// How markers are drawn. `sub_pixels`: width of a pixel; `budget`: triangles of the cells, if there is a
/// most; `most`: of markers, if there is none.
pub(crate) fn settings(
    (shape, radius): (MarkerShape, f64),
    sub_pixels: f64,
    budget: Option<u32>,
    most: usize,
) -> MarkerSettings {
    MarkerSettings {
        shape,
        radius,
        least: 0.5 * LEAST * sub_pixels,
        most_triangles: budget.map_or(most, |n| (SHARE_OF_BUDGET * f64::from(n)) as usize),
    }
}
