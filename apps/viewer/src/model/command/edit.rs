//! Edits: what changes the document and can be undone.

use std::path::PathBuf;

use crate::model::document::{Detail, Document, Look, SomaEdit, SourceId};

/// A change of the document.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Selects these, and nothing else unless `add`; what is already selected is dropped then.
    Select(Vec<usize>, bool),
    /// Selects all that is shown.
    SelectAll,
    /// Selects nothing.
    SelectNone,
    /// Selects what is not selected.
    SelectOthers,
    /// Hides what is selected.
    Hide,
    /// Shows only what is selected.
    Isolate,
    /// Shows all.
    ShowAll,
    /// Hides or shows one.
    SetHidden(usize, bool),
    /// Takes what is selected out of the list.
    Remove,
    /// Makes somata in another way.
    SetSoma(Vec<SourceId>, SomaEdit),
    /// Puts the first ring of a neurite somewhere, or leaves it to itself.
    SetRing(SourceId, u32, Option<f64>),
    /// Leaves all first rings to themselves.
    ResetRings(SourceId),
    /// Colors and light.
    SetLook(Box<Look>),
    /// How finely.
    SetDetail(Detail),
    /// Side by side, or where traced.
    SetGrid(bool),
    /// Shows the values of a report or spikes, or no longer.
    SetReport(Option<PathBuf>),
}

impl Edit {
    /// What an undo of it is called.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Select(..) | Self::SelectAll | Self::SelectNone | Self::SelectOthers => "Select",
            Self::Hide | Self::SetHidden(_, true) => "Hide",
            Self::Isolate => "Isolate",
            Self::ShowAll | Self::SetHidden(_, false) => "Show",
            Self::Remove => "Remove",
            Self::SetSoma(..) => "Soma",
            Self::SetRing(..) | Self::ResetRings(_) => "First ring",
            Self::SetLook(_) => "Look",
            Self::SetDetail(_) => "Detail",
            Self::SetGrid(_) => "Grid",
            Self::SetReport(_) => "Report",
        }
    }

    /// Whether several in a row are one edit: a slider that is dragged.
    pub fn joins(&self) -> bool {
        matches!(
            self,
            Self::SetSoma(..) | Self::SetRing(..) | Self::SetLook(_) | Self::SetDetail(_)
        )
    }

    /// Changes the document.
    pub fn apply(self, document: &mut Document) {
        let neurons = &mut document.neurons;
        match self {
            Self::Select(which, add) => {
                let is = |i: usize| which.contains(&i);
                // Adding what is there already takes it away.
                let all = which
                    .iter()
                    .all(|&i| neurons.get(i).is_some_and(|n| n.selected));
                neurons.set_states(|i, n| {
                    let selected = match add {
                        true if is(i) => !all,
                        true => n.selected,
                        false => is(i),
                    };
                    (n.hidden, selected)
                });
            }
            Self::SelectAll => neurons.set_states(|_, n| (n.hidden, !n.hidden)),
            Self::SelectNone => neurons.set_states(|_, n| (n.hidden, false)),
            Self::SelectOthers => {
                neurons.set_states(|_, n| (n.hidden, !n.selected && !n.hidden));
            }
            Self::Hide => neurons.set_states(|_, n| (n.hidden || n.selected, false)),
            // Of nothing, nothing would be left.
            Self::Isolate if neurons.selected().is_empty() => {}
            Self::Isolate => neurons.set_states(|_, n| (!n.selected, n.selected)),
            Self::ShowAll => neurons.set_states(|_, n| (false, n.selected)),
            Self::SetHidden(which, hidden) => neurons.set_states(|i, n| match i == which {
                true => (hidden, n.selected && !hidden),
                false => (n.hidden, n.selected),
            }),
            Self::Remove => neurons.retain(|n| !n.selected),
            Self::SetSoma(sources, edit) => {
                for source in sources {
                    // Rings are each cell's own.
                    let rings = document.soma(source).rings;
                    let edit = edit.clone();
                    document.set_soma(source, SomaEdit { rings, ..edit });
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
            Self::SetLook(look) => document.look = *look,
            Self::SetDetail(detail) => document.detail = detail,
            Self::SetGrid(grid) => document.grid = grid,
            Self::SetReport(report) => document.set_report(report),
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
        assert!(doc.neurons[1].hidden && selected(&doc).is_empty());
        Edit::SelectAll.apply(&mut doc);
        assert_eq!(selected(&doc), [0, 3]);
        Edit::Isolate.apply(&mut doc);
        Edit::ShowAll.apply(&mut doc);
        assert!(doc.neurons.iter().all(|n| !n.hidden));
        Edit::Remove.apply(&mut doc);
        assert_eq!(doc.neurons.len(), 2);
    }
}
