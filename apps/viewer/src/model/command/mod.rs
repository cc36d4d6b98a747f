//! Commands: all that can be done in the window, as values. Menus, shortcuts, the palette and tests
//! share one list.

mod edit;
mod list;

use std::fmt;
use std::path::PathBuf;

use neurotess::render::Side;
use neurotess::synth::Kind;

use crate::model::document::Anchor;
use crate::model::playback::Pace;
use crate::model::plots::MeasureForm;
use crate::model::save::{FilmOptions, MeshOptions, PictureFile};
use crate::model::view::View;

pub use edit::Edit;
pub use list::{Listed, Toggles, listed};

/// One of the panels on the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// Morphometrics of the selection.
    #[default]
    Inspect,
    /// How somata are generated.
    Soma,
    /// Colors and light.
    Look,
    /// The level of detail.
    Detail,
    /// Saving meshes, pictures and films.
    Save,
}

impl Tab {
    /// All panels, with their names.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Inspect, "Inspect"),
        (Self::Soma, "Soma"),
        (Self::Look, "Look"),
        (Self::Detail, "Detail"),
        (Self::Save, "Save"),
    ];
}

/// What the file dialog is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePurpose {
    /// Opening tracings, circuits, folders or sessions.
    Open,
    /// Opening a report or spikes.
    Report,
    /// Saving a session.
    SaveSession,
    /// Opening a table of points.
    Points,
    /// Opening meshes that are no cells.
    Meshes,
    /// Opening a palette.
    OpenPalette,
    /// Saving a palette.
    SavePalette,
    /// Saving a page for a browser.
    SavePage,
    /// Saving a plot in a format: `svg` or `csv`.
    SavePlot(PlotOf, &'static str),
}

/// A plot of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotOf {
    /// Values over time of the compartments that were clicked.
    Traces,
    /// A measure of the selected cells.
    Measure,
}

/// A command: an edit of the document, or a request to the window.
#[derive(Clone, PartialEq)]
pub enum Command {
    /// Changes the document.
    Edit(Edit),

    /// Shows the file dialog.
    AskFiles(FilePurpose),
    /// Reads files, folders, circuits, a session.
    Open(Vec<PathBuf>),
    /// Grows a built-in sample.
    OpenSample(Kind),
    /// Reads changed files again.
    Reload,
    /// Writes a session.
    SaveSession(PathBuf),
    /// Reads a table of points and shows them.
    OpenPoints(PathBuf),
    /// Reads meshes and shows them beside the cells.
    OpenMeshes(Vec<PathBuf>),
    /// Takes the colors of a palette's file.
    OpenPalette(PathBuf),
    /// Writes the palette, with the colors that were chosen.
    SavePalette(PathBuf),
    /// Writes a page of all neurons that show, for a browser.
    SavePage(PathBuf),
    /// Writes a plot, as a figure or as a table by its extension.
    SavePlot(PlotOf, PathBuf),
    /// Cancels reading or saving.
    Cancel,
    /// Quits the program; asks before that if work would be lost.
    Quit,
    /// Runs a command that asks about what is not saved, without the question.
    Unasked(Box<Command>),
    /// Opens what an earlier window had not saved, or removes it.
    Recover(bool),

    /// Undoes the last edit.
    Undo,
    /// Redoes the edit that was undone last.
    Redo,

    /// Plays or pauses the recording.
    TogglePlay,
    /// Goes to a time (ms) of the recording.
    Seek(f64),
    /// Goes a number of frames of the recording forwards or backwards.
    StepTime(i64),
    /// Sets how the recording is played.
    SetPace(Pace),

    /// Shows or hides the plot of values over time.
    ShowTraces(bool),
    /// Sets what *Inspect* plots of the selected cells.
    PlotMeasure(MeasureForm),
    /// Lists where the selected cells' surfaces cross themselves, or no longer.
    ListCrossings(bool),
    /// Goes to a place of that list.
    GoCrossing(usize),

    /// Looks at everything from a side.
    Look(Side),
    /// Looks at everything from the front.
    Home,
    /// Looks at the selection.
    Focus,
    /// Goes to a view.
    Go(View),
    /// Shows the picture without perspective, or with it.
    SetOrthographic(bool),
    /// Saves the current view under a name.
    SaveView,
    /// Goes to a saved view.
    GoSaved(usize),
    /// Sets whether y points down.
    SetYDown(bool),
    /// Sets whether Ctrl and a drag draw a lasso instead of a rectangle.
    SetLasso(bool),
    /// Shows or hides the handles that move and turn the selected cells.
    SetPlacing(bool),
    /// Ends the drag of such a handle: the next one is another edit.
    EndPlacing,
    /// Copies the selected cells, beside them.
    Duplicate,
    /// Puts the selected cells back where they were traced, or where their circuit places them.
    PutBack,
    /// Begins or ends a presentation: the whole screen, no panels, and a turntable.
    SetPresenting(bool),
    /// Shows two views side by side, or one.
    SetSplit(bool),
    /// Sets whether the two views move together.
    SetLinked(bool),
    /// Turns the scene slowly, or lets it rest.
    SetTurning(bool),
    /// Fills the screen, or leaves it.
    SetFullScreen(bool),
    /// Keeps the levels of the current view while the camera moves.
    SetFrozen(bool),

    /// Begins or ends measuring.
    SetMeasuring(bool),
    /// Sets the first end of a distance.
    MeasureFrom(Anchor),
    /// Forgets the first end of a distance; if there is none, ends measuring.
    LeaveMeasuring,
    /// Copies the numbers of a dimension, or a table of all.
    CopyDimensions(Option<usize>),

    /// Shows a panel.
    Show(Tab),
    /// Shows or hides the list of keys.
    ToggleKeys,
    /// Shows or hides the palette, in which all commands can be searched.
    TogglePalette,
    /// Shows or hides the list of problems.
    ToggleProblems,
    /// Sets whether circuits that are opened have a cache.
    SetCaches(bool),
    /// Sets the dark or light theme.
    SetDark(bool),
    /// Shows or hides both side panels.
    TogglePanels,

    /// Writes meshes.
    SaveMeshes(MeshOptions),
    /// Writes a picture.
    SavePicture(PictureFile),
    /// Adds the current view to the film.
    AddKeyView,
    /// Removes a view from the film.
    DropKeyView(usize),
    /// Writes a film.
    SaveFilm(FilmOptions),
}

/// The form that `neurotess view --verbose` prints: edits by their own names.
impl fmt::Debug for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut with =
            |name: &str, value: &dyn fmt::Debug| f.debug_tuple(name).field(value).finish();
        match self {
            Self::Edit(edit) => edit.fmt(f),
            Self::AskFiles(value) => with("AskFiles", value),
            Self::Open(value) => with("Open", value),
            Self::Unasked(value) => with("Unasked", value),
            Self::Recover(value) => with("Recover", value),
            Self::OpenSample(value) => with("OpenSample", value),
            Self::SaveSession(value) => with("SaveSession", value),
            Self::OpenPoints(value) => with("OpenPoints", value),
            Self::OpenMeshes(value) => with("OpenMeshes", value),
            Self::OpenPalette(value) => with("OpenPalette", value),
            Self::SavePalette(value) => with("SavePalette", value),
            Self::SavePage(value) => with("SavePage", value),
            Self::SavePlot(of, value) => {
                let mut tuple = f.debug_tuple("SavePlot");
                tuple.field(of).field(value).finish()
            }
            Self::ShowTraces(value) => with("ShowTraces", value),
            Self::PlotMeasure(value) => with("PlotMeasure", value),
            Self::ListCrossings(value) => with("ListCrossings", value),
            Self::GoCrossing(value) => with("GoCrossing", value),
            Self::Seek(value) => with("Seek", value),
            Self::StepTime(value) => with("StepTime", value),
            Self::SetPace(value) => with("SetPace", value),
            Self::Look(value) => with("Look", value),
            Self::Go(value) => with("Go", value),
            Self::SetOrthographic(value) => with("SetOrthographic", value),
            Self::GoSaved(value) => with("GoSaved", value),
            Self::SetYDown(value) => with("SetYDown", value),
            Self::SetLasso(value) => with("SetLasso", value),
            Self::SetPlacing(value) => with("SetPlacing", value),
            Self::SetPresenting(value) => with("SetPresenting", value),
            Self::SetSplit(value) => with("SetSplit", value),
            Self::SetLinked(value) => with("SetLinked", value),
            Self::SetTurning(value) => with("SetTurning", value),
            Self::SetFullScreen(value) => with("SetFullScreen", value),
            Self::SetFrozen(value) => with("SetFrozen", value),
            Self::SetMeasuring(value) => with("SetMeasuring", value),
            Self::MeasureFrom(value) => with("MeasureFrom", value),
            Self::CopyDimensions(value) => with("CopyDimensions", value),
            Self::Show(value) => with("Show", value),
            Self::SetCaches(value) => with("SetCaches", value),
            Self::SetDark(value) => with("SetDark", value),
            Self::SaveMeshes(value) => with("SaveMeshes", value),
            Self::SavePicture(value) => with("SavePicture", value),
            Self::DropKeyView(value) => with("DropKeyView", value),
            Self::SaveFilm(value) => with("SaveFilm", value),
            Self::Duplicate => f.write_str("Duplicate"),
            Self::EndPlacing => f.write_str("EndPlacing"),
            Self::PutBack => f.write_str("PutBack"),
            Self::Reload => f.write_str("Reload"),
            Self::Cancel => f.write_str("Cancel"),
            Self::Quit => f.write_str("Quit"),
            Self::Undo => f.write_str("Undo"),
            Self::Redo => f.write_str("Redo"),
            Self::TogglePlay => f.write_str("TogglePlay"),
            Self::LeaveMeasuring => f.write_str("LeaveMeasuring"),
            Self::SaveView => f.write_str("SaveView"),
            Self::Home => f.write_str("Home"),
            Self::Focus => f.write_str("Focus"),
            Self::ToggleKeys => f.write_str("ToggleKeys"),
            Self::TogglePalette => f.write_str("TogglePalette"),
            Self::ToggleProblems => f.write_str("ToggleProblems"),
            Self::TogglePanels => f.write_str("TogglePanels"),
            Self::AddKeyView => f.write_str("AddKeyView"),
        }
    }
}

impl From<Edit> for Command {
    fn from(edit: Edit) -> Self {
        Self::Edit(edit)
    }
}

impl Command {
    /// Whether it may open a dialog, which then gets all keys.
    pub(crate) fn moves_keyboard(&self) -> bool {
        matches!(self, Self::AskFiles(_) | Self::TogglePalette | Self::Quit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_printed_by_their_own_names() {
        let hide = Command::from(Edit::SetHidden(3, true));
        assert_eq!(format!("{hide:?}"), "SetHidden(3, true)");
        assert_eq!(format!("{:?}", Command::Look(Side::Top)), "Look(Top)");
        assert_eq!(format!("{:?}", Command::Quit), "Quit");
    }
}
