//! Edits: what changes the document and can be undone.

use std::path::PathBuf;

use glam::DVec3;
use neurotess::options::Picture;
use neurotess::render::{MarkerShape, Placement};

use crate::model::document::{
    Detail, Dimension, Document, Look, MarkerOptions, MeshEntry, SavedView, SomaEdit, SourceId,
    SpineEdit, TracePlace,
};
use crate::model::index_set::IndexSet;

/// A change of the document.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Selects these only; or with `add` changes their selection: those that are selected are
    /// unselected.
    Select(Vec<usize>, bool),
    /// Selects all neurons that are shown.
    SelectAll,
    /// Selects nothing.
    SelectNone,
    /// Inverts the selection.
    SelectOthers,
    /// Hides the selected neurons.
    Hide,
    /// Shows the selected neurons only.
    Isolate,
    /// Shows all neurons.
    ShowAll,
    /// Hides or shows a neuron.
    SetHidden(usize, bool),
    /// Clamps the selected neurons, which are then fine whatever the mode; or no longer.
    Clamp(bool),
    /// Clamps no neuron any more.
    UnclampAll,
    /// Removes the selected neurons from the list.
    Remove,
    /// Moves and turns neurons: their indices, and where they are then.
    Place(Vec<(usize, Placement)>),
    /// Copies the selected neurons, moved by this way (µm); the copies are selected.
    Duplicate(DVec3),
    /// Changes how somata are generated.
    SetSoma(Vec<SourceId>, SomaEdit),
    /// Places the first ring of a neurite, or leaves its position to the generator.
    SetRing(SourceId, u32, Option<f64>),
    /// Leaves the positions of all first rings to the generator.
    ResetRings(SourceId),
    /// Grows spines on cells, or removes them.
    SetSpines(Vec<SourceId>, Option<SpineEdit>),
    /// The same for the selected neurons, or for all if none is selected.
    GrowSpines(Option<SpineEdit>),
    /// Changes colors and light.
    SetLook(Box<Look>),
    /// Shows what a picture shows, as far as options tell it: colors, look, markers, meshes.
    TakePicture(Box<Picture>),
    /// Shows everything as it is: undoes what *Look* and *Detail* hide and enlarge. Taste stays.
    ResetLook,
    /// Sets whether y points down.
    SetYDown(bool),
    /// Changes the level of detail.
    SetDetail(Detail),
    /// Places neurons side by side, or where they were traced.
    SetGrid(bool),
    /// Shows the values of a report or of spikes, or none.
    SetReport(Option<PathBuf>),
    /// Changes which synapses and points are shown, and how.
    SetMarkers(Box<MarkerOptions>),
    /// Shows synapses, or none.
    ShowSynapses(bool),
    /// Draws synapses as spheres on discs, or as spheres alone.
    ShowContacts(bool),
    /// Shows the points of a table, or none.
    SetPoints(Option<PathBuf>),
    /// Shows meshes beside the cells.
    AddMeshes(Vec<MeshEntry>),
    /// Changes how a mesh looks, by its index.
    SetMesh(usize, MeshEntry),
    /// Removes a mesh, by its index.
    RemoveMesh(usize),
    /// Removes all meshes.
    ClearMeshes,
    /// Keeps a dimension on the picture.
    AddDimension(Dimension),
    /// Removes a dimension, by its index.
    RemoveDimension(usize),
    /// Removes all dimensions.
    ClearDimensions,
    /// Saves a view under its name.
    SaveView(SavedView),
    /// Renames a saved view.
    RenameView(usize, String),
    /// Forgets a saved view.
    RemoveView(usize),
    /// Plots the values of a place over time: alone, or with `true` beside the others, from which it is taken away if it is
    /// there.
    Plot(TracePlace, bool),
    /// Removes a trace from the plot, by its index.
    RemoveTrace(usize),
    /// Sets the color of a trace, by its index.
    SetTraceColor(usize, [u8; 3]),
    /// Removes all traces.
    ClearTraces,
}

impl Edit {
    /// Its name in the menu's undo and redo.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Select(..) | Self::SelectAll | Self::SelectNone | Self::SelectOthers => "Select",
            Self::Hide | Self::SetHidden(_, true) => "Hide",
            Self::Isolate => "Isolate",
            Self::ShowAll | Self::SetHidden(_, false) => "Show",
            Self::Clamp(true) => "Clamp",
            Self::Clamp(false) | Self::UnclampAll => "Unclamp",
            Self::Remove => "Remove",
            Self::Place(_) => "Move or turn",
            Self::Duplicate(_) => "Duplicate",
            Self::SetSoma(..) => "Soma",
            Self::SetRing(..) | Self::ResetRings(_) => "First ring",
            Self::SetSpines(_, Some(_)) | Self::GrowSpines(Some(_)) => "Spines",
            Self::SetSpines(_, None) | Self::GrowSpines(None) => "Remove spines",
            Self::SetLook(_) | Self::TakePicture(_) => "Look",
            Self::ResetLook => "Reset look",
            Self::SetYDown(_) => "Direction of y",
            Self::SetDetail(_) => "Detail",
            Self::SetGrid(_) => "Grid",
            Self::SetReport(_) => "Report",
            Self::SetMarkers(_)
            | Self::ShowSynapses(_)
            | Self::ShowContacts(_)
            | Self::SetPoints(_) => "Synapses and points",
            Self::AddMeshes(_) => "Mesh",
            Self::SetMesh(..) => "Look of a mesh",
            Self::RemoveMesh(_) | Self::ClearMeshes => "Remove mesh",
            Self::AddDimension(_) => "Dimension",
            Self::RemoveDimension(_) | Self::ClearDimensions => "Remove dimension",
            Self::SaveView(_) => "Save view",
            Self::RenameView(..) => "Rename view",
            Self::RemoveView(_) => "Forget view",
            Self::Plot(..) => "Trace",
            Self::RemoveTrace(_) | Self::ClearTraces => "Remove trace",
            Self::SetTraceColor(..) => "Trace color",
        }
    }

    /// Whether several in a row count as one edit, as when a slider is dragged.
    pub fn joins(&self) -> bool {
        matches!(
            self,
            Self::Place(_)
                | Self::SetSoma(..)
                | Self::SetRing(..)
                | Self::SetSpines(..)
                | Self::SetLook(_)
                | Self::SetDetail(_)
                | Self::SetMarkers(_)
                | Self::SetMesh(..)
                | Self::RenameView(..)
                | Self::SetTraceColor(..)
        )
    }

    /// Whether losing it would be a loss: not what selects, and not what only opens a file, as opening a tracing
    /// does.
    pub(crate) fn is_work(&self) -> bool {
        !matches!(
            self,
            Self::Select(..)
                | Self::SelectAll
                | Self::SelectNone
                | Self::SelectOthers
                | Self::SetReport(_)
                | Self::SetPoints(_)
                | Self::AddMeshes(_)
                | Self::TakePicture(_)
        )
    }

    /// Changes the document.
    pub fn apply(self, document: &mut Document) {
        let neurons = &mut document.neurons;
        let (hidden, selected) = (neurons.hidden().clone(), neurons.selected().clone());
        let all = IndexSet::below(neurons.len());
        match self {
            Self::Select(which, add) => {
                // If all of them are selected already, they are unselected.
                let all = which.iter().all(|&i| selected.contains(i));
                let there = which.into_iter().filter(|&i| i < neurons.len());
                let which = there.collect();
                neurons.select(match (add, all) {
                    (true, true) => selected.without(&which),
                    (true, false) => selected.with(&which),
                    (false, _) => which,
                });
            }
            Self::SelectAll => neurons.select(all.without(&hidden)),
            Self::SelectNone => neurons.select(IndexSet::default()),
            Self::SelectOthers => neurons.select(all.without(&selected).without(&hidden)),
            Self::Hide => neurons.set_states(hidden.with(&selected), IndexSet::default()),
            // Without a selection, nothing would be left to show.
            Self::Isolate if selected.is_empty() => {}
            Self::Isolate => neurons.set_states(all.without(&selected), selected),
            Self::ShowAll => neurons.set_states(IndexSet::default(), selected),
            Self::SetHidden(which, hides) if which < neurons.len() => {
                let which = IndexSet::from_iter([which]);
                match hides {
                    true => neurons.set_states(hidden.with(&which), selected.without(&which)),
                    false => neurons.set_states(hidden.without(&which), selected),
                }
            }
            Self::SetHidden(..) => {}
            Self::Clamp(clamped) => neurons.clamp_selected(clamped),
            Self::UnclampAll => neurons.unclamp_all(),
            Self::Remove => document.remove_selected(),
            Self::Place(places) => neurons.place(&places),
            Self::Duplicate(way) => document.duplicate_selected(way),
            Self::SetSoma(sources, edit) => {
                for source in sources {
                    // Each cell keeps its own rings and spines.
                    let SomaEdit { rings, spines, .. } = document.soma(source);
                    let edit = edit.clone();
                    document.set_soma(
                        source,
                        SomaEdit {
                            rings,
                            spines,
                            ..edit
                        },
                    );
                }
            }
            Self::SetRing(source, neurite, position) => {
                let mut edit = document.soma(source);
                match position {
                    Some(position) => edit.rings.insert(neurite, position.clamp(0.0, 2.0)),
                    None => edit.rings.remove(&neurite),
                };
                document.set_soma(source, edit);
            }
            Self::ResetRings(source) => {
                let mut edit = document.soma(source);
                edit.rings.clear();
                document.set_soma(source, edit);
            }
            Self::SetSpines(sources, spines) => document.set_spines(&sources, spines),
            Self::GrowSpines(spines) => {
                let sources = document.neurons.meant_sources();
                document.set_spines(&sources, spines);
            }
            Self::SetLook(look) => document.look = *look,
            Self::TakePicture(picture) => document.take(&picture),
            Self::ResetLook => {
                let look = std::mem::take(&mut document.look);
                document.look = Look {
                    color_by: look.color_by,
                    attribute: look.attribute.clone(),
                    ..look.taste()
                };
                document.detail = document.detail.taste();
            }
            Self::SetYDown(y_down) => document.y_down = y_down,
            Self::SetDetail(detail) => document.detail = detail,
            Self::SetGrid(grid) => document.grid = grid,
            Self::SetReport(report) => document.set_report(report),
            Self::SetMarkers(markers) => document.markers = *markers,
            Self::ShowSynapses(show) => document.markers.synapses = show,
            Self::ShowContacts(show) => {
                document.markers.synapses = true;
                document.markers.shape = match show {
                    true => MarkerShape::Contact,
                    false => MarkerShape::Sphere,
                };
            }
            Self::SetPoints(points) => {
                // Another table has other columns.
                if points != document.markers.points {
                    document.markers.column = None;
                }
                document.markers.points = points;
            }
            Self::AddMeshes(entries) => document.meshes.extend(entries),
            Self::SetMesh(which, entry) => {
                if document.meshes.get(which).is_some_and(|now| *now != entry) {
                    document.meshes[which] = entry;
                }
            }
            Self::RemoveMesh(which) if which < document.meshes.len() => {
                document.meshes.remove(which);
            }
            Self::RemoveMesh(_) => {}
            Self::ClearMeshes => document.meshes.clear(),
            Self::AddDimension(dimension) => document.dimensions.push(dimension),
            Self::RemoveDimension(which) if which < document.dimensions.len() => {
                document.dimensions.remove(which);
            }
            Self::RemoveDimension(_) => {}
            Self::ClearDimensions => document.dimensions.clear(),
            Self::SaveView(view) => document.saved_views.push(view),
            Self::RenameView(which, name) => {
                if let Some(view) = document.saved_views.get_mut(which) {
                    view.name = name;
                }
            }
            Self::RemoveView(which) if which < document.saved_views.len() => {
                document.saved_views.remove(which);
            }
            Self::RemoveView(_) => {}
            Self::Plot(place, add) => document.plot(place, add),
            Self::RemoveTrace(which) if which < document.traces.len() => {
                document.traces.remove(which);
            }
            Self::RemoveTrace(_) => {}
            Self::SetTraceColor(which, color) => {
                if let Some(trace) = document.traces.get_mut(which) {
                    trace.color = color;
                }
            }
            Self::ClearTraces => document.traces.clear(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::document::Neuron;

    fn document() -> Document {
        let neuron = |i| Neuron::new(SourceId(i), format!("n{i}"));
        Document {
            neurons: (0..4).map(neuron).collect(),
            ..Document::default()
        }
    }

    fn selected(document: &Document) -> Vec<usize> {
        document.selected().collect()
    }

    #[test]
    fn shift_adds_and_takes_away() {
        let mut doc = document();
        Edit::Select(vec![1], false).apply(&mut doc);
        Edit::Select(vec![2, 3], true).apply(&mut doc);
        assert_eq!(selected(&doc), [1, 2, 3]);
        Edit::Select(vec![2], true).apply(&mut doc);
        assert_eq!(selected(&doc), [1, 3]);
        Edit::Select(vec![0], false).apply(&mut doc);
        assert_eq!(selected(&doc), [0]);
    }

    #[test]
    fn what_is_hidden_is_not_selected() {
        let mut doc = document();
        Edit::Select(vec![1, 2], false).apply(&mut doc);
        Edit::Hide.apply(&mut doc);
        assert!(!doc.neurons.shows(1) && selected(&doc).is_empty());
        Edit::SelectAll.apply(&mut doc);
        assert_eq!(selected(&doc), [0, 3]);
        Edit::Isolate.apply(&mut doc);
        Edit::ShowAll.apply(&mut doc);
        assert!(doc.neurons.hidden().is_empty());
        Edit::Remove.apply(&mut doc);
        assert_eq!(doc.neurons.len(), 2);
    }
}
