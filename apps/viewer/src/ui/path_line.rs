//! Lines for paths with completion: Tab adds what all matching names have in common, and a list
//! shows the matching names.

use std::path::{Path, PathBuf};

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::{Id, Key, Popup, Response, TextEdit, Ui};

use crate::io::paths::{Name, completed, goes_on, parted, read, whole};

/// Most names that a list below a line shows.
const MOST: usize = 9;

/// A line to type a path into; Tab completes it. `id`: its own, since egui's follows from the place: the line
/// would lose the keyboard in the middle of a word when what is above it changes.
pub(crate) fn line(
    text: &mut String,
    id: Id,
    hint: &str,
    complete: impl FnOnce(&str) -> Option<String>,
    ui: &mut Ui,
) -> Response {
    let line = TextEdit::singleline(text)
        .id(id)
        .hint_text(hint)
        .desired_width(f32::INFINITY)
        .lock_focus(true);
    let mut response = ui.add(line);
    if response.has_focus()
        && ui.input(|i| i.key_pressed(Key::Tab))
        && let Some(whole) = complete(text)
    {
        *text = whole;
        to_end(response.id, text, ui);
        response.mark_changed();
    }
    response
}

/// Moves the text cursor to the end.
pub(crate) fn to_end(id: Id, text: &str, ui: &Ui) {
    if let Some(mut state) = TextEdit::load_state(ui.ctx(), id) {
        let end = CCursorRange::one(CCursor::new(text.chars().count()));
        state.cursor.set_char_range(Some(end));
        state.store(ui.ctx(), id);
    }
}

/// A line for a path with a list below it. Relative paths start from `folder`; the list has files
/// with this extension.
pub(crate) fn listing_line(text: &mut String, id: Id, extension: &str, folder: &Path, ui: &mut Ui) {
    let whole_folder = whole(Path::new(parted(text).0), folder);
    let names = names_in(&whole_folder, extension, id.with("names"), ui);
    let response = line(
        text,
        id,
        "Path of the file",
        |typed| completed(typed, &names),
        ui,
    );
    let begun = parted(text).1;
    let fitting: Vec<&Name> = names.iter().filter(|n| goes_on(&n.name, begun)).collect();
    // The list is shown in the frame in which the line loses the keyboard too, so that it can be
    // clicked.
    let looks = response.has_focus() || response.lost_focus();
    let is_whole = matches!(&fitting[..], [one] if one.name == begun);
    if !looks || fitting.is_empty() || is_whole {
        return;
    }
    let mut chosen = None;
    Popup::from_response(&response)
        .open(true)
        .width(response.rect.width())
        .show(|ui| {
            for name in fitting.iter().take(MOST) {
                let slash = if name.is_folder { "/" } else { "" };
                if ui
                    .selectable_label(false, format!("{}{slash}", name.name))
                    .clicked()
                {
                    chosen = Some(format!("{}{}{slash}", parted(text).0, name.name));
                }
            }
            if fitting.len() > MOST {
                ui.weak(format!("and {} more", fitting.len() - MOST));
            }
        });
    if let Some(chosen) = chosen {
        *text = chosen;
        response.request_focus();
        to_end(response.id, text, ui);
    }
}

/// Names in a folder, read again for another folder and when the line gets the keyboard.
fn names_in(folder: &Path, extension: &str, id: Id, ui: &Ui) -> Vec<Name> {
    type Kept = (PathBuf, Vec<Name>);
    let known: Option<Kept> = ui.data(|data| data.get_temp(id));
    match known {
        Some((known, names)) if known == folder => names,
        _ => {
            let names = read(folder, extension);
            ui.data_mut(|data| data.insert_temp(id, (folder.to_path_buf(), names.clone())));
            names
        }
    }
}
