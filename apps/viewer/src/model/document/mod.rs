//! The document, which is saved and whose edits can be undone: the neurons that are shown, and how.

mod detail;
mod dimension;
mod look;
mod markers;
mod meshes;
mod neurons;
mod placement;
mod saved_view;
mod soma;
mod spines;
mod traces;

use std::path::PathBuf;

use glam::DVec3;
use neurotess::render::Placement;

use crate::model::index_set::IndexSet;
use crate::model::revision::Tracked;

pub use crate::model::ids::{CircuitNode, SourceId};
pub use detail::{Detail, LodKind, RestChoice};
pub use dimension::{Anchor, Dimension};
pub use look::{ColorBy, Cut, Lighting, Look, PAPER, VisibleParts};
pub use markers::MarkerOptions;
pub use meshes::{MeshEntry, is_mesh};
pub use neurons::{NeuronRevisions, NeuronState, Neurons};
pub(crate) use placement::PlacementEntry;
pub use saved_view::SavedView;
pub use soma::{Keep, Method, SomaEdit};
pub use spines::{SpineEdit, SpinePlaces};
pub use traces::{Trace, TracePlace};

/// All that edits change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The neurons, in the order of the list.
    pub neurons: Neurons,
    /// Somata that are not generated in the default way, and cells with spines, by source.
    pub somata: Tracked<Vec<(SourceId, SomaEdit)>>,
    /// Colors, light, and which parts of cells are shown.
    pub look: Look,
    /// The level of detail.
    pub detail: Detail,
    /// Whether neurons are side by side instead of where they were traced.
    pub grid: bool,
    /// Whether y points down.
    pub y_down: bool,
    /// The recording whose values can be shown.
    pub report: Option<PathBuf>,
    /// Synapses and points beside the cells.
    pub markers: MarkerOptions,
    /// Meshes beside the cells that are none.
    pub meshes: Tracked<Vec<MeshEntry>>,
    /// What was measured and is kept on the picture.
    pub dimensions: Tracked<Vec<Dimension>>,
    /// Views that were saved under a name.
    pub saved_views: Vec<SavedView>,
    /// Compartments whose values are plotted over time.
    pub traces: Tracked<Vec<Trace>>,
}

/// A neuron: a tracing with a placement.
#[derive(Clone, Debug, PartialEq)]
pub struct Neuron {
    /// Its tracing.
    pub source: SourceId,
    /// Its node, if it belongs to a circuit.
    pub node: Option<CircuitNode>,
    /// Its name in the list.
    pub name: String,
    /// Where it is.
    pub placement: Placement,
    /// Where it was traced, or where its circuit places it: there it is until it is moved.
    pub traced: Placement,
}

impl Neuron {
    /// A tracing in its own coordinates.
    pub fn new(source: SourceId, name: String) -> Self {
        Self {
            source,
            node: None,
            name,
            placement: Placement::default(),
            traced: Placement::default(),
        }
    }
}

impl Document {
    /// How the soma of a source is generated.
    pub fn soma(&self, source: SourceId) -> SomaEdit {
        let edit = self.somata.iter().find(|(id, _)| *id == source);
        edit.map(|(_, edit)| edit.clone()).unwrap_or_default()
    }

    /// Sets how the soma of a source is generated.
    pub fn set_soma(&mut self, source: SourceId, edit: SomaEdit) {
        if self.soma(source) == edit {
            return;
        }
        self.somata.retain(|(id, _)| *id != source);
        if edit != SomaEdit::default() {
            self.somata.push((source, edit));
            self.somata.sort_by_key(|(id, _)| *id);
        }
    }

    /// Sets which spines grow on cells.
    pub(crate) fn set_spines(&mut self, sources: &[SourceId], spines: Option<SpineEdit>) {
        for &source in sources {
            let edit = self.soma(source);
            self.set_soma(source, SomaEdit { spines, ..edit });
        }
    }

    /// The spines that a source is drawn with: none while a recording shows, which numbers the sections of the tracing
    /// itself.
    pub fn drawn_spines(&self, source: SourceId) -> Option<SpineEdit> {
        self.soma(source).spines.filter(|_| self.report.is_none())
    }

    /// Shows the values of a recording, or none.
    pub fn set_report(&mut self, report: Option<PathBuf>) {
        match (&report, self.look.color_by) {
            (Some(_), _) => self.look.color_by = ColorBy::Value,
            (None, ColorBy::Value) => self.look.color_by = ColorBy::default(),
            (None, _) => {}
        }
        self.report = report;
    }

    /// Adds a copy of each selected neuron, moved by `way` (µm), and selects the copies alone. A copy is no node of
    /// a circuit: its synapses and the values of a report are those of the one node.
    pub(crate) fn duplicate_selected(&mut self, way: DVec3) {
        let copy = |neuron: &Neuron| Neuron {
            node: None,
            name: format!("{} (copy)", neuron.name),
            placement: Placement {
                translation: neuron.placement.translation + way,
                ..neuron.placement
            },
            traced: Placement::default(),
            ..neuron.clone()
        };
        let mut copies = Neurons::default();
        for index in self.selected() {
            copies.push_as(copy(&self.neurons[index]), self.neurons.state(index));
        }
        if copies.is_empty() {
            return;
        }
        self.neurons.select(IndexSet::default());
        self.neurons.append(&copies);
    }

    /// Removes the selected neurons, and the dimensions and traces that refer to them.
    pub(crate) fn remove_selected(&mut self) {
        let removed = self.neurons.selected().clone();
        if removed.is_empty() {
            return;
        }
        let count = self.neurons.len();
        self.neurons.remove(&removed);
        let number = |neuron: usize| removed.renumbered(neuron).filter(|_| neuron < count);
        if !self.dimensions.is_empty() {
            let dimensions = self.dimensions.iter();
            *self.dimensions = dimensions.filter_map(|d| d.renumbered(number)).collect();
        }
        if !self.traces.is_empty() {
            let traces = self.traces.iter();
            *self.traces = traces.filter_map(|t| t.renumbered(number)).collect();
        }
    }

    /// Indices of the selected neurons.
    pub fn selected(&self) -> impl Iterator<Item = usize> {
        self.neurons.selected().iter()
    }
}

/// Placements of neurons side by side. `extents`: center and size (µm) of each at its own
/// placement.
pub fn grid(neurons: &Neurons, extents: &[(DVec3, DVec3)]) -> Vec<Placement> {
    let columns = (neurons.len() as f64).sqrt().ceil().max(1.0) as usize;
    let widest = |axis: usize| {
        extents
            .iter()
            .map(|(_, size)| size[axis])
            .fold(0.0, f64::max)
    };
    let step = DVec3::new(1.1 * widest(0), 1.1 * widest(1), 0.0);
    let place = |(i, (neuron, (center, _))): (usize, (&Neuron, &(DVec3, DVec3)))| {
        let cell = DVec3::new((i % columns) as f64, -((i / columns) as f64), 0.0);
        Placement {
            translation: neuron.placement.translation + cell * step - *center,
            ..neuron.placement
        }
    };
    neurons.iter().zip(extents).enumerate().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neurons_on_a_grid_do_not_overlap() {
        let neurons: Neurons = (0..5)
            .map(|i| Neuron::new(SourceId(i), String::new()))
            .collect();
        let extents: Vec<(DVec3, DVec3)> = (0..5)
            .map(|i| {
                (
                    DVec3::splat(f64::from(i)),
                    DVec3::new(10.0 + f64::from(i), 20.0, 5.0),
                )
            })
            .collect();
        let places = grid(&neurons, &extents);
        for (i, (a, (center_a, size))) in places.iter().zip(&extents).enumerate() {
            for (b, (center_b, other)) in places[..i].iter().zip(&extents) {
                let apart = (a.translation + *center_a - b.translation - *center_b).abs();
                let room = (*size + *other) / 2.0;
                assert!(apart.x > room.x || apart.y > room.y, "{i}");
            }
        }
    }

    #[test]
    fn a_usual_soma_is_not_kept() {
        let mut document = Document::default();
        let edit = SomaEdit {
            poisson: 0.1,
            ..SomaEdit::default()
        };
        document.set_soma(SourceId(3), edit.clone());
        assert_eq!(document.soma(SourceId(3)), edit);
        document.set_soma(SourceId(3), SomaEdit::default());
        assert!(document.somata.is_empty());
    }
}
