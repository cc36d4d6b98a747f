//! The two cells of the synapse that was clicked.

use std::sync::Arc;

use neurotess::circuit::SynapseSide;

use super::State;
use crate::model::markers::MarkerRef;
use crate::model::partners::{PartnerCell, PartnerPath, Role};

impl State {
    /// Paths from the synapse that was clicked to the somata of its cells, of those that are in the list.
    pub fn partner_paths(&self) -> Arc<Vec<PartnerPath>> {
        let key = (
            self.pointing.picked_marker,
            self.marker_data.revision(),
            self.placements_key(),
            self.sources.geometry(),
        );
        self.derived.partners.get(key, || {
            let picked = self.pointing.picked_marker;
            picked.map_or(Vec::new(), |marker| self.paths_of(marker))
        })
    }

    fn paths_of(&self, marker: MarkerRef) -> Vec<PartnerPath> {
        let synapse = self.marker_data.synapse(marker, &self.circuits);
        let Some((facts, (synapse, side))) = self.marker_facts(marker).zip(synapse) else {
            return Vec::new();
        };
        let roles = match side {
            SynapseSide::Afferent => [Role::Postsynaptic, Role::Presynaptic],
            SynapseSide::Efferent => [Role::Presynaptic, Role::Postsynaptic],
        };
        let placements = self.placements();
        let cells = facts.neurons.into_iter().zip(roles);
        let paths = cells.filter_map(|(neuron, role)| {
            let neuron = neuron?;
            let cell = PartnerCell {
                neuron,
                role,
                morphology: &self.source_of(neuron)?.morphology,
                traced: self.document.neurons.get(neuron)?.placement,
                drawn: *placements.get(neuron)?,
            };
            cell.path(synapse.position)
        });
        paths.collect()
    }
}
