//! Colors, light, and which parts of cells are shown.

pub(crate) mod markers;
mod meshes;
mod own_colors;
pub(crate) mod partners;
mod saved_views;

use eframe::egui::{self, ComboBox, Ui};
use neurotess::render::color::Palette;

use crate::ui::panels::heading;
use crate::ui::panels::widgets::color_map;
use crate::ui::panels::widgets::number::{field, slider};
use crate::ui::panels::widgets::tip::Tip;

use crate::model::command::{Command, Edit, FilePurpose};
use crate::model::document::{ColorBy, Cut, Lighting, Look, PAPER, VisibleParts};
use crate::model::state::State;
use crate::scene::stage::Stage;

pub(crate) fn show(state: &mut State, stage: &Stage, ui: &mut Ui) {
    let mut look = state.document.look.clone();
    let released = ui.input(|i| i.pointer.any_released());
    if ui.input(|i| i.pointer.any_pressed()) {
        // Two clicks are two edits, also if each changes something as it is released.
        state.history.end_joining();
    }
    colors(state, &mut look, stage.legend().is_bar(), ui);
    own_colors::show(&mut look, stage, ui);
    // Otherwise the map is chosen above.
    let mapped = maps_cells(&look, stage.legend().is_bar());
    markers::show(state, (!mapped).then_some(&mut look), released, ui);
    meshes::show(state, released, ui);
    heading(ui, "Shown");
    ui.horizontal_wrapped(|ui| {
        ui.selectable_value(&mut look.parts, VisibleParts::All, "All");
        ui.selectable_value(&mut look.parts, VisibleParts::Soma, "Somata only");
        ui.selectable_value(&mut look.parts, VisibleParts::Neurites, "Neurites only");
    });
    ui.checkbox(&mut look.legend, "Legend");
    ui.checkbox(&mut look.scale_bar, "Scale bar");
    ui.checkbox(&mut look.axes, "Axes");
    ui.checkbox(&mut look.wireframe, "Wireframe")
        .tip("The edges of the triangles");
    let usual = look.least_width_of(state.shown());
    let mut width = usual;
    slider(ui, &mut width, 0.0..=8.0, Some(1), |slider| {
        slider.text("least width (px)")
    })
    .tip(
        "Thin neurites are drawn this wide, so that they can be seen; 0: as wide as they are, as more than 50 neurons are \
         by themselves",
    );
    if width != usual {
        look.least_width = Some(width);
    }
    slider(
        ui,
        &mut look.radius_factor,
        0.1..=100.0,
        Some(1),
        |slider| slider.logarithmic(true).text("radius factor"),
    )
    .tip("Neurites are drawn with their radii times this, for figures; meshes are saved as traced");
    let tip = "Show everything as it was traced: all parts, no cut, no factor, the usual least width; colors and light stay";
    if ui.button("Reset look").tip(tip).clicked() {
        state.requests.push(Edit::ResetLook.into());
    }
    saved_views::show(state, ui);
    heading(ui, "Selection");
    ui.checkbox(&mut look.highlight_selected, "Color of its own");
    ui.checkbox(&mut look.ghost_others, "Fade the others");
    if look.ghost_others {
        slider(ui, &mut look.ghost_opacity, 0.02..=0.9, Some(2), |slider| {
            slider.text("opacity")
        });
    }
    light(&mut look, ui);
    cut(&mut look, ui);
    heading(ui, "Window theme");
    let mut dark = state.settings.dark;
    ui.horizontal(|ui| {
        ui.selectable_value(&mut dark, true, "Dark");
        ui.selectable_value(&mut dark, false, "Light");
    });
    if dark != state.settings.dark {
        state.requests.push(Command::SetDark(dark));
    }
    let before = state.document.look.color_by;
    let chosen_now = look.color_by == ColorBy::Value && before != ColorBy::Value;
    if chosen_now && state.document.report.is_none() {
        look.color_by = before;
        state.requests.push(match state.circuits.reports().pop() {
            Some((_, file)) => Edit::SetReport(Some(file)).into(),
            None => Command::AskFiles(FilePurpose::Report),
        });
    }
    if look != state.document.look {
        state.requests.push(Edit::SetLook(Box::new(look)).into());
    } else if released {
        state.history.end_joining();
    }
}

/// `bar`: whether the legend is a scale of numbers.
fn colors(state: &mut State, look: &mut Look, bar: bool, ui: &mut Ui) {
    heading(ui, "Colors");
    egui::Grid::new("colors").num_columns(2).show(ui, |ui| {
        ui.label("color by");
        let name = ColorBy::ALL
            .iter()
            .find(|(by, _)| *by == look.color_by)
            .map_or("", |(_, n)| n);
        ComboBox::from_id_salt("color by")
            .selected_text(name)
            .show_ui(ui, |ui| {
                let circuits = state.circuits.iter().next().is_some();
                for (by, name) in ColorBy::ALL {
                    // Tracings without a circuit have neither attributes nor values.
                    if circuits || by.is_of_tracings() || by == look.color_by {
                        ui.selectable_value(&mut look.color_by, by, name);
                    }
                }
            });
        ui.end_row();
        match look.color_by {
            ColorBy::Attribute => attribute(state, look, ui),
            ColorBy::Value => report(state, ui),
            // Choosing one colors by its values.
            _ if !state.circuits.reports().is_empty() => report(state, ui),
            _ => {}
        }
        if maps_cells(look, bar) {
            range(state, look, ui);
            ui.label("color map");
            color_map::show(look, ui);
            ui.end_row();
            ui.label("");
            ui.checkbox(&mut look.trim_map, "without its faint end")
                .tip(
                    "Leaves out the end of the map that is as light or as dark as the background. \
                 Otherwise those colors have edges.",
                );
        } else {
            ui.label("palette");
            ComboBox::from_id_salt("palette")
                .selected_text(look.palette.name())
                .show_ui(ui, |ui| {
                    for palette in Palette::ALL {
                        ui.selectable_value(&mut look.palette, palette, palette.name());
                    }
                });
            ui.end_row();
            ui.label("");
            ui.horizontal(|ui| {
                let tip = "A palette's file holds the colors that you choose below, for the window, \
                           neurotess render and Python";
                for (name, purpose) in [
                    ("Open…", FilePurpose::OpenPalette),
                    ("Save…", FilePurpose::SavePalette),
                ] {
                    if ui.button(name).tip(tip).clicked() {
                        state.requests.push(Command::AskFiles(purpose));
                    }
                }
            });
        }
        ui.end_row();
        ui.label("background");
        ui.horizontal(|ui| {
            ui.color_edit_button_srgb(&mut look.background);
            for (name, color) in [
                ("paper", PAPER),
                ("white", [255; 3]),
                ("slate", [40, 44, 50]),
                ("black", [0; 3]),
            ] {
                ui.selectable_value(&mut look.background, color, name);
            }
        });
        ui.end_row();
    });
}

/// Whether cells have colors of a color map. `bar`: whether the legend is a scale of numbers.
fn maps_cells(look: &Look, bar: bool) -> bool {
    // Numbers of an attribute are on a scale if there are many.
    look.color_by.is_number() || (look.color_by == ColorBy::Attribute && bar)
}

/// Attributes of the circuits' cells.
fn attribute(state: &State, look: &mut Look, ui: &mut Ui) {
    let names = state.circuits.attributes();
    let chosen_now = state.document.look.color_by != ColorBy::Attribute;
    if chosen_now && !names.contains(&look.attribute) {
        let usual = ["layer", "mtype", "model_name", "population"];
        let first = usual
            .into_iter()
            .find(|&n| names.iter().any(|own| own == n));
        let first = first.map(str::to_owned).or_else(|| names.first().cloned());
        look.attribute = first.unwrap_or_default();
    }
    ui.label("attribute");
    ComboBox::from_id_salt("attribute")
        .selected_text(&look.attribute)
        .show_ui(ui, |ui| {
            for name in names {
                ui.selectable_value(&mut look.attribute, name.clone(), name);
            }
        });
    ui.end_row();
}

/// Selects a report: one that circuits name, or another file.
fn report(state: &mut State, ui: &mut Ui) {
    let reports = state.circuits.reports();
    let shown = state.document.report.clone();
    let stem = |file: &std::path::Path| {
        let stem = file.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    };
    ui.label("report");
    ComboBox::from_id_salt("report")
        .selected_text(shown.as_deref().map_or("choose…".into(), stem))
        .show_ui(ui, |ui| {
            for (name, file) in reports {
                let chosen = shown.as_ref() == Some(&file);
                let line = ui.selectable_label(chosen, name);
                if line.tip(file.display().to_string()).clicked() {
                    state.requests.push(Edit::SetReport(Some(file)).into());
                }
            }
            if ui.selectable_label(false, "another file…").clicked() {
                state.requests.push(Command::AskFiles(FilePurpose::Report));
            }
        });
    ui.end_row();
}

/// Numbers at both ends of the color map.
fn range(state: &State, look: &mut Look, ui: &mut Ui) {
    ui.label("range")
        .tip("The values at the two ends of the color map");
    ui.horizontal(|ui| {
        let facts = state.playback.facts.as_ref();
        let fitting = facts.filter(|_| look.color_by == ColorBy::Value);
        let mut fixed = look.range.is_some();
        ui.checkbox(&mut fixed, "fixed")
            .tip("Otherwise from the smallest to the largest value");
        if fixed != look.range.is_some() {
            let fit = fitting.map_or([0.0, 100.0], |facts| facts.range);
            look.range = fixed.then_some(fit);
        }
        if let Some([low, high]) = &mut look.range {
            let speed = 0.005 * (*high - *low).abs().max(1e-3);
            let any = f32::MIN..=f32::MAX;
            let digits = (2.0 - speed.log10()).clamp(2.0, 12.0) as usize;
            field(ui, low, any.clone(), digits, |field| field.speed(speed));
            ui.label("–");
            field(ui, high, any, digits, |field| field.speed(speed));
        } else if let Some([low, high]) = fitting.map(|facts| facts.range) {
            ui.weak(format!("{low:.1} – {high:.1}"));
        }
    });
    ui.end_row();
    if look.color_by == ColorBy::Value && state.playback.facts.as_ref().is_some_and(|f| f.spikes) {
        ui.label("spikes fade in");
        let decay = field(ui, &mut look.decay, 0.1..=1000.0, 2, |field| {
            field.speed(0.1).suffix(" ms")
        });
        decay.tip("After this time the flash of a spike has a third of its brightness");
        ui.end_row();
    }
}

fn light(look: &mut Look, ui: &mut Ui) {
    heading(ui, "Light");
    ui.horizontal(|ui| {
        if ui
            .selectable_label(look.light == Lighting::Soft, "Soft")
            .clicked()
        {
            look.light = Lighting::Soft;
        }
        let from = matches!(look.light, Lighting::From { .. });
        if ui.selectable_label(from, "Directional").clicked() && !from {
            look.light = Lighting::From {
                right: -35.0,
                up: 40.0,
            };
        }
        if ui
            .selectable_label(look.light == Lighting::Flat, "Off")
            .tip("Plain colors without shading")
            .clicked()
        {
            look.light = Lighting::Flat;
        }
    });
    if let Lighting::From { right, up } = &mut look.light {
        slider(ui, right, -180.0..=180.0, Some(0), |slider| {
            slider.text("from the right").suffix("°")
        });
        slider(ui, up, -90.0..=90.0, Some(0), |slider| {
            slider.text("from above").suffix("°")
        });
    }
    ui.checkbox(&mut look.occlusion, "Ambient occlusion")
        .tip("Darkens gaps and creases");
}

fn cut(look: &mut Look, ui: &mut Ui) {
    heading(ui, "Cutting plane");
    ui.horizontal(|ui| {
        if ui.selectable_label(look.cut.is_none(), "None").clicked() {
            look.cut = None;
        }
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let here = look.cut.is_some_and(|cut| cut.axis == axis);
            if ui
                .selectable_label(here, name)
                .tip("A plane across this axis cuts the front part away")
                .clicked()
            {
                let cut = look.cut.unwrap_or(Cut {
                    axis,
                    place: 0.5,
                    flipped: false,
                });
                look.cut = Some(Cut { axis, ..cut });
            }
        }
        if let Some(cut) = &mut look.cut {
            ui.checkbox(&mut cut.flipped, "keep the other side");
        }
    });
    if let Some(cut) = &mut look.cut {
        slider(ui, &mut cut.place, 0.0..=1.0, Some(2), |slider| {
            slider.text("position")
        });
    }
}
