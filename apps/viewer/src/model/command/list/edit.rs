//! The menu *Edit*.

use eframe::egui::Key;

use super::{CTRL, CTRL_SHIFT, Listed, PLAIN, Toggles, choose, first, grow, item};
use crate::model::command::{Command, Edit, Tab};
use crate::model::document::SpinePlaces;

pub(super) fn menu(now: &Toggles) -> Vec<Listed> {
    vec![
        item("Undo", Some((CTRL, Key::Z)), Command::Undo),
        item("Redo", Some((CTRL_SHIFT, Key::Z)), Command::Redo),
        first("Select all", Some((CTRL, Key::A)), Edit::SelectAll.into()),
        item(
            "Select none",
            // While measuring or presenting, Escape leaves that.
            (!now.measuring && !now.presenting).then_some((PLAIN, Key::Escape)),
            Edit::SelectNone.into(),
        ),
        item(
            "Invert the selection",
            Some((CTRL, Key::I)),
            Edit::SelectOthers.into(),
        ),
        item(
            choose(
                now.lasso,
                "Select with a lasso (Ctrl + drag) | freehand rectangle box",
                "Select with a rectangle (Ctrl + drag) | box lasso",
            ),
            Some((PLAIN, Key::L)),
            Command::SetLasso(!now.lasso),
        ),
        first(
            choose(
                now.placing,
                "Move and turn selected | handles gizmo translate rotate cell drag",
                "Stop moving and turning | handles gizmo",
            ),
            Some((PLAIN, Key::P)),
            Command::SetPlacing(!now.placing),
        ),
        item(
            "Position and rotation of selected… | numbers coordinates angles units µm degrees",
            None,
            Command::Show(Tab::Inspect),
        ),
        item(
            "Duplicate selected | copy of a cell",
            Some((CTRL, Key::D)),
            Command::Duplicate,
        ),
        item(
            "Put selected back where they were traced",
            None,
            Command::PutBack,
        ),
        first(
            "Remove selected from the list | delete close unload",
            Some((PLAIN, Key::Delete)),
            Edit::Remove.into(),
        ),
        first(
            choose(
                now.measuring,
                "Measure: distance, path length, diameter, angle | ruler",
                "Stop measuring",
            ),
            Some((PLAIN, Key::M)),
            Command::SetMeasuring(!now.measuring),
        ),
        item(
            "Copy all dimensions",
            Some((CTRL_SHIFT, Key::C)),
            Command::CopyDimensions(None),
        ),
        item(
            "Remove all dimensions | delete measures",
            None,
            Edit::ClearDimensions.into(),
        ),
        first(
            "Grow spines at random (1 for each µm of dendrites)",
            None,
            grow(SpinePlaces::Random),
        ),
        item(
            "Grow the spines that the file tells of (ASC, H5)",
            None,
            grow(SpinePlaces::File),
        ),
        item(
            "Grow spines at synapses of a circuit's cell | inputs",
            None,
            grow(SpinePlaces::Synapses),
        ),
        item(
            "Remove spines | delete",
            None,
            Edit::GrowSpines(None).into(),
        ),
        item(
            "Remove all traces of the plot",
            None,
            Edit::ClearTraces.into(),
        ),
    ]
    .into_iter()
    .chain((now.measuring && !now.presenting).then(|| {
        item(
            "Forget the first place, or stop measuring",
            Some((PLAIN, Key::Escape)),
            Command::LeaveMeasuring,
        )
    }))
    .collect()
}
