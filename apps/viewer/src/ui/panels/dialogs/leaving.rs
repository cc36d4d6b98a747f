//! Questions about what is not saved: when it would be lost, and when it was found at the start.

use std::time::SystemTime;

use eframe::egui::{Context, RichText};

use super::{question, safe};
use crate::model::command::{Command, FilePurpose};
use crate::model::state::{Dialog, State};
use crate::ui::panels::cells::count;

/// Asks whether a command may end what is not saved.
pub(crate) fn unsaved(state: &mut State, command: Box<Command>, ctx: &Context) -> Dialog {
    let quits = *command == Command::Quit;
    let title = match quits {
        true => "Quit?",
        false => "Open another session?",
    };
    let mut stays = None;
    question(title, ctx, |ui| {
        if state.writing {
            ui.label("Files are still being written. Quitting stops that.");
        }
        if state.changes.unsaved() {
            ui.label("There are edits that no session has.");
        }
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            if state.changes.unsaved() {
                let own = state.session.clone();
                let name = own.as_deref().and_then(|own| own.file_name());
                let text = name.map_or("Save session…".to_owned(), |name| {
                    format!("Save {}", name.to_string_lossy())
                });
                if ui.button(text).clicked() {
                    stays = Some(match own {
                        // If that fails, the command asks again.
                        Some(own) => {
                            let save = Command::SaveSession(own);
                            state.requests.extend([save, (*command).clone()]);
                            Dialog::Nothing
                        }
                        None => Dialog::Files(FilePurpose::SaveSession),
                    });
                }
            }
            let go_on = match (quits, state.changes.unsaved()) {
                (true, true) => "Quit without saving",
                (true, false) => "Stop and quit",
                (false, _) => "Open without saving",
            };
            if ui.button(go_on).clicked() {
                let command = Command::Unasked(command.clone());
                state.requests.push(command);
                stays = Some(Dialog::Nothing);
            }
            if safe(ui, "Cancel") {
                stays = Some(Dialog::Nothing);
            }
        });
    });
    stays.unwrap_or(Dialog::Unsaved(command))
}

/// Offers what an earlier window had not saved.
pub(crate) fn recover(state: &mut State, written: SystemTime, ctx: &Context) -> Dialog {
    let mut answer = None;
    question("Edits that were not saved", ctx, |ui| {
        let minutes = written.elapsed().map_or(0, |ago| ago.as_secs() / 60) as usize;
        let ago = match minutes {
            0..120 => count(minutes, "minute"),
            120..2880 => count(minutes / 60, "hour"),
            _ => count(minutes / 1440, "day"),
        };
        ui.label(format!(
            "A window ended {ago} ago before its edits were saved."
        ));
        ui.label(RichText::new("Its session was kept.").weak());
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            if safe(ui, "Open it") {
                answer = Some(true);
            }
            if ui.button("Discard it").clicked() {
                answer = Some(false);
            }
        });
    });
    match answer {
        Some(open) => {
            state.requests.push(Command::Recover(open));
            Dialog::Nothing
        }
        None => Dialog::Recover(written),
    }
}
