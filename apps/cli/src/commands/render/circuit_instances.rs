//! What a circuit shows, cell by cell as they stand.

use neurotess::circuit::{Circuit, Instance, NodeRef};
use neurotess::coloring::Node;

/// A circuit and those of its cells that are drawn.
pub(crate) struct Shown {
    pub(crate) circuit: Circuit,
    /// As many as places.
    pub(crate) instances: Vec<Instance>,
}

impl Shown {
    /// The node at each place.
    pub(crate) fn neurons(&self) -> Vec<Option<Node<'_>>> {
        let circuit = &self.circuit;
        let node = |instance: &Instance| {
            let node = instance.node;
            Some(Node { circuit, node })
        };
        self.instances.iter().map(node).collect()
    }

    /// The cell and the node at each place.
    pub(crate) fn stand(&self, places: &[usize]) -> Vec<(usize, Option<NodeRef>)> {
        let nodes = self.instances.iter().map(|instance| Some(instance.node));
        places.iter().copied().zip(nodes).collect()
    }

    /// Name of the cell at each place.
    pub(crate) fn names(&self) -> Vec<String> {
        let name = |instance: &Instance| {
            let population = &self.circuit.populations[instance.node.population as usize];
            format!("{} {}", population.name, instance.id)
        };
        self.instances.iter().map(name).collect()
    }
}
