//! What one can do, as values: menus, shortcuts, the palette and tests share one list.

mod edit;
mod list;

use std::fmt;
use std::path::PathBuf;

use neurotess::render::Side;
use neurotess::synth::Kind;

use crate::model::playback::Pace;
use crate::model::save::{FilmOptions, MeshOptions, PictureFile};
use crate::model::view::View;

pub use edit::Edit;
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

/// Something to do: an edit, or a request to the window around the document.
#[derive(Clone, PartialEq)]
pub enum Command {
    /// Changes the document.
    Edit(Edit),

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

/// As `neurotess view --verbose` prints it: an edit by its own name.
impl fmt::Debug for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut with =
            |name: &str, value: &dyn fmt::Debug| f.debug_tuple(name).field(value).finish();
        match self {
            Self::Edit(edit) => edit.fmt(f),
            Self::AskFiles(value) => with("AskFiles", value),
            Self::Open(value) => with("Open", value),
            Self::OpenSample(value) => with("OpenSample", value),
            Self::SaveSession(value) => with("SaveSession", value),
            Self::Seek(value) => with("Seek", value),
            Self::StepTime(value) => with("StepTime", value),
            Self::SetPace(value) => with("SetPace", value),
            Self::Look(value) => with("Look", value),
            Self::Go(value) => with("Go", value),
            Self::SetYDown(value) => with("SetYDown", value),
            Self::SetFrozen(value) => with("SetFrozen", value),
            Self::Show(value) => with("Show", value),
            Self::SetDark(value) => with("SetDark", value),
            Self::SaveMeshes(value) => with("SaveMeshes", value),
            Self::SavePicture(value) => with("SavePicture", value),
            Self::DropKeyView(value) => with("DropKeyView", value),
            Self::SaveFilm(value) => with("SaveFilm", value),
            Self::Reload => f.write_str("Reload"),
            Self::Cancel => f.write_str("Cancel"),
            Self::Quit => f.write_str("Quit"),
            Self::Undo => f.write_str("Undo"),
            Self::Redo => f.write_str("Redo"),
            Self::TogglePlay => f.write_str("TogglePlay"),
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
    /// Whether it opens a line of text that hears all keys from then on.
    pub(crate) fn moves_keyboard(&self) -> bool {
        matches!(self, Self::AskFiles(_) | Self::TogglePalette)
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
