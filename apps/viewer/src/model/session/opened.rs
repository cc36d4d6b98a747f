//! What of a session is opened: neurons whose tracings could be read, and what refers to them.

use super::{NeuronEntry, Session};
use crate::model::circuits::{self, Circuits};
use crate::model::document::{Dimension, Neuron, Neurons, Trace};
use crate::model::ids::{CircuitNode, SourceId};
use crate::model::state::State;

impl Session {
    /// The dimensions whose neurons could be opened. `opened`: by neuron of the session, its index
    /// in the document.
    pub(crate) fn dimensions(&self, opened: &[Option<usize>]) -> Vec<Dimension> {
        let index = |neuron: usize| opened.get(neuron).copied().flatten();
        let dimensions = self.dimension.iter();
        dimensions.filter_map(|d| d.renumbered(index)).collect()
    }

    /// The traces whose neurons could be opened, as [`Self::dimensions`].
    pub(crate) fn traces(&self, opened: &[Option<usize>]) -> Vec<Trace> {
        let index = |neuron: usize| opened.get(neuron).copied().flatten();
        let traces = self.trace.iter();
        traces.filter_map(|t| t.renumbered(index)).collect()
    }

    /// The neurons whose tracings are open: `ids`, by file. Also: by neuron of the session, its index among these.
    pub(crate) fn neurons_of(
        &self,
        ids: &[Option<SourceId>],
        state: &State,
    ) -> (Neurons, Vec<Option<usize>>) {
        let mut neurons = Neurons::default();
        let opened = self.neuron.iter().map(|entry| {
            let id = ids.get(entry.file).copied().flatten()?;
            neurons.push_as(self.neuron_of(entry, id, state), entry.state());
            Some(neurons.len() - 1)
        });
        let opened = opened.collect();
        (neurons, opened)
    }

    /// The neuron of an entry, whose tracing is open as `source`.
    fn neuron_of(&self, entry: &NeuronEntry, source: SourceId, state: &State) -> Neuron {
        let node = self.node_of(entry, &state.circuits);
        let traced = node.and_then(|of| {
            let circuit = state.circuits.get(of.circuit)?;
            let instances = circuit.instances(&[of.node], None);
            let morphology = &state.sources.get(source)?.morphology;
            Some(circuits::placement(instances.first()?, morphology))
        });
        Neuron {
            node,
            traced: traced.unwrap_or_default(),
            ..entry.neuron(source)
        }
    }

    /// The node of a neuron, if its circuit is open.
    fn node_of(&self, entry: &NeuronEntry, open: &Circuits) -> Option<CircuitNode> {
        let said = entry.node.as_ref()?;
        let file = self.circuit.get(said.circuit)?.path.as_path();
        let mut ids = open.iter().map(|(id, _)| id);
        let circuit = ids.find(|&id| open.file(id) == Some(file))?;
        let node = open.get(circuit)?.node(&said.population, said.id)?;
        Some(CircuitNode { circuit, node })
    }
}
