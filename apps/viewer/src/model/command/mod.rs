//! What one can do, as values: menus, shortcuts, the palette and tests share one list.

mod list;

use std::path::PathBuf;

use neurotess::render::Side;
use neurotess::synth::Kind;

use crate::model::document::{Detail, Document, Look, SomaEdit, SourceId};
use crate::model::playback::Pace;
use crate::model::save::{FilmOptions, MeshOptions, PictureFile};
use crate::model::view::View;

pub use list::{Listed, Toggles, listed};

/// One of the panels on the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// What is selected.
    #[default]
    Inspect,
    /// How somata are made.
    Soma,
    /// Colors and light.
    Look,
    /// How finely.
    Detail,
    /// Meshes, pictures, films.
    Save,
}

impl Tab {
    /// All, with their names.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Inspect, "Inspect"),
        (Self::Soma, "Soma"),
        (Self::Look, "Look"),
        (Self::Detail, "Detail"),
        (Self::Save, "Save"),
    ];
}

/// What files are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// Tracings, circuits, folders, sessions.
    Open,
    /// A report or spikes.
    Report,
    /// Where a session goes.
    SaveSession,
}

/// Something to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Shows the file panel.
    AskFiles(Ask),
    /// Reads files, folders, circuits, a session.
    Open(Vec<PathBuf>),
    /// Grows a built-in sample.
    OpenSample(Kind),
    /// Reads files that changed again.
    Reload,
    /// Writes a session.
    SaveSession(PathBuf),
    /// Ends reading or saving.
    Cancel,
    /// Leaves the program.
    Quit,

    /// The one before the last edit.
    Undo,
    /// The one after it.
    Redo,

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

    /// Lets the recording's time go on, or no longer.
    TogglePlay,
    /// Goes to a time (ms) of the recording.
    Seek(f64),
    /// Goes by frames of the recording.
    StepTime(i64),
    /// How the recording's time goes on.
    SetPace(Pace),

    /// Goes to a side.
    Look(Side),
    /// All in the picture, from the front.
    Home,
    /// What is selected in the picture.
    Focus,
    /// Goes to a view.
    Go(View),
    /// Which way y runs.
    SetYDown(bool),
    /// Levels as they are now, whatever the view.
    SetFrozen(bool),

    /// Shows a panel.
    Show(Tab),
    /// The sheet of keys.
    ToggleKeys,
    /// All commands, to search.
    TogglePalette,
    /// What went wrong.
    ToggleProblems,
    /// Dark or light.
    SetDark(bool),
    /// Both side panels.
    TogglePanels,

    /// Writes meshes.
    SaveMeshes(MeshOptions),
    /// Writes a picture.
    SavePicture(PictureFile),
    /// Keeps the view for a film.
    AddKeyView,
    /// Forgets a view of the film.
    DropKeyView(usize),
    /// Writes a film.
    SaveFilm(FilmOptions),
}

impl Command {
    /// What an undo of it is called; none: it is no edit.
    pub fn edit(&self) -> Option<&'static str> {
        Some(match self {
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
            _ => return None,
        })
    }

    /// Whether it opens a line of text that hears all keys from then on.
    pub(crate) fn moves_keyboard(&self) -> bool {
        matches!(self, Self::AskFiles(_) | Self::TogglePalette)
    }

    /// Whether several in a row are one edit: a slider that is dragged.
    pub fn joins(&self) -> bool {
        matches!(
            self,
            Self::SetSoma(..) | Self::SetRing(..) | Self::SetLook(_) | Self::SetDetail(_)
        )
    }

    /// Does an edit.
    pub fn apply(self, document: &mut Document) {
        let neurons = &mut document.neurons;
        match self {
            Self::Select(which, add) => {
                let is = |i: usize| which.contains(&i);
                // Adding what is there already takes it away.
                let all = which
                    .iter()
                    .all(|&i| neurons.get(i).is_some_and(|n| n.selected));
                for (i, neuron) in neurons.iter_mut().enumerate() {
                    neuron.selected = match add {
                        true if is(i) => !all,
                        true => neuron.selected,
                        false => is(i),
                    };
                }
            }
            Self::SelectAll => neurons.iter_mut().for_each(|n| n.selected = !n.hidden),
            Self::SelectNone => neurons.iter_mut().for_each(|n| n.selected = false),
            Self::SelectOthers => neurons
                .iter_mut()
                .for_each(|n| n.selected = !n.selected && !n.hidden),
            Self::Hide => {
                for neuron in neurons.iter_mut().filter(|n| n.selected) {
                    (neuron.hidden, neuron.selected) = (true, false);
                }
            }
            Self::Isolate if neurons.iter().any(|n| n.selected) => {
                neurons.iter_mut().for_each(|n| n.hidden = !n.selected);
            }
            Self::ShowAll => neurons.iter_mut().for_each(|n| n.hidden = false),
            Self::SetHidden(which, hidden) => {
                if let Some(neuron) = neurons.get_mut(which) {
                    neuron.hidden = hidden;
                    neuron.selected &= !hidden;
                }
            }
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
            _ => {}
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
        Command::Select(vec![1], false).apply(&mut doc);
        Command::Select(vec![2, 3], true).apply(&mut doc);
        assert_eq!(selected(&doc), [1, 2, 3]);
        Command::Select(vec![2], true).apply(&mut doc);
        assert_eq!(selected(&doc), [1, 3]);
        Command::Select(vec![0], false).apply(&mut doc);
        assert_eq!(selected(&doc), [0]);
    }

    #[test]
    fn what_is_hidden_is_not_selected() {
        let mut doc = document();
        Command::Select(vec![1, 2], false).apply(&mut doc);
        Command::Hide.apply(&mut doc);
        assert!(doc.neurons[1].hidden && selected(&doc).is_empty());
        Command::SelectAll.apply(&mut doc);
        assert_eq!(selected(&doc), [0, 3]);
        Command::Isolate.apply(&mut doc);
        Command::ShowAll.apply(&mut doc);
        assert!(doc.neurons.iter().all(|n| !n.hidden));
        Command::Remove.apply(&mut doc);
        assert_eq!(doc.neurons.len(), 2);
    }
}
