//! The list of places where the selected cells' surfaces cross themselves.

use neurotess::render::{BoundingSphere, Placement};

use super::State;
use crate::model::command::{Command, Tab};
use crate::model::crossings::{Crossing, CrossingKey, Crossings};
use crate::model::ids::SourceId;

/// How many radii of a place are in the picture that is flown to.
const AROUND: f64 = 8.0;

impl State {
    /// What the list is to be of, while it is open: the tracings of the selected cells, each once; of the only one, if
    /// none is selected.
    pub(crate) fn crossing_key(&self) -> Option<CrossingKey> {
        let sources = self.inspected_sources();
        (self.crossings.open && !sources.is_empty()).then(|| CrossingKey {
            sources: sources.to_vec(),
            geometry: self.sources.geometry(),
        })
    }

    /// The newest list, once it is there, and whether it is of the current selection.
    pub fn crossing_list(&self) -> Option<(Result<&Crossings, &str>, bool)> {
        let key = self.crossing_key()?;
        let (of, list) = self.crossings.found.as_ref()?;
        Some((list.as_ref().map_err(String::as_str), *of == key))
    }

    /// Opens or closes the list.
    pub(super) fn list_crossings(&mut self, open: bool) {
        self.crossings.open = open;
        self.crossings.pointed = None;
        if open {
            (self.layout.tab, self.layout.panels) = (Tab::Inspect, true);
            if self.crossing_key().is_none() {
                self.messages.status = "Select the neurons whose crossings are to be listed".into();
            }
        }
    }

    /// Goes to a place of the list.
    pub(super) fn go_to_crossing(&mut self, index: usize) {
        let Some((Ok(list), true)) = self.crossing_list() else {
            return;
        };
        let Some(sphere) = list.get(index).and_then(|c| self.sphere_of_crossing(c)) else {
            return;
        };
        self.crossings.pointed = Some(index);
        let (center, radius) = sphere;
        self.run(Command::Go(self.view.focused((center, AROUND * radius))));
    }

    /// A place in the scene: on the first neuron of its tracing that shows, a selected one if there is one.
    pub(crate) fn sphere_of_crossing(&self, crossing: &Crossing) -> Option<BoundingSphere> {
        let placement = self.placement_of_source(crossing.source)?;
        let center = placement.world_from_cell(crossing.place.position);
        Some((center, placement.scale * crossing.reach()))
    }

    fn placement_of_source(&self, source: SourceId) -> Option<Placement> {
        let placements = self.placements();
        let neurons = &self.document.neurons;
        let places = neurons.iter().zip(placements.iter()).enumerate();
        let mut shown = places.filter(|(i, (n, _))| n.source == source && neurons.shows(*i));
        let first = shown.next()?;
        let selected = std::iter::once(first)
            .chain(shown)
            .find(|(i, _)| neurons.selected().contains(*i));
        Some(*selected.unwrap_or(first).1.1)
    }
}
