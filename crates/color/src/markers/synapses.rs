//! Synapses of a circuit, read once from their file and shown in part.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use neurotess_circuit::{Circuit, Edges, NodeRef, SynapseSide};
use neurotess_render::Marker;
use neurotess_render::color::category;

use super::{MarkerError, MarkerRow, MarkerSet, by_name, by_number, listed};
use crate::scheme::ColorScheme;

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

/// Synapses of a population of edges on one side, as the file has them.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeSynapses {
    /// Name of the population of edges.
    pub name: String,
    /// Population of the cells that they lie on.
    pub cells: String,
    /// Population of the cells at their other side.
    pub partners: String,
    nodes: Vec<u64>,
    others: Vec<u64>,
    positions: Vec<DVec3>,
    numbers: Option<Vec<f64>>,
}

/// What is known of a synapse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SynapseFacts {
    /// Id of the cell that it lies on.
    pub cell: u64,
    /// Id of the cell at its other side.
    pub partner: u64,
    /// Where it is (µm, in the circuit's coordinates).
    pub position: DVec3,
    /// Its number, if one was read.
    pub number: Option<f64>,
}

/// By population: the ids of cells whose synapses are shown, and how each was moved (µm) and turned from where
/// the circuit places it.
pub type ShownCells = HashMap<String, HashMap<u64, DAffine3>>;

impl EdgeSynapses {
    /// Reads places and both cells of each synapse, and a number of each. Needs 48 bytes for each.
    ///
    /// # Errors
    /// The file does not have these, or is invalid.
    pub fn read(
        edges: &Edges,
        side: SynapseSide,
        property: Option<&str>,
    ) -> Result<Self, MarkerError> {
        let read = edges.synapses_on(side)?;
        let targets = (edges.target.clone(), read.targets);
        let sources = (edges.source.clone(), read.sources);
        let ((cells, nodes), (partners, others), name) = match side {
            SynapseSide::Afferent => (targets, sources, "afferent"),
            SynapseSide::Efferent => (sources, targets, "efferent"),
        };
        if read.positions.is_empty() && !nodes.is_empty() {
            return Err(MarkerError::NoPlaces {
                file: edges.file.display().to_string(),
                name: edges.name.clone(),
                side: name,
            });
        }
        let numbers = property.map(|name| numbers(edges, name)).transpose()?;
        Ok(Self {
            name: edges.name.clone(),
            cells,
            partners,
            nodes,
            others,
            positions: read.positions,
            numbers,
        })
    }

    /// Number of synapses.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// What is known of one, by its number in the file.
    pub fn facts(&self, row: u64) -> Option<SynapseFacts> {
        let row = usize::try_from(row).ok()?;
        Some(SynapseFacts {
            cell: *self.nodes.get(row)?,
            partner: *self.others.get(row)?,
            position: *self.positions.get(row)?,
            number: self.numbers.as_ref().and_then(|n| n.get(row).copied()),
        })
    }
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
    let property = options.property.as_deref();
    let chosen = chosen(circuit, &options.populations)?;
    let read = chosen.iter();
    let read = read.map(|edges| EdgeSynapses::read(edges, options.side, property));
    let read: Vec<EdgeSynapses> = read.collect::<Result<_, _>>()?;
    let shown = where_placed(circuit, drawn);
    let of: Vec<_> = read.iter().map(|edges| (edges, &shown)).collect();
    Ok(synapse_markers(&of, property, scheme))
}

/// Markers of synapses that were read: of the cells that are shown. The table of a marker's row is the index in
/// `of`. `property`: the number's name, if colors tell it.
pub fn synapse_markers(
    of: &[(&EdgeSynapses, &ShownCells)],
    property: Option<&str>,
    scheme: &ColorScheme,
) -> MarkerSet {
    let mut markers = Vec::new();
    let mut rows = Vec::new();
    let mut values = Vec::new();
    let mut left_out = 0;
    for ((edges, shown), table) in of.iter().zip(0..) {
        let here = shown.get(&edges.cells);
        let placed = edges.nodes.iter().zip(&edges.positions);
        for ((node, &position), row) in placed.zip(0_u64..) {
            let moved = here.and_then(|ids| ids.get(node));
            let Some(moved) = moved.filter(|_| position.is_finite()) else {
                left_out += 1;
                continue;
            };
            markers.push(Marker {
                position: moved.transform_point3(position),
                color_key: category(table),
            });
            rows.push(MarkerRow { table, row });
            let numbers = edges.numbers.as_ref();
            values.push(numbers.map_or(f64::NAN, |numbers| numbers[row as usize]));
        }
    }
    let mut set = match property {
        Some(name) => by_number(markers, &values, name, scheme),
        None => {
            let names = of.iter().map(|(edges, _)| edges.name.clone());
            by_name(markers, names.collect(), scheme)
        }
    };
    (set.rows, set.left_out, set.on_cells) = (rows, left_out, true);
    set
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

/// Cells that are drawn where the circuit places them.
fn where_placed(circuit: &Circuit, nodes: &[NodeRef]) -> ShownCells {
    let mut shown = ShownCells::new();
    for node in nodes {
        let population = &circuit.populations[node.population as usize];
        let id = population.ids[node.row as usize];
        if !shown.contains_key(&population.name) {
            shown.insert(population.name.clone(), HashMap::new());
        }
        let ids = shown.get_mut(&population.name);
        ids.map(|ids| ids.insert(id, DAffine3::IDENTITY));
    }
    shown
}

fn numbers(edges: &Edges, name: &str) -> Result<Vec<f64>, MarkerError> {
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
