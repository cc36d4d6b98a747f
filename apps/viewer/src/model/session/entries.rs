//! The lists of a session's file: circuits, nodes, tracings and neurons.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::model::document::{Neuron, NeuronState, PlacementEntry, SomaEdit};
use crate::model::ids::SourceId;

/// A circuit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CircuitEntry {
    /// Relative to the session's folder where it can be.
    pub path: PathBuf,
}

/// A node of a circuit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeEntry {
    /// Index of the circuit in the list, from 0.
    pub circuit: usize,
    /// The population's name.
    pub population: String,
    /// The node's id in its population.
    pub id: u64,
}

/// A tracing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileEntry {
    /// Relative to the session's folder where it can be.
    pub path: PathBuf,
    /// How its soma is generated; none: in the default way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub soma: Option<SomaEdit>,
}

/// A neuron.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NeuronEntry {
    /// Name in the list.
    pub name: String,
    /// Index of its tracing in the list of files, from 0.
    pub file: usize,
    /// Whether it is hidden.
    #[serde(default, skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// Whether it is selected.
    #[serde(default, skip_serializing_if = "is_false")]
    pub selected: bool,
    /// Whether it is clamped.
    #[serde(default, skip_serializing_if = "is_false")]
    pub clamped: bool,
    /// Its node, if it belongs to a circuit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node: Option<NodeEntry>,
    /// Its placement; none: where it was traced.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) place: Option<PlacementEntry>,
}

impl NeuronEntry {
    /// The neuron of this entry, whose tracing is `source`.
    pub(crate) fn neuron(&self, source: SourceId) -> Neuron {
        Neuron {
            placement: self.place.map(Into::into).unwrap_or_default(),
            ..Neuron::new(source, self.name.clone())
        }
    }

    /// How it shows.
    pub(crate) fn state(&self) -> NeuronState {
        NeuronState {
            hidden: self.hidden,
            selected: self.selected && !self.hidden,
            clamped: self.clamped,
        }
    }
}

fn is_false(value: &bool) -> bool {
    !value
}
