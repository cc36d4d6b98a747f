//! Which cells of a circuit.

use neurotess_circuit::{Circuit, CircuitError, NodeRef, Selection};
use serde::{Deserialize, Serialize};

use crate::words::{Ids, Region};

/// Which cells of a circuit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Cells of a circuit"))]
#[serde(default, deny_unknown_fields)]
pub struct CellSelection {
    /// Only cells with these ids, as in 0,5,10-19
    #[cfg_attr(feature = "clap", arg(long, value_name = "IDS"))]
    pub nodes: Option<Ids>,
    /// Only cells of this node set
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub node_set: Option<String>,
    /// Only cells of this population
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub population: Option<String>,
    /// Only N cells, spread at random
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub sample: Option<usize>,
    /// Seed of the sample
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", default_value_t = 1))]
    pub sample_seed: u64,
    /// Only cells with their soma in this box: X,Y,Z,X,Y,Z of two corners (µm)
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "BOX", allow_hyphen_values = true)
    )]
    pub region: Option<Region>,
    /// Only these cells: of programs that hold the circuit in memory.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(skip)]
    pub listed: Option<Vec<NodeRef>>,
}

impl Default for CellSelection {
    fn default() -> Self {
        Self {
            nodes: None,
            node_set: None,
            population: None,
            sample: None,
            sample_seed: 1,
            region: None,
            listed: None,
        }
    }
}

impl CellSelection {
    /// Whether any option is given.
    pub fn any(&self) -> bool {
        let chosen = Self {
            sample_seed: Self::default().sample_seed,
            ..self.clone()
        };
        chosen != Self::default()
    }

    /// The selected cells.
    ///
    /// # Errors
    /// A population or node set that is not there; an id of several populations.
    pub fn select(&self, circuit: &Circuit) -> Result<Vec<NodeRef>, CircuitError> {
        circuit.select(&Selection {
            population: self.population.clone(),
            ids: self.nodes.as_ref().map(|ids| ids.0.clone()),
            nodes: self.listed.clone(),
            node_set: self.node_set.clone(),
            region: self.region.map(|Region(min, max)| (min, max)),
            sample: self.sample.map(|count| (count, self.sample_seed)),
        })
    }
}
