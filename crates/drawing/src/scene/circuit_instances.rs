//! Instances of a circuit that are drawn, with what colors need.

use itertools::Itertools;
use neurotess_circuit::{Circuit, Instance, NodeRef};
use neurotess_color::Node;

/// A circuit and those of its cells that are drawn.
pub struct CircuitInstances {
    /// The circuit.
    pub circuit: Circuit,
    /// In the order of the placements.
    pub instances: Vec<Instance>,
}

impl CircuitInstances {
    /// The node of each instance.
    pub(crate) fn nodes(&self) -> Vec<Option<Node<'_>>> {
        let circuit = &self.circuit;
        let node = |instance: &Instance| {
            let node = instance.node;
            Some(Node { circuit, node })
        };
        self.instances.iter().map(node).collect()
    }

    /// The node of each instance, in the circuit.
    pub fn refs(&self) -> Vec<NodeRef> {
        self.instances
            .iter()
            .map(|instance| instance.node)
            .collect()
    }

    /// The cell that each instance shows, as given, and its node.
    pub(crate) fn with_cells(&self, cells: &[usize]) -> Vec<(usize, Option<NodeRef>)> {
        let nodes = self.instances.iter().map(|instance| Some(instance.node));
        cells.iter().copied().zip_eq(nodes).collect()
    }

    /// The name of each instance.
    pub fn names(&self) -> Vec<String> {
        let name = |instance: &Instance| {
            let population = &self.circuit.populations[instance.node.population as usize];
            format!("{} {}", population.name, instance.id)
        };
        self.instances.iter().map(name).collect()
    }
}
