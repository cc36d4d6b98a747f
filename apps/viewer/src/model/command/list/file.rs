//! The menu *File*.

use eframe::egui::Key;

use super::{CTRL, CTRL_SHIFT, Listed, first, item};
use crate::model::command::{Command, Edit, FilePurpose, PlotOf, Tab};

pub(super) fn menu() -> Vec<Listed> {
    vec![
        item(
            "Open… | circuit sonata snudda folder swc asc h5 session import load",
            Some((CTRL, Key::O)),
            Command::AskFiles(FilePurpose::Open),
        ),
        first(
            "Open report or spikes…",
            Some((CTRL_SHIFT, Key::O)),
            Command::AskFiles(FilePurpose::Report),
        ),
        item("Close the report", None, Edit::SetReport(None).into()),
        first(
            "Open points… | a table of markers",
            None,
            Command::AskFiles(FilePurpose::Points),
        ),
        item(
            "Close the points | markers",
            None,
            Edit::SetPoints(None).into(),
        ),
        first(
            "Add a mesh… | brain region segment pipette units scale overlay atlas surface",
            None,
            Command::AskFiles(FilePurpose::Meshes),
        ),
        item("Remove all meshes | delete", None, Edit::ClearMeshes.into()),
        first(
            "Save session…",
            Some((CTRL, Key::S)),
            Command::AskFiles(FilePurpose::SaveSession),
        ),
        first(
            "Open palette…",
            None,
            Command::AskFiles(FilePurpose::OpenPalette),
        ),
        item(
            "Save palette…",
            None,
            Command::AskFiles(FilePurpose::SavePalette),
        ),
        first(
            "Save the plot of traces (SVG)…",
            None,
            Command::AskFiles(FilePurpose::SavePlot(PlotOf::Traces, "svg")),
        ),
        item(
            "Save the values of traces (CSV)…",
            None,
            Command::AskFiles(FilePurpose::SavePlot(PlotOf::Traces, "csv")),
        ),
        first(
            "Save mesh, picture or film… | export record movie video frames ffmpeg png ply stl obj simulation screenshot image \
             snapshot blender glb gltf msh gmsh",
            Some((CTRL, Key::E)),
            Command::Show(Tab::Save),
        ),
        item(
            "Share… | save page html web browser send mail",
            None,
            Command::AskFiles(FilePurpose::SavePage),
        ),
        first(
            "Reload changed files",
            Some((CTRL, Key::R)),
            Command::Reload,
        ),
        item("Stop reading or saving", None, Command::Cancel),
        first("Quit", Some((CTRL, Key::Q)), Command::Quit),
    ]
}
