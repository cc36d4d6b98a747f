//! Synapses and points: which are shown, and how.

use eframe::egui::{self, ComboBox, RichText, Ui};
use neurotess::circuit::SynapseSide;
use neurotess::render::MarkerShape;

use super::partners;
use crate::model::command::{Command, Edit, FilePurpose};
use crate::model::document::{Look, MarkerOptions};
use crate::model::state::State;
use crate::ui::panels::widgets::color_map;
use crate::ui::panels::widgets::number::slider;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::panels::{figures, grouped, heading};

/// The section of *Look*. `look`: to choose the color map in, unless that is done elsewhere; `released`: whether
/// a mouse button was released.
pub(crate) fn show(state: &mut State, look: Option<&mut Look>, released: bool, ui: &mut Ui) {
    let edges = state.edge_names();
    let mut options = state.document.markers.clone();
    heading(ui, "Synapses and points");
    if !edges.is_empty() || options.synapses {
        let tip = "Where the circuit's edges say that synapses are (X)";
        ui.checkbox(&mut options.synapses, "Synapses").tip(tip);
    }
    if options.synapses {
        synapses(state, &edges, &mut options, ui);
    }
    points(state, &mut options, ui);
    let numbers = options.synapses && options.property.is_some();
    let columns = options.points.is_some() && options.column.is_some();
    if let Some(look) = look.filter(|_| numbers || columns) {
        ui.horizontal(|ui| {
            ui.label("color map");
            color_map::show(look, ui);
        });
    }
    if options.any() {
        shapes(&mut options, ui);
        slider(ui, &mut options.size, 0.1..=20.0, Some(1), |slider| {
            slider.text("size (µm)").logarithmic(true)
        })
        .tip("Diameter; from afar they are at least 3 pixels wide");
    }
    if let Some([drawn, in_view, all]) = state.drawing.counters.markers {
        let [drawn, in_view, all] = [drawn, in_view, all].map(|n| grouped(n as u64));
        let text = match drawn == in_view {
            true => format!("{drawn} of {all} in view"),
            false => format!("{drawn} drawn of {in_view} in view, {all} in all"),
        };
        ui.weak(text).tip(
            "Where more are in view than pixels or a frame can show, they are left out evenly",
        );
    }
    for why in state.marker_data.failures().into_iter().flatten() {
        let color = ui.visuals().warn_fg_color;
        ui.label(RichText::new(why).color(color).small());
    }
    if options != state.document.markers {
        state
            .requests
            .push(Edit::SetMarkers(Box::new(options)).into());
    } else if released {
        state.history.end_joining();
    }
}

/// What each is drawn as.
fn shapes(options: &mut MarkerOptions, ui: &mut Ui) {
    let mut all = vec![
        (
            MarkerShape::Point,
            "Points",
            "Dots of 3 pixels, however near they are",
        ),
        (MarkerShape::Sphere, "Spheres", "Spheres of the size below"),
    ];
    // Points of a table lie on no membrane.
    if options.synapses {
        let tip = "Spheres of the size below, each on a flat disc that lies on the membrane";
        all.push((MarkerShape::Contact, "Contact discs", tip));
    }
    ui.horizontal_wrapped(|ui| {
        ui.label("as");
        for (shape, name, tip) in all {
            ui.selectable_value(&mut options.shape, shape, name)
                .tip(tip);
        }
    });
}

fn synapses(state: &State, edges: &[String], options: &mut MarkerOptions, ui: &mut Ui) {
    ui.indent("synapses", |ui| {
        if edges.len() > 1 {
            populations(edges, options, ui);
        }
        ui.horizontal_wrapped(|ui| {
            for (side, name, tip) in [
                (
                    SynapseSide::Afferent,
                    "Inputs",
                    "Afferent: on the cells that they are inputs of",
                ),
                (
                    SynapseSide::Efferent,
                    "Outputs",
                    "Efferent: on the cells that they are outputs of",
                ),
            ] {
                ui.selectable_value(&mut options.side, side, name).tip(tip);
            }
        });
        let properties = state.marker_data.properties();
        colored_by("synapses", "edges", &properties, &mut options.property, ui);
        ui.checkbox(&mut options.of_selected, "only of selected cells")
            .tip("While nothing is selected, those of all cells that are shown");
    });
}

/// Populations of edges: all, or some of them.
fn populations(edges: &[String], options: &mut MarkerOptions, ui: &mut Ui) {
    for name in edges {
        let all = options.edges.is_empty();
        let mut shown = all || options.edges.contains(name);
        let before = shown;
        ui.checkbox(&mut shown, name);
        if shown == before {
            continue;
        }
        let is = |other: &String| match other == name {
            true => shown,
            false => all || options.edges.contains(other),
        };
        let left: Vec<String> = edges.iter().filter(|e| is(e)).cloned().collect();
        match left.len() {
            // Without any, synapses are switched off.
            0 => options.synapses = false,
            n if n == edges.len() => options.edges.clear(),
            _ => options.edges = left,
        }
    }
}

fn points(state: &mut State, options: &mut MarkerOptions, ui: &mut Ui) {
    let stem = options.points.as_ref().map(|file| {
        let name = file.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    });
    ui.horizontal_wrapped(|ui| {
        let title = if stem.is_some() { "Other points…" } else { "Points of a table…" };
        let tip = "CSV or TSV with columns x, y and z (µm), in the circuit's or the tracing's coordinates";
        if ui.button(title).tip(tip).clicked() {
            state.requests.push(Command::AskFiles(FilePurpose::Points));
        }
        if stem.is_some() && ui.button("Close").tip("Show no points").clicked() {
            state.requests.push(Edit::SetPoints(None).into());
        }
    });
    let Some(stem) = stem else {
        return;
    };
    ui.indent("points", |ui| {
        ui.label(stem);
        if !state.shows_points() {
            ui.weak("Not shown while cells are side by side (G)");
        }
        let table = state.marker_data.points().map(|(_, table)| table);
        let columns = table.into_iter().flat_map(|table| &table.columns);
        let columns: Vec<String> = columns.map(|(name, _)| name.clone()).collect();
        colored_by("points", "one color", &columns, &mut options.column, ui);
    });
}

/// A number that colors tell, or none.
fn colored_by(id: &str, none: &str, names: &[String], chosen: &mut Option<String>, ui: &mut Ui) {
    if names.is_empty() && chosen.is_none() {
        return;
    }
    ui.horizontal(|ui| {
        ui.label("color by");
        let shown = chosen.clone().unwrap_or_else(|| none.to_owned());
        ComboBox::from_id_salt((id, "color by"))
            .selected_text(shown)
            .show_ui(ui, |ui| {
                ui.selectable_value(chosen, None, none);
                for name in names {
                    ui.selectable_value(chosen, Some(name.clone()), name);
                }
            });
    });
}

/// The synapse or point that was clicked, in *Inspect*.
pub(crate) fn picked(state: &mut State, ui: &mut Ui) {
    let Some(marker) = state.pointing.picked_marker else {
        return;
    };
    let Some(facts) = state.marker_facts(marker) else {
        return;
    };
    heading(ui, &facts.title);
    figures(ui, "marker", &facts.rows);
    partners::figures(state, ui);
    let titles = ["Select its cell", "Select the other cell"];
    ui.horizontal_wrapped(|ui| {
        for (title, neuron) in titles.into_iter().zip(facts.neurons) {
            let Some(neuron) = neuron else { continue };
            let name = &state.document.neurons[neuron].name;
            if ui.button(title).tip(name.clone()).clicked() {
                let select = Edit::Select(vec![neuron], false);
                state.requests.push(select.into());
            }
        }
    });
    ui.add_space(4.0);
    ui.add(egui::Separator::default());
}
