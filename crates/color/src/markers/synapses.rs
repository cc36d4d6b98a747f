//! Markers of synapses: of those that were read and whose cells are shown.

use std::collections::HashMap;

use glam::DAffine3;
use neurotess_circuit::{Circuit, Edges, NodeRef, SynapseSide};
use neurotess_picture::color::category;
use neurotess_picture::markers::Marker;

use super::edges::{EdgeSynapses, ShownCell, ShownCells, SynapsesOf};
use super::sites::placed;
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
    /// Whether markers lie on the membranes and know their directions, for contact discs.
    pub contacts: bool,
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
    let of = read.iter().map(|edges| SynapsesOf {
        edges,
        circuit,
        shown: &shown,
    });
    let of: Vec<SynapsesOf<'_>> = of.collect();
    Ok(synapse_markers(&of, options, scheme))
}

/// Markers of synapses that were read: of the cells that are shown. The table of a marker's row is the index in
/// `of`. Colors tell the property of the options, if there is one. Morphologies are used where places or contacts ask
/// for them: each is read once, if it was not.
pub fn synapse_markers(
    of: &[SynapsesOf<'_>],
    options: &SynapseOptions,
    scheme: &ColorScheme,
) -> MarkerSet {
    let mut markers = Vec::new();
    let mut rows = Vec::new();
    let mut values = Vec::new();
    let (mut left_out, mut placeless) = (0, 0);
    for (one, table) in of.iter().zip(0..) {
        let placed = placed(one, options.contacts);
        left_out += one.edges.len() - placed.of_shown;
        placeless += placed.of_shown - placed.sites.len();
        for (row, site) in placed.sites {
            markers.push(Marker {
                position: site.position,
                outwards: site.outwards,
                color_key: category(table),
            });
            rows.push(MarkerRow {
                table,
                row: row as u64,
            });
            values.push(one.edges.number(row));
        }
    }
    let mut set = match options.property.as_deref() {
        Some(name) => by_number(markers, &values, name, scheme),
        None => {
            let names = of.iter().map(|one| one.edges.name.clone());
            by_name(markers, names.collect(), scheme)
        }
    };
    set.rows = rows;
    (set.left_out, set.placeless, set.on_cells) = (left_out, placeless, true);
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
    for &node in nodes {
        let population = &circuit.populations[node.population as usize];
        let id = population.ids[node.row as usize];
        if !shown.contains_key(&population.name) {
            shown.insert(population.name.clone(), HashMap::new());
        }
        let cell = ShownCell {
            node,
            moved: DAffine3::IDENTITY,
        };
        let ids = shown.get_mut(&population.name);
        ids.map(|ids| ids.insert(id, cell));
    }
    shown
}
