//! Populations of nodes, and their attributes.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};

use crate::template::TemplateId;

/// Nodes of one kind, as parallel arrays: node `i` is row `i` of each.
#[derive(Clone, Debug, Default)]
pub struct Population {
    /// Its name.
    pub name: String,
    /// The configuration's text for it: `biophysical`, `virtual`, …; empty where it has none.
    pub kind: String,
    /// Ids that the file gives its nodes: 0, 1, 2, … if it gives none.
    pub ids: Vec<u64>,
    /// Where the soma's center goes (µm); NaN for nodes that have no place.
    pub positions: Vec<DVec3>,
    /// From the morphology's axes to the circuit's; unit quaternions.
    pub rotations: Vec<DQuat>,
    /// Factors on the morphology's size; empty if all are 1.
    pub scales: Vec<f64>,
    /// Whether the soma's center is moved to the origin before the cell is turned; empty if all are.
    pub recentered: Vec<bool>,
    /// Morphologies; `None` for nodes that show nothing.
    pub templates: Vec<Option<TemplateId>>,
    /// Everything else that nodes have, by name.
    pub attributes: BTreeMap<String, Attribute>,
}

/// A column of attributes.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Text, each as its place in a list of distinct ones.
    Text {
        /// Distinct texts in the order of their first appearance.
        library: Vec<String>,
        /// Places in `library`; [`Attribute::NONE`] where there is none.
        indices: Vec<u32>,
    },
}

impl Attribute {
    /// The index of no text.
    pub const NONE: u32 = u32::MAX;

    /// The text of a row, if this is a column of texts and the row has one.
    pub fn text(&self, row: usize) -> Option<&str> {
        match self {
            Self::Numbers(_) => None,
            Self::Text { library, indices } => {
                let place = *indices.get(row)?;
                library.get(place as usize).map(String::as_str)
            }
        }
    }

    /// The number of a row, if this is a column of numbers and the row has one.
    pub fn number(&self, row: usize) -> Option<f64> {
        match self {
            Self::Numbers(values) => values.get(row).copied().filter(|v| !v.is_nan()),
            Self::Text { .. } => None,
        }
    }
}

/// A node: a row of a population.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeRef {
    /// Index in [`Circuit::populations`](crate::Circuit::populations).
    pub population: u32,
    /// Row in the population.
    pub row: u32,
}

impl Population {
    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there is no node.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Where a node is (µm), if it has a place.
    pub fn position(&self, row: usize) -> Option<DVec3> {
        self.positions.get(row).copied().filter(|p| p.is_finite())
    }
}
