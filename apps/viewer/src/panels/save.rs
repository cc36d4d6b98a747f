//! Meshes, pictures, films, sessions.

use std::path::PathBuf;

use eframe::egui::{Button, ComboBox, DragValue, RichText, TextEdit, Ui};
use neurotess::mesh::Format;
use neurotess::render::LARGEST;

use super::cells::count;
use super::heading;
use crate::command::{Ask, Command};
use crate::save::{FilmOptions, Fineness, PictureFile, has_ffmpeg, length};
use crate::state::{Over, State};

pub(super) fn show(state: &mut State, ui: &mut Ui) {
    meshes(state, ui);
    ui.add_space(6.0);
    ui.separator();
    picture(state, ui);
    ui.add_space(6.0);
    ui.separator();
    film(state, ui);
    ui.add_space(6.0);
    ui.separator();
    heading(ui, "Session");
    ui.weak("Files, view, look, somata, what is hidden and selected, to go on later or elsewhere.");
    if ui.button("Save session…").clicked() {
        state.asked.push(Command::AskFiles(Ask::SaveSession));
    }
}

/// A line for a path.
fn path_line(path: &mut String, ui: &mut Ui) {
    ui.add(
        TextEdit::singleline(path)
            .desired_width(f32::INFINITY)
            .hint_text("A path"),
    );
}

/// Asks before files are replaced.
fn ask(state: &mut State, out: PathBuf, exists: bool, command: Command, replacing: Command) {
    if exists {
        state.over = Over::Replace(out, Box::new(replacing));
    } else {
        state.asked.push(command);
    }
}

const FORMATS: [Format; 6] = [
    Format::Ply,
    Format::Obj,
    Format::Stl,
    Format::Glb,
    Format::Off,
    Format::Vtu,
];

fn meshes(state: &mut State, ui: &mut Ui) {
    heading(ui, "Meshes");
    let shown = state.document.neurons.iter().filter(|n| !n.hidden).count();
    let selected = state.document.selected().count();
    let form = &mut state.save;
    ui.horizontal_wrapped(|ui| {
        ui.radio_value(&mut form.mesh.all, true, format!("all shown ({shown})"));
        ui.radio_value(&mut form.mesh.all, false, format!("selected ({selected})"));
    });
    ui.horizontal(|ui| {
        ui.label("format");
        ComboBox::from_id_salt("format")
            .width(70.0)
            .selected_text(form.mesh.format.extension())
            .show_ui(ui, |ui| {
                for format in FORMATS {
                    if ui
                        .selectable_value(&mut form.mesh.format, format, format.extension())
                        .clicked()
                    {
                        let path = PathBuf::from(&form.mesh_out).with_extension(format.extension());
                        form.mesh_out = path.display().to_string();
                    }
                }
            });
        let quads = form.mesh.format.has_quads();
        ui.add_enabled_ui(quads, |ui| ui.checkbox(&mut form.mesh.quads, "quads"));
    });
    fineness(&mut form.mesh.fineness, ui);
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut form.mesh.placed, "where it stands here").on_hover_text(
            "As laid out in the window, or placed by its circuit; else in the tracing's own coordinates",
        );
        ui.checkbox(&mut form.mesh.linear, "straight").on_hover_text("Straight between traced points instead of smooth");
        ui.checkbox(&mut form.mesh.flat, "flat ends").on_hover_text("Disks instead of half spheres");
    });
    path_line(&mut form.mesh_out, ui);
    let number = if form.mesh.all { shown } else { selected };
    if number > 1 {
        ui.weak("Several: a folder of this name, one file each.");
    }
    let title = format!("Save {}", count(number, "mesh").replace("meshs", "meshes"));
    let ready = number > 0 && !form.mesh_out.trim().is_empty();
    if ui.add_enabled(ready, Button::new(title)).clicked() {
        let mut options = form.mesh.clone();
        options.out = PathBuf::from(form.mesh_out.trim());
        options.replace = false;
        let mut replacing = options.clone();
        replacing.replace = true;
        let out = match number {
            1 => options.out.with_extension(options.format.extension()),
            _ => options.out.with_extension(""),
        };
        let exists = out.exists();
        ask(
            state,
            out,
            exists,
            Command::SaveMeshes(options),
            Command::SaveMeshes(replacing),
        );
    }
}

fn fineness(fineness: &mut Fineness, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let level = matches!(fineness, Fineness::Level(_));
        if ui
            .selectable_label(level, "level")
            .on_hover_text("Subdivisions of every coarse edge; 0: the coarse quads")
            .clicked()
            && !level
        {
            *fineness = Fineness::Level(4);
        }
        let error = matches!(fineness, Fineness::MaxError(_));
        if ui
            .selectable_label(error, "error")
            .on_hover_text("As fine as keeps the surface within a distance of the finest one")
            .clicked()
            && !error
        {
            *fineness = Fineness::MaxError(0.05);
        }
        let shown = matches!(fineness, Fineness::AsShown);
        if ui
            .selectable_label(shown, "as shown")
            .on_hover_text("The levels of the picture: near things finer")
            .clicked()
        {
            *fineness = Fineness::AsShown;
        }
        match fineness {
            Fineness::Level(level) => {
                ui.add(DragValue::new(level).range(0..=64));
            }
            Fineness::MaxError(error) => {
                ui.add(
                    DragValue::new(error)
                        .range(0.001..=10.0)
                        .speed(0.005)
                        .suffix(" µm"),
                );
            }
            Fineness::AsShown => {}
        }
    });
}

fn picture(state: &mut State, ui: &mut Ui) {
    heading(ui, "Picture");
    let form = &mut state.save;
    size(&mut form.picture, ui);
    path_line(&mut form.picture_out, ui);
    let ready = !form.picture_out.trim().is_empty();
    if ui.add_enabled(ready, Button::new("Save picture")).clicked() {
        let out = PathBuf::from(form.picture_out.trim()).with_extension("png");
        let options = PictureFile {
            out: out.clone(),
            replace: false,
            ..form.picture.clone()
        };
        let replacing = PictureFile {
            replace: true,
            ..options.clone()
        };
        let exists = out.exists();
        ask(
            state,
            out,
            exists,
            Command::SavePicture(options),
            Command::SavePicture(replacing),
        );
    }
}

fn size(picture: &mut PictureFile, ui: &mut Ui) {
    ui.horizontal(|ui| {
        ui.add(
            DragValue::new(&mut picture.size[0])
                .range(1..=LARGEST)
                .speed(8),
        );
        ui.label("×");
        ui.add(
            DragValue::new(&mut picture.size[1])
                .range(1..=LARGEST)
                .speed(8),
        );
        ui.label("pixels");
    });
    // Wrapped: what is too wide widens all that comes after it.
    ui.horizontal_wrapped(|ui| {
        ui.label("smoothness").on_hover_text("Samples of a pixel");
        for samples in [4, 16, 64] {
            ui.selectable_value(&mut picture.samples, samples, samples.to_string());
        }
        ui.checkbox(&mut picture.transparent, "no background");
    });
}

/// From when to when a recording goes on.
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
        ui.checkbox(&mut form.over_time, "time goes on")
            .on_hover_text(
                "The report's time runs through the film; with fewer than two views, from here",
            );
        if form.over_time {
            let [from, to] = form.time;
            ui.add(
                DragValue::new(&mut form.time[0])
                    .range(start..=to)
                    .speed(axis.step),
            );
            ui.label("–");
            ui.add(
                DragValue::new(&mut form.time[1])
                    .range(from..=end)
                    .speed(axis.step)
                    .suffix(" ms"),
            );
        }
    });
}

fn film(state: &mut State, ui: &mut Ui) {
    heading(ui, "Film");
    if state.key_views.is_empty() {
        ui.weak("Keep a few views (K); the film goes from one to the next.");
    }
    for (index, view) in state.key_views.clone().into_iter().enumerate() {
        ui.horizontal(|ui| {
            if ui
                .button(format!("View {}", index + 1))
                .on_hover_text("Go there")
                .clicked()
            {
                state.asked.push(Command::Go(view));
            }
            if ui.small_button("×").on_hover_text("Forget it").clicked() {
                state.asked.push(Command::DropKeyView(index));
            }
        });
    }
    if ui.button("Keep this view").clicked() {
        state.asked.push(Command::AddKeyView);
    }
    let keys = state.key_views.len();
    film_time(state, ui);
    let over_time = state.save.over_time && state.playback.facts.is_some();
    if keys < 2 && !over_time {
        return;
    }
    let form = &mut state.save;
    ui.horizontal(|ui| {
        ui.add(DragValue::new(&mut form.frames).range(1..=3000));
        ui.label(match keys {
            0 | 1 => "pictures",
            _ => "pictures from view to view",
        });
    });
    let all = length(keys, form.frames, over_time);
    ui.weak(format!(
        "{all} pictures, {:.1} s at 30 a second",
        all as f64 / 30.0
    ));
    let ffmpeg = *form.ffmpeg.get_or_insert_with(has_ffmpeg);
    ui.add_enabled_ui(ffmpeg, |ui| {
        ui.checkbox(&mut form.video, "also a video (MP4)")
            .on_disabled_hover_text("ffmpeg is not installed");
    });
    path_line(&mut form.film_out, ui);
    ui.label(
        RichText::new("Size and smoothness are the picture's.")
            .weak()
            .small(),
    );
    if ui.button("Save film").clicked() {
        let out = PathBuf::from(form.film_out.trim()).with_extension("png");
        let stem = out
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let first = out.with_file_name(format!("{stem}_0000.png"));
        let film = |replace| {
            Command::SaveFilm(FilmOptions {
                picture: PictureFile {
                    out: out.clone(),
                    replace,
                    ..form.picture.clone()
                },
                frames: form.frames,
                time: over_time.then_some(form.time),
                video: form.video && ffmpeg,
            })
        };
        let (command, replacing) = (film(false), film(true));
        let exists = first.exists();
        ask(state, first, exists, command, replacing);
    }
}
