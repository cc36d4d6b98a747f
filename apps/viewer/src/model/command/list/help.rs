//! The menu *Help*.

use eframe::egui::Key;

use super::{CTRL, Listed, PLAIN, item};
use crate::model::command::Command;

pub(super) fn menu() -> Vec<Listed> {
    vec![
        item(
            "Find a command…",
            Some((CTRL, Key::P)),
            Command::TogglePalette,
        ),
        item(
            "Keys and mouse",
            Some((PLAIN, Key::Questionmark)),
            Command::ToggleKeys,
        ),
    ]
}
