//! Saves meshes, pictures, films and sessions.

mod meshes;

use std::path::PathBuf;

use eframe::egui::{Button, Id, RichText, Ui};
use neurotess::render::LARGEST;

use super::heading;
use crate::io::save::video::has_ffmpeg;
use crate::model::command::{Command, FilePurpose};
use crate::model::film::length;
use crate::model::save::{FilmOptions, PictureFile};
use crate::model::state::{Dialog, State};
use crate::ui::panels::widgets::number::field;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::path_line;

pub(super) fn show(state: &mut State, ui: &mut Ui) {
    let name = state.usual_name();
    state.save.propose(&state.settings.folder, &name);
    meshes::show(state, ui);
    ui.add_space(6.0);
    ui.separator();
    picture(state, ui);
    ui.add_space(6.0);
    ui.separator();
    film(state, ui);
    ui.add_space(6.0);
    ui.separator();
    heading(ui, "Session");
    ui.weak("Keeps the files, the view, the look, soma settings, and what is hidden and selected, to continue later.");
    if ui.button("Save session…").clicked() {
        state
            .requests
            .push(Command::AskFiles(FilePurpose::SaveSession));
    }
}

/// Requests a command that saves, or asks before it replaces files.
fn save(state: &mut State, command: Command) {
    let asks = state.request(command);
    if !matches!(asks, Dialog::Nothing) {
        state.layout.dialog = asks;
    }
}

fn picture(state: &mut State, ui: &mut Ui) {
    heading(ui, "Picture");
    let (form, folder) = (&mut state.save, &state.settings.folder);
    size(&mut form.picture, ui);
    path_line::listing_line(
        &mut form.picture_out,
        Id::unique("picture path"),
        "png",
        folder,
        ui,
    );
    let ready = !form.picture_out.trim().is_empty();
    if ui.add_enabled(ready, Button::new("Save picture")).clicked() {
        let options = PictureFile {
            out: PathBuf::from(form.picture_out.trim()),
            replace: false,
            ..form.picture.clone()
        };
        save(state, Command::SavePicture(options));
    }
}

fn size(picture: &mut PictureFile, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let [width, height] = &mut picture.size;
        field(ui, width, 1..=LARGEST, 0, |field| field.speed(8));
        ui.label("×");
        field(ui, height, 1..=LARGEST, 0, |field| field.speed(8));
        ui.label("pixels");
    });
    // Wrapped: what is too wide widens all that comes after it.
    ui.horizontal_wrapped(|ui| {
        ui.label("samples per pixel")
            .tip("More give smoother edges and take longer");
        for samples in [4, 16, 64] {
            ui.selectable_value(&mut picture.samples, samples, samples.to_string());
        }
        ui.checkbox(&mut picture.transparent, "transparent background");
    });
}

/// First and last time of a film through a recording.
fn film_time(state: &mut State, ui: &mut Ui) {
    let Some(facts) = &state.playback.facts else {
        return;
    };
    let axis = facts.time;
    let (start, end) = (axis.start, axis.nearest(f64::INFINITY));
    let form = &mut state.save;
    if form.time[0] >= form.time[1] || form.time.iter().any(|t| *t < start || *t > end) {
        form.time = [start, end];
    }
    ui.horizontal(|ui| {
        ui.checkbox(&mut form.over_time, "play the report")
            .tip(
                "The report plays through the film; with fewer than two kept views the camera stays here",
            );
        if form.over_time {
            let [from, to] = form.time;
            let [first, last] = &mut form.time;
            field(ui, first, start..=to, 3, |field| field.speed(axis.step));
            ui.label("–");
            field(ui, last, from..=end, 3, |field| {
                field.speed(axis.step).suffix(" ms")
            });
        }
    });
}

fn film(state: &mut State, ui: &mut Ui) {
    heading(ui, "Film");
    if state.views.key_views.is_empty() {
        ui.weak("Keep two or more views (K): the camera moves from one to the next.");
    }
    for (index, view) in state.views.key_views.clone().into_iter().enumerate() {
        ui.horizontal(|ui| {
            if ui
                .button(format!("View {}", index + 1))
                .tip("Go there")
                .clicked()
            {
                state.requests.push(Command::Go(view));
            }
            if ui.small_button("×").tip("Remove this view").clicked() {
                state.requests.push(Command::DropKeyView(index));
            }
        });
    }
    if ui.button("Keep this view").clicked() {
        state.requests.push(Command::AddKeyView);
    }
    let keys = state.views.key_views.len();
    film_time(state, ui);
    let over_time = state.save.over_time && state.playback.facts.is_some();
    if keys < 2 && !over_time {
        return;
    }
    let (form, folder) = (&mut state.save, &state.settings.folder);
    ui.horizontal(|ui| {
        field(ui, &mut form.frames, 1..=3000, 0, |field| field);
        ui.label(match keys {
            0 | 1 => "frames",
            _ => "frames from view to view",
        });
    });
    let all = length(keys, form.frames, over_time);
    ui.weak(format!(
        "{all} frames, {:.1} s at 30 per second",
        all as f64 / 30.0
    ));
    let ffmpeg = *form.ffmpeg.get_or_insert_with(has_ffmpeg);
    ui.add_enabled_ui(ffmpeg, |ui| {
        ui.checkbox(&mut form.video, "also a video (MP4)")
            .on_disabled_hover_text("ffmpeg is not installed");
    });
    path_line::listing_line(
        &mut form.film_out,
        Id::unique("film path"),
        "png",
        folder,
        ui,
    );
    ui.label(
        RichText::new("Size and samples as set for the picture above.")
            .weak()
            .small(),
    );
    if ui.button("Save film").clicked() {
        let film = FilmOptions {
            picture: PictureFile {
                out: PathBuf::from(form.film_out.trim()),
                replace: false,
                ..form.picture.clone()
            },
            frames: form.frames,
            time: over_time.then_some(form.time),
            video: form.video && ffmpeg,
        };
        save(state, Command::SaveFilm(film));
    }
}
