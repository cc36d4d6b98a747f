//! What the state asks of the program around it: dialogs, and effects of commands.

use std::path::PathBuf;
use std::time::SystemTime;

use crate::model::command::{Command, FilePurpose};
use crate::model::save::SaveRequest;
use crate::model::view::View;

/// A dialog over the window.
#[derive(Clone, Debug, Default)]
pub enum Dialog {
    /// None.
    #[default]
    Nothing,
    /// The list of keys and mouse actions.
    Keys,
    /// The palette of commands, with the search text and the index of the highlighted command.
    Palette(String, usize),
    /// The list of problems.
    Problems,
    /// The file dialog.
    Files(FilePurpose),
    /// Asks whether an existing file may be replaced; the command to run if so.
    Replace(PathBuf, Box<Command>),
    /// Asks whether a command may end what is not saved; the command.
    Unsaved(Box<Command>),
    /// Offers what an earlier window had not saved, with the time when that was kept.
    Recover(SystemTime),
}

/// What a command makes the program do outside the state.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Read files.
    Load(Vec<PathBuf>),
    /// Read changed files again.
    Reload,
    /// Write files.
    Save(SaveRequest),
    /// Take the colors of a palette's file.
    OpenPalette(PathBuf),
    /// Write the palette.
    SavePalette(PathBuf),
    /// Cancel running tasks.
    Cancel,
    /// Move the camera to a view.
    Go(View),
    /// Show the picture without perspective, or with it, also at the end of a flight.
    Project(bool),
    /// Fill the screen, or leave it.
    FullScreen(bool),
    /// Put a text on the clipboard.
    Copy(String),
    /// Open what an earlier window had not saved, or remove it.
    Recover(bool),
    /// Quit.
    Quit,
}
