//! Synapses of a circuit as their file has them: read once, and shown in part.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use neurotess_circuit::{Circuit, Compartment, Edges, NodeRef, SynapseSide};

use super::{MarkerError, listed};

/// Synapses of a population of edges on one side, as the file has them.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeSynapses {
    /// Name of the population of edges.
    pub name: String,
    /// Population of the cells that they lie on.
    pub cells: String,
    /// Population of the cells at their other side.
    pub partners: String,
    pub(super) nodes: Vec<u64>,
    others: Vec<u64>,
    pub(super) places: Places,
    numbers: Option<Vec<f64>>,
}

/// Where synapses lie.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Places {
    /// Coordinates (µm) of the circuit.
    At(Vec<DVec3>),
    /// Shares of sections of their cells, around which they lie on the membrane.
    Along(Vec<Compartment>),
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

/// A cell whose synapses are shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownCell {
    /// Which node of the circuit it is.
    pub node: NodeRef,
    /// How it was moved (µm) and turned from where the circuit places it.
    pub moved: DAffine3,
}

/// Cells whose synapses are shown, by population and id.
pub type ShownCells = HashMap<String, HashMap<u64, ShownCell>>;

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
        let places = match read.positions.is_empty() {
            true => Places::Along(edges.shares_on(side)?),
            false => Places::At(read.positions),
        };
        if places.len() != nodes.len() {
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
            places,
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

    /// What is known of one, by its number in the file. `circuit`: that of the edges.
    pub fn facts(&self, row: u64, circuit: &Circuit) -> Option<SynapseFacts> {
        let at = usize::try_from(row).ok()?;
        let cell = *self.nodes.get(at)?;
        let position = match &self.places {
            Places::At(places) => *places.get(at)?,
            Places::Along(shares) => {
                let node = circuit.node(&self.cells, cell)?;
                let instance = *circuit.instances(&[node], None).first()?;
                let membrane = circuit.membrane(instance.template)?;
                let place = membrane.place(*shares.get(at)?)?;
                let world_from_cell = instance.world_from_cell(membrane.soma_center());
                world_from_cell.transform_point3(place.at(place.outwards(row)))
            }
        };
        Some(SynapseFacts {
            cell,
            partner: *self.others.get(at)?,
            position,
            number: self.numbers.as_ref().and_then(|n| n.get(at).copied()),
        })
    }

    /// The number of a row; NaN if none were read.
    pub(super) fn number(&self, row: usize) -> f64 {
        let numbers = self.numbers.as_ref();
        numbers.map_or(f64::NAN, |numbers| numbers[row])
    }
}

impl Places {
    fn len(&self) -> usize {
        match self {
            Self::At(places) => places.len(),
            Self::Along(shares) => shares.len(),
        }
    }
}

/// Synapses that were read, and which of them are shown.
#[derive(Clone, Copy, Debug)]
pub struct SynapsesOf<'a> {
    /// The synapses.
    pub edges: &'a EdgeSynapses,
    /// Their circuit.
    pub circuit: &'a Circuit,
    /// The cells whose synapses are shown.
    pub shown: &'a ShownCells,
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
