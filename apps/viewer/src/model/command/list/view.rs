//! The menu *View*.

use eframe::egui::Key;
use neurotess::render::Side;

use super::{CTRL, Listed, PLAIN, SAVED_VIEWS, Toggles, choose, first, item};
use crate::model::command::{Command, Edit};

pub(super) fn menu(now: &Toggles) -> Vec<Listed> {
    [
        item(
            "Home: everything, from the front",
            Some((PLAIN, Key::Home)),
            Command::Home,
        ),
        item(
            "Zoom to the selection",
            Some((PLAIN, Key::F)),
            Command::Focus,
        ),
        first(
            "Front",
            Some((PLAIN, Key::Num1)),
            Command::Look(Side::Front),
        ),
        item(
            "Right",
            Some((PLAIN, Key::Num2)),
            Command::Look(Side::Right),
        ),
        item("Top", Some((PLAIN, Key::Num3)), Command::Look(Side::Top)),
        item("Back", Some((CTRL, Key::Num1)), Command::Look(Side::Back)),
        item("Left", Some((CTRL, Key::Num2)), Command::Look(Side::Left)),
        item(
            "Bottom",
            Some((CTRL, Key::Num3)),
            Command::Look(Side::Bottom),
        ),
        item(
            "From a corner",
            Some((PLAIN, Key::Num4)),
            Command::Look(Side::Iso),
        ),
        first(
            choose(
                now.orthographic,
                "Orthographic projection: true scale bar | parallel perspective",
                "Perspective projection | orthographic parallel true scale bar",
            ),
            Some((PLAIN, Key::O)),
            Command::SetOrthographic(!now.orthographic),
        ),
        first(
            "Hide selected | invisible section neurite type",
            Some((PLAIN, Key::H)),
            Edit::Hide.into(),
        ),
        item(
            "Isolate selected | only this section neurite type",
            Some((PLAIN, Key::I)),
            Edit::Isolate.into(),
        ),
        item("Show all", Some((CTRL, Key::H)), Edit::ShowAll.into()),
        first(
            choose(
                now.clamped,
                "Clamp selected: fine while moving | pin",
                "Unclamp selected | unpin",
            ),
            Some((PLAIN, Key::C)),
            Edit::Clamp(!now.clamped).into(),
        ),
        item("Unclamp all | unpin", None, Edit::UnclampAll.into()),
        first(
            choose(now.y_down, "y axis down | electron microscopy", "y axis up"),
            Some((PLAIN, Key::Y)),
            Command::SetYDown(!now.y_down),
        ),
        item(
            choose(now.grid, "Lay out side by side", "Place as traced"),
            Some((PLAIN, Key::G)),
            Edit::SetGrid(!now.grid).into(),
        ),
        item(
            choose(
                now.frozen,
                "Freeze the level of detail",
                "Unfreeze the level of detail",
            ),
            Some((CTRL, Key::F)),
            Command::SetFrozen(!now.frozen),
        ),
        first(
            choose(
                now.split,
                "Two views side by side | split",
                "One view | unsplit",
            ),
            Some((PLAIN, Key::B)),
            Command::SetSplit(!now.split),
        ),
        item(
            choose(
                now.linked,
                "Link the two views: they move together",
                "Unlink the two views",
            ),
            Some((CTRL, Key::B)),
            Command::SetLinked(!now.linked),
        ),
        first(
            choose(
                now.turning,
                "Turntable: turn the scene slowly | spin",
                "Stop the turntable | spin",
            ),
            Some((PLAIN, Key::R)),
            Command::SetTurning(!now.turning),
        ),
        first(
            choose(
                now.synapses,
                "Show synapses | contacts edges markers",
                "Hide synapses | contacts edges markers",
            ),
            Some((PLAIN, Key::X)),
            Edit::ShowSynapses(!now.synapses).into(),
        ),
        item(
            choose(
                now.contacts,
                "Draw synapses as contact discs on the membrane | boutons",
                "Draw synapses as spheres, without contact discs",
            ),
            None,
            Edit::ShowContacts(!now.contacts).into(),
        ),
        first(
            choose(now.playing, "Play the report", "Stop the report"),
            Some((PLAIN, Key::Space)),
            Command::TogglePlay,
        ),
        item(
            "Previous frame",
            Some((PLAIN, Key::Comma)),
            Command::StepTime(-1),
        ),
        item(
            "Next frame",
            Some((PLAIN, Key::Period)),
            Command::StepTime(1),
        ),
        first(
            choose(
                now.traces,
                "Plot values over time | traces voltage time course",
                "Close the plot of values over time | traces voltage",
            ),
            Some((PLAIN, Key::T)),
            Command::ShowTraces(!now.traces),
        ),
        item(
            choose(
                now.crossings,
                "List self-crossings of the surface | intersections",
                "Close the list of self-crossings | intersections",
            ),
            None,
            Command::ListCrossings(!now.crossings),
        ),
        item(
            "Reset look: nothing hidden, scaled or cut",
            None,
            Edit::ResetLook.into(),
        ),
        first(
            "Keep this view for a film",
            Some((PLAIN, Key::K)),
            Command::AddKeyView,
        ),
        item(
            "Save this view under a name (5 to 9 go to the first)",
            Some((PLAIN, Key::V)),
            Command::SaveView,
        ),
    ]
    .into_iter()
    .chain(
        (0..)
            .zip(SAVED_VIEWS)
            .map(|(index, (title, key))| item(title, Some((PLAIN, key)), Command::GoSaved(index))),
    )
    .collect()
}
