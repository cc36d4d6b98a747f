//! Circuits that are open, with the attributes of their nodes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use neurotess::circuit::{Circuit, Instance, soma_center};
use neurotess::coloring::{self, Node};
use neurotess::morphology::Morphology;
use neurotess::render::Placement;

use crate::model::ids::{CircuitId, CircuitNode};

/// A circuit and the file or folder that was opened.
pub(crate) type Opened = (PathBuf, Arc<Circuit>);

/// All circuits that were opened.
#[derive(Clone, Debug, Default)]
pub struct Circuits(Vec<Opened>);

impl Circuits {
    /// Adds a circuit.
    pub fn add(&mut self, opened: Opened) -> CircuitId {
        self.0.push(opened);
        CircuitId(self.0.len() as u32 - 1)
    }

    /// The file or folder of a circuit.
    pub fn file(&self, id: CircuitId) -> Option<&Path> {
        self.0.get(id.0 as usize).map(|(file, _)| file.as_path())
    }

    /// A circuit.
    pub fn get(&self, id: CircuitId) -> Option<&Circuit> {
        self.0.get(id.0 as usize).map(|(_, circuit)| &**circuit)
    }

    /// A circuit, for another thread.
    pub(crate) fn shared(&self, id: CircuitId) -> Option<Arc<Circuit>> {
        self.0
            .get(id.0 as usize)
            .map(|(_, circuit)| Arc::clone(circuit))
    }

    /// All circuits with their ids.
    pub fn iter(&self) -> impl Iterator<Item = (CircuitId, &Circuit)> {
        let circuits = self.0.iter().map(|(_, circuit)| &**circuit);
        (0..).map(CircuitId).zip(circuits)
    }

    /// A node with its circuit, for coloring.
    pub fn node(&self, of: CircuitNode) -> Option<Node<'_>> {
        let (circuit, node) = (self.get(of.circuit)?, of.node);
        Some(Node { circuit, node })
    }

    /// Attributes that colors can show.
    pub fn attributes(&self) -> Vec<String> {
        coloring::attributes(self.iter().map(|(_, circuit)| circuit))
    }

    /// Files of the reports that circuits name, with the names.
    pub fn reports(&self) -> Vec<(String, PathBuf)> {
        let all = self.iter().flat_map(|(_, circuit)| &circuit.reports);
        all.map(|(name, file)| (name.clone(), file.clone()))
            .collect()
    }
}

/// Where a circuit places an instance of a morphology.
pub(crate) fn placement(instance: &Instance, morphology: &Morphology) -> Placement {
    let center = soma_center(morphology);
    Placement {
        rotation: instance.rotation,
        scale: instance.scale,
        translation: instance.world_from_cell(center).translation,
    }
}
