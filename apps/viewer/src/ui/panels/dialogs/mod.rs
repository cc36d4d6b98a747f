//! Dialogs: keys, commands, problems, files, questions.

mod leaving;

use std::borrow::Cow;

use eframe::egui::{self, Align2, Context, Id, Key, RichText, ScrollArea, TextEdit, Ui};

use crate::model::command::{Command, FilePurpose, Listed};
use crate::model::state::{Dialog, State};
use crate::ui::file_panel::FilePanel;
use crate::ui::panels::{keys_text, window};

pub(crate) fn show(state: &mut State, panel: &mut Option<FilePanel>, ctx: &Context) {
    let dialog = std::mem::take(&mut state.layout.dialog);
    // Behind the question whether a file may be replaced, the file dialog waits.
    let keeps = |dialog: &Dialog| matches!(dialog, Dialog::Files(_) | Dialog::Replace(..));
    if !keeps(&dialog) {
        *panel = None;
    }
    let escape = ctx.input(|i| i.key_pressed(Key::Escape));
    let stays = match dialog {
        Dialog::Nothing => Dialog::Nothing,
        Dialog::Keys => keys(state, ctx),
        Dialog::Problems => problems(state, ctx),
        Dialog::Palette(text, chosen) => palette(state, text, chosen, ctx),
        Dialog::Files(purpose) => files(state, purpose, panel, ctx),
        Dialog::Replace(path, command) => replace(state, path, command, panel, ctx),
        Dialog::Unsaved(command) => leaving::unsaved(state, command, ctx),
        Dialog::Recover(written) => leaving::recover(state, written, ctx),
    };
    let had = !matches!(stays, Dialog::Nothing);
    state.layout.dialog = match (escape, stays) {
        (false, stays) => stays,
        (true, Dialog::Replace(..)) => back(panel),
        (true, _) => Dialog::Nothing,
    };
    if !keeps(&state.layout.dialog) {
        *panel = None;
    }
    if escape && had {
        // Escape has closed a dialog: it must not also clear the selection.
        ctx.input_mut(|i| i.consume_key(egui::Modifiers::NONE, Key::Escape));
    }
}

fn files(
    state: &mut State,
    purpose: FilePurpose,
    panel: &mut Option<FilePanel>,
    ctx: &Context,
) -> Dialog {
    let mut shown = panel
        .take()
        .filter(|panel| panel.is_for(purpose))
        .unwrap_or_else(|| {
            let session = state.session.as_deref();
            FilePanel::new(
                purpose,
                &state.settings.folder,
                session,
                &state.usual_name(),
            )
        });
    let mut open = true;
    if let Some(command) = shown.show(ctx, &mut open) {
        let asks = state.request(command);
        *panel = Some(shown);
        return asks;
    }
    if !open {
        return Dialog::Nothing;
    }
    *panel = Some(shown);
    Dialog::Files(purpose)
}

/// A question: until it is answered, nothing behind it can be reached, by mouse or by keyboard.
fn question(title: &str, ctx: &Context, content: impl FnOnce(&mut Ui)) {
    egui::Modal::new(Id::unique(title)).show(ctx, |ui| {
        ui.heading(title);
        ui.add_space(4.0);
        content(ui);
    });
}

/// The button of the answer that loses nothing: Enter gives it, unless Tab has gone to another.
fn safe(ui: &mut Ui, text: &str) -> bool {
    let button = ui.button(text);
    if ui.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
    button.clicked()
}

/// What is shown after a file was not to be replaced: the file dialog that the question came from, if it was one.
fn back(panel: &mut Option<FilePanel>) -> Dialog {
    match panel {
        Some(panel) => Dialog::Files(panel.again()),
        None => Dialog::Nothing,
    }
}

const MOUSE: [(&str, &str); 9] = [
    ("left drag", "rotate"),
    ("middle or right drag, Shift + left drag", "pan"),
    ("wheel, two fingers, pinch", "zoom in and out at the cursor"),
    ("click", "select; with Shift or Ctrl, select several"),
    (
        "Ctrl + left drag",
        "select somata in a rectangle or a lasso (L); with Shift, more",
    ),
    ("double click", "zoom to what is under the cursor"),
    ("W A S D   Q E", "fly; down, up; Shift: faster"),
    ("arrows", "rotate"),
    ("+  −", "zoom in and out"),
];

fn keys(state: &State, ctx: &Context) -> Dialog {
    let mut open = true;
    window("Keys and mouse", ctx)
        .open(&mut open)
        .show(ctx, |ui| {
            let room = ctx.content_rect().size() - egui::vec2(60.0, 90.0);
            // As large as its content, as far as the window allows.
            let area = ScrollArea::both().max_width(room.x).max_height(room.y);
            let area = area.min_scrolled_width(room.x).min_scrolled_height(room.y);
            area.show(ui, |ui| keys_and_mouse(state, ui));
        });
    if open { Dialog::Keys } else { Dialog::Nothing }
}

/// Menus with many keys, which have a column of their own.
const LONG: [&str; 2] = ["View", "Window"];

fn keys_and_mouse(state: &State, ui: &mut Ui) {
    let mut menus = state.menus();
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            ui.strong("In the picture");
            rows(
                ui,
                "mouse",
                MOUSE.iter().map(|&(a, b)| (a.to_owned(), b.into())),
            );
            for (name, items) in menus.extract_if(.., |(name, _)| !LONG.contains(name)) {
                menu(ui, name, items);
            }
        });
        ui.add_space(18.0);
        ui.vertical(|ui| {
            for (name, items) in menus {
                menu(ui, name, items);
            }
        });
    });
}

fn menu(ui: &mut Ui, name: &str, items: Vec<Listed>) {
    let found: Vec<(String, Cow<'static, str>)> = items
        .into_iter()
        .filter_map(|item| Some((keys_text(ui, &item.keys?), item.title)))
        .collect();
    if !found.is_empty() {
        ui.add_space(6.0);
        ui.strong(name);
        rows(ui, name, found.into_iter());
    }
}

fn rows(ui: &mut Ui, id: &str, rows: impl Iterator<Item = (String, Cow<'static, str>)>) {
    egui::Grid::new(("keys", id))
        .num_columns(2)
        .spacing([16.0, 1.0])
        .show(ui, |ui| {
            for (keys, what) in rows {
                ui.label(RichText::new(keys).monospace().size(11.5));
                ui.label(what);
                ui.end_row();
            }
        });
}

fn problems(state: &mut State, ctx: &Context) -> Dialog {
    let mut open = true;
    window("What went wrong", ctx)
        .open(&mut open)
        .default_width(560.0)
        .show(ctx, |ui| {
            if state.messages.problems.is_empty() {
                ui.weak("Nothing.");
                return;
            }
            ScrollArea::vertical().max_height(360.0).show(ui, |ui| {
                for problem in &state.messages.problems {
                    ui.label(RichText::new(&problem.what).strong());
                    ui.label(&problem.why);
                    ui.add_space(4.0);
                }
            });
            ui.separator();
            ui.horizontal(|ui| {
                if ui.button("Copy").clicked() {
                    let lines = state
                        .messages
                        .problems
                        .iter()
                        .map(|p| format!("{}: {}\n", p.what, p.why));
                    ui.ctx().copy_text(lines.collect());
                }
                if ui.button("Clear the list").clicked() {
                    state.messages.problems.clear();
                }
            });
        });
    if open {
        Dialog::Problems
    } else {
        Dialog::Nothing
    }
}

fn palette(state: &mut State, mut text: String, mut chosen: usize, ctx: &Context) -> Dialog {
    let mut done = false;
    egui::Window::new("palette")
        .title_bar(false)
        .resizable(false)
        .anchor(Align2::CENTER_TOP, [0.0, 70.0])
        .fixed_size([440.0, 330.0])
        .show(ctx, |ui| {
            let line = TextEdit::singleline(&mut text)
                .id(Id::unique("palette line"))
                .hint_text("Find a command")
                .desired_width(f32::INFINITY);
            let line = ui.add(line);
            line.request_focus();
            let [up, down, enter] = [Key::ArrowUp, Key::ArrowDown, Key::Enter]
                .map(|key| ui.input(|i| i.key_pressed(key)));
            // Searched with the current text, since Enter may be in the same frame as the last
            // letter.
            let items = found(state, &text);
            let last = items.len().saturating_sub(1);
            chosen = match (up, down) {
                _ if line.changed() => 0,
                (_, true) => (chosen + 1).min(last),
                (true, _) => chosen.min(last).saturating_sub(1),
                _ => chosen.min(last),
            };
            ui.separator();
            ScrollArea::vertical()
                .max_height(280.0)
                .auto_shrink(false)
                .show(ui, |ui| {
                    for (index, (menu, item)) in items.iter().enumerate() {
                        let mut text = format!("{menu}:  {}", item.title);
                        if let Some(keys) = &item.keys {
                            text.push_str(&format!("    {}", keys_text(ui, keys)));
                        }
                        let response = ui.selectable_label(index == chosen, text);
                        if index == chosen && (up || down) {
                            response.scroll_to_me(None);
                        }
                        if response.clicked() || (enter && index == chosen) {
                            state.requests.push(item.command.clone());
                            done = true;
                        }
                    }
                    if items.is_empty() {
                        ui.weak("No command contains these words");
                    }
                });
            if done {
                // The next key is not for the line of text any more.
                line.surrender_focus();
            }
        });
    if done {
        Dialog::Nothing
    } else {
        Dialog::Palette(text, chosen)
    }
}

/// Commands that all words are in, of titles or by which they are looked for, with their menus.
fn found(state: &State, text: &str) -> Vec<(&'static str, Listed)> {
    let all = state.menus();
    all.into_iter()
        .flat_map(|(menu, items)| items.into_iter().map(move |item| (menu, item)))
        .filter(|(menu, item)| {
            matches_words(&format!("{menu} {} {}", item.title, item.words), text)
        })
        .collect()
}

/// Whether all words are in a title, in any order.
fn matches_words(title: &str, text: &str) -> bool {
    let title = title.to_lowercase();
    text.to_lowercase()
        .split_whitespace()
        .all(|word| title.contains(word))
}

fn replace(
    state: &mut State,
    path: std::path::PathBuf,
    command: Box<Command>,
    panel: &mut Option<FilePanel>,
    ctx: &Context,
) -> Dialog {
    let mut answer = None;
    question("Replace?", ctx, |ui| {
        let what = if path.is_dir() {
            "There is a folder of this name; files in it may be replaced"
        } else {
            "This file exists"
        };
        ui.label(what);
        ui.label(RichText::new(path.display().to_string()).monospace());
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            if ui.button("Replace").clicked() {
                answer = Some(true);
            }
            if safe(ui, "Cancel") {
                answer = Some(false);
            }
        });
    });
    match answer {
        Some(true) => {
            state.requests.push(*command);
            Dialog::Nothing
        }
        Some(false) => back(panel),
        None => Dialog::Replace(path, command),
    }
}

#[cfg(test)]
mod tests {
    use super::matches_words;
    use crate::model::command::{Listed, Toggles, listed};

    /// What someone types who wants to do something and was not told how it is called here.
    #[test]
    fn features_are_found_by_the_words_of_the_field() {
        let menus = listed(&Toggles::default());
        let titles: Vec<String> = menus
            .iter()
            .flat_map(|(menu, items)| {
                let title = |item: &Listed| format!("{menu} {} {}", item.title, item.words);
                items.iter().map(title).collect::<Vec<_>>()
            })
            .collect();
        for words in [
            "synapse",
            "bouton",
            "contact",
            "spine",
            "measure",
            "distance",
            "path length",
            "diameter",
            "angle",
            "ruler",
            "add mesh",
            "brain region",
            "pipette",
            "segment",
            "opacity",
            "trace",
            "voltage",
            "csv",
            "svg",
            "attributes",
            "sholl",
            "barcode",
            "strahler",
            "tortuosity",
            "numbers",
            "color",
            "palette",
            "picker",
            "colorblind",
            "radius factor",
            "line width",
            "scale bar",
            "orthographic",
            "perspective",
            "save view",
            "two views",
            "side by side",
            "link views",
            "full screen",
            "turntable",
            "spin",
            "presentation",
            "record",
            "movie",
            "video",
            "film",
            "lasso",
            "rectangle",
            "hide",
            "isolate",
            "neurite",
            "move cell",
            "rotate",
            "gizmo",
            "duplicate",
            "copy cell",
            "clamp",
            "points table",
            "crossings",
            "snudda",
            "circuit",
            "report",
            "spikes",
            "session",
            "undo",
            "zoom",
            "level of detail",
            "wireframe",
            "simulation",
            "export",
            "axon",
            "white",
            "ghost",
            "screenshot",
            "blender",
            "dark",
            "units",
            "delete",
        ] {
            assert!(
                titles.iter().any(|title| matches_words(title, words)),
                "{words}"
            );
        }
    }

    #[test]
    fn words_are_found_in_any_order() {
        assert!(matches_words("View: Hide selected", "sel hide"));
        assert!(!matches_words("View: Hide selected", "show"));
        assert!(matches_words("anything", ""));
    }
}
