//! The bar of menus.

use eframe::egui::{self, Button, MenuBar, ScrollArea};

use crate::model::command::{Command, Edit, FilePurpose, Listed, PlotOf};
use crate::model::state::State;

/// Room below a menu, for its frame and shadow.
const BELOW: f32 = 18.0;
/// Least height of a menu, in windows of hardly any.
const LEAST: f32 = 80.0;

pub(crate) fn show(state: &mut State, ui: &mut egui::Ui) {
    MenuBar::new().ui(ui, |ui| {
        for (name, items) in state.menus() {
            ui.menu_button(name, |ui| {
                // What has no room in the window is scrolled to.
                let room = ui.ctx().content_rect().bottom() - ui.next_widget_position().y - BELOW;
                // The bar is beside the keys, not over them.
                ui.spacing_mut().scroll.floating_allocated_width = 8.0;
                ScrollArea::vertical()
                    .max_height(room.max(LEAST))
                    .min_scrolled_height(room.max(LEAST))
                    .show(ui, |ui| menu(state, name, items, ui));
            });
        }
    });
}

fn menu(state: &mut State, name: &str, items: Vec<Listed>, ui: &mut egui::Ui) {
    let [undo, redo] = state.history.names();
    for item in items {
        if item.begins {
            ui.separator();
        }
        let title = match (&item.command, undo, redo) {
            (Command::Undo, Some(what), _) => format!("Undo: {}", what.to_lowercase()),
            (Command::Redo, _, Some(what)) => format!("Redo: {}", what.to_lowercase()),
            _ => item.title.into_owned(),
        };
        let enabled = match item.command {
            Command::Undo => undo.is_some(),
            Command::Redo => redo.is_some(),
            Command::Reload => state.sources.stale() > 0,
            Command::CopyDimensions(_) | Command::Edit(Edit::ClearDimensions) => {
                !state.document.dimensions.is_empty()
            }
            Command::AskFiles(FilePurpose::SavePlot(PlotOf::Traces, _))
            | Command::Edit(Edit::ClearTraces) => !state.document.traces.is_empty(),
            _ => true,
        };
        let mut button = Button::new(title);
        if let Some(keys) = item.keys {
            button = button.shortcut_text(crate::ui::panels::keys_text(ui, &keys));
        }
        if ui.add_enabled(enabled, button).clicked() {
            state.requests.push(item.command);
            ui.close();
        }
    }
    if name == "File" {
        recent(state, ui);
    }
}

fn recent(state: &mut State, ui: &mut egui::Ui) {
    if state.settings.recent.is_empty() {
        return;
    }
    ui.separator();
    ui.weak("Recent");
    for path in state.settings.recent.clone() {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let response = ui.button(name).on_hover_text(path.display().to_string());
        if response.clicked() {
            state.requests.push(Command::Open(vec![path]));
            ui.close();
        }
    }
}
