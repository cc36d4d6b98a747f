//! Synapses and points beside the cells: what is to be read, and what is known of each.

use neurotess::render::BoundingSphere;

use super::State;
use crate::model::ids::CircuitId;
use crate::model::markers::{MarkerContent, MarkerFacts, MarkerRef, MarkerSource, SynapseKey};
use crate::model::numbers::grouped;

impl State {
    /// What is to be read of synapses and points, and was not yet.
    pub(crate) fn markers_due(&mut self) -> Option<MarkerSource> {
        let options = &self.document.markers;
        if !options.synapses {
            self.marker_data.forget_failed_synapses();
        }
        if self.document.neurons.is_empty() {
            return None;
        }
        let synapses = options.synapses.then(|| {
            MarkerSource::Synapses(SynapseKey {
                circuits: self.circuits_shown(),
                edges: options.edges.clone(),
                side: options.side,
                property: options.property.clone(),
            })
        });
        let points = options.points.clone().map(MarkerSource::Points);
        let all = synapses.into_iter().chain(points);
        let mut due = all.filter(|source| !self.marker_data.was_read(source));
        due.next()
    }

    /// Circuits of the cells in the list.
    pub(crate) fn circuits_shown(&self) -> Vec<CircuitId> {
        let neurons = &self.document.neurons;
        let members = neurons.revisions().members;
        let derive = || {
            let ids = neurons.iter().filter_map(|n| Some(n.node?.circuit));
            let mut ids: Vec<CircuitId> = ids.collect();
            ids.sort_unstable();
            ids.dedup();
            ids
        };
        self.derived.circuits.get(members, derive).to_vec()
    }

    /// Names of the populations of edges of the circuits in the list.
    pub(crate) fn edge_names(&self) -> Vec<String> {
        let shown = self.circuits_shown();
        let circuits = shown.iter().filter_map(|&id| self.circuits.get(id));
        let mut names: Vec<String> = Vec::new();
        for edges in circuits.flat_map(|circuit| &circuit.edges) {
            if !names.contains(&edges.name) {
                names.push(edges.name.clone());
            }
        }
        names
    }

    /// Whether points are where they are relative to the cells: side by side, cells are elsewhere.
    pub(crate) fn shows_points(&self) -> bool {
        self.document.markers.points.is_some() && !self.document.grid
    }

    /// A sphere (µm) around the points that show, which may lie away from all cells.
    pub(crate) fn sphere_of_points(&self) -> Option<BoundingSphere> {
        let any = !self.document.neurons.is_empty() && self.shows_points();
        self.marker_data.sphere().filter(|_| any)
    }

    /// What is known of a synapse or point.
    pub fn marker_facts(&self, marker: MarkerRef) -> Option<MarkerFacts> {
        self.marker_data
            .facts(marker, &self.circuits, |circuit, population, id| {
                let node = self.circuits.get(circuit)?.node(population, id)?;
                let mut neurons = self.document.neurons.iter();
                neurons.position(|n| {
                    n.node
                        .is_some_and(|n| n.circuit == circuit && n.node == node)
                })
            })
    }

    /// Forgets a synapse or point that does not show any more.
    pub(super) fn forget_lost_markers(&mut self) {
        let (markers, points) = (&self.document.markers, self.shows_points());
        let shows = |marker: &MarkerRef| match marker {
            MarkerRef::Synapse(_) => markers.synapses,
            MarkerRef::Point(_) => points,
        };
        self.pointing.hovered_marker = self.pointing.hovered_marker.filter(shows);
        self.pointing.picked_marker = self.pointing.picked_marker.filter(shows);
    }

    /// Takes what was read of synapses and points.
    pub(crate) fn set_markers(
        &mut self,
        source: MarkerSource,
        content: Result<MarkerContent, String>,
    ) {
        let what = match &source {
            MarkerSource::Synapses(_) => "synapses".to_owned(),
            MarkerSource::Points(file) => file.display().to_string(),
        };
        match &content {
            Ok(MarkerContent::Synapses(read)) => {
                let all = read.iter().map(|of| of.edges.len() as u64).sum();
                self.messages.status = format!("{} synapses read", grouped(all));
            }
            Ok(MarkerContent::Points(table)) => {
                let all = table.positions.len() as u64;
                self.messages.status = format!("{} points of {what}", grouped(all));
            }
            Err(why) => self.problem(what, why),
        }
        self.marker_data.set(source, content);
        // Numbers of rows are those of what was read before.
        (self.pointing.hovered_marker, self.pointing.picked_marker) = (None, None);
    }
}
