//! Spines that grow on a cell.

use serde::{Deserialize, Serialize};

/// Which spines grow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SpineEdit {
    /// Where.
    pub places: SpinePlaces,
    /// How many on each µm of dendrites, where places are random.
    pub density: f64,
    /// Another seed gives other sizes, directions and random places.
    pub seed: u64,
}

/// Where spines grow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SpinePlaces {
    /// At random places of dendrites.
    #[default]
    Random,
    /// Where the file tells of spines.
    File,
    /// At the synapses that the cell gets in its circuit.
    Synapses,
}

impl Default for SpineEdit {
    fn default() -> Self {
        Self {
            places: SpinePlaces::Random,
            density: 1.0,
            seed: 1,
        }
    }
}

impl SpineEdit {
    /// Spines at such places.
    pub fn at(places: SpinePlaces) -> Self {
        Self {
            places,
            ..Self::default()
        }
    }
}
