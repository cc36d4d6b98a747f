//! The menu *Window*.

use eframe::egui::Key;

use super::{CTRL_SHIFT, Listed, PLAIN, Toggles, choose, first, item};
use crate::model::command::{Command, Tab};

pub(super) fn menu(now: &Toggles) -> Vec<Listed> {
    vec![
        item(
            "Inspect | sholl barcode strahler tortuosity numbers measures plot attributes crossings copy",
            Some((CTRL_SHIFT, Key::I)),
            Command::Show(Tab::Inspect),
        ),
        item(
            "Soma editor | poisson sphere neurite ring",
            Some((CTRL_SHIFT, Key::S)),
            Command::Show(Tab::Soma),
        ),
        item("Look | color colour picker colorblind background white black light wireframe radius factor thickness line width \
             legend mesh opacity ghost transparent fade axon dendrite soma type axes scale bar", Some((CTRL_SHIFT, Key::L)), Command::Show(Tab::Look)),
        item(
            "Level of detail | quality triangles budget memory static exploration mode",
            Some((CTRL_SHIFT, Key::D)),
            Command::Show(Tab::Detail),
        ),
        first(
            choose(now.dark, "Dark theme | night light appearance", "Light theme | day dark appearance"),
            None,
            Command::SetDark(!now.dark),
        ),
        item(
            choose(
                now.caches,
                "Keep caches of circuits",
                "Keep no caches of circuits",
            ),
            None,
            Command::SetCaches(!now.caches),
        ),
        first(
            choose(now.full_screen, "Full screen", "Leave the full screen"),
            Some((PLAIN, Key::F11)),
            Command::SetFullScreen(!now.full_screen),
        ),
        item(
            choose(
                now.presenting,
                "Presentation: full screen, no panels, turntable",
                "End the presentation (turntable)",
            ),
            Some((PLAIN, Key::F5)),
            Command::SetPresenting(!now.presenting),
        ),
        item(
            "Show or hide the panels",
            Some((PLAIN, Key::Tab)),
            Command::TogglePanels,
        ),
        first("What went wrong", None, Command::ToggleProblems),
    ]
    .into_iter()
    .chain(now.presenting.then(|| {
        item(
            "Leave the presentation",
            Some((PLAIN, Key::Escape)),
            Command::SetPresenting(false),
        )
    }))
    .collect()
}
