//! The menu *File*.

use eframe::egui::Key;

use super::{CTRL, CTRL_SHIFT, Listed, item};
use crate::model::command::{Command, Edit, FilePurpose, PlotOf, Tab};

pub(super) fn menu() -> Vec<Listed> {
    vec![
        item(
            "Open…",
            Some((CTRL, Key::O)),
            Command::AskFiles(FilePurpose::Open),
        ),
        item(
            "Open report or spikes…",
            Some((CTRL_SHIFT, Key::O)),
            Command::AskFiles(FilePurpose::Report),
        ),
        item("Close the report", None, Edit::SetReport(None).into()),
        item(
            "Open points (a table of markers)…",
            None,
            Command::AskFiles(FilePurpose::Points),
        ),
        item(
            "Close the points (markers)",
            None,
            Edit::SetPoints(None).into(),
        ),
        item(
            "Add a mesh (brain region, segment, pipette)…",
            None,
            Command::AskFiles(FilePurpose::Meshes),
        ),
        item("Remove all meshes", None, Edit::ClearMeshes.into()),
        item(
            "Save session…",
            Some((CTRL, Key::S)),
            Command::AskFiles(FilePurpose::SaveSession),
        ),
        item(
            "Open palette…",
            None,
            Command::AskFiles(FilePurpose::OpenPalette),
        ),
        item(
            "Save palette…",
            None,
            Command::AskFiles(FilePurpose::SavePalette),
        ),
        item(
            "Save the plot of traces (SVG)…",
            None,
            Command::AskFiles(FilePurpose::SavePlot(PlotOf::Traces, "svg")),
        ),
        item(
            "Save the values of traces (CSV)…",
            None,
            Command::AskFiles(FilePurpose::SavePlot(PlotOf::Traces, "csv")),
        ),
        item(
            "Save mesh, picture or film…",
            Some((CTRL, Key::E)),
            Command::Show(Tab::Save),
        ),
        item(
            "Reload changed files",
            Some((CTRL, Key::R)),
            Command::Reload,
        ),
        item("Stop reading or saving", None, Command::Cancel),
        item("Quit", Some((CTRL, Key::Q)), Command::Quit),
    ]
}
