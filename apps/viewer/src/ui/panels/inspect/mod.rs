//! Morphometrics of the selection.

pub(crate) mod crossings;
mod dimension_list;
mod measures;
mod place;

use eframe::egui::{self, RichText};
use neurotess::morphology::{Measures, NeuriteKind};

use crate::model::command::{Command, Edit};
use crate::model::sources::Source;
use crate::model::state::{CellPart, State};
use crate::ui::panels::cells::{count, kind_name};
use crate::ui::panels::look::markers;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::panels::{figures, grouped, heading, measured};

pub(crate) fn show(state: &mut State, ui: &mut egui::Ui) {
    dimension_list::show(state, ui);
    markers::picked(state, ui);
    let selected = state.document.neurons.selected();
    match (selected.len(), selected.only()) {
        (0, _) => {
            ui.weak(
                "Nothing is selected. Click a neuron in the picture or in the list; Shift + click selects several.",
            );
            ui.add_space(6.0);
            all(state, ui);
        }
        (_, Some(one)) => {
            let name = state.document.neurons[one].name.clone();
            ui.label(RichText::new(name).size(16.0).strong());
            if let Some(source) = state.source_of(one) {
                ui.weak(source.file.display().to_string());
            }
            buttons(state, ui);
            place::show(state, ui);
            measures::show(state, ui);
            crossings::show(state, ui);
            part(state, one, ui);
            if let Some(source) = state.source_of(one) {
                cell(source, ui);
            }
        }
        (many, None) => {
            ui.label(RichText::new(count(many, "neuron")).size(16.0).strong());
            buttons(state, ui);
            place::show(state, ui);
            measures::show(state, ui);
            crossings::show(state, ui);
            sums(state, ui);
        }
    }
}

fn buttons(state: &mut State, ui: &mut egui::Ui) {
    ui.horizontal_wrapped(|ui| {
        for (title, command, says) in [
            (
                "Focus",
                Command::Focus,
                "Zoom to the selection (F or double click)",
            ),
            ("Hide", Edit::Hide.into(), "Hide the selection (H)"),
            ("Isolate", Edit::Isolate.into(), "Hide everything else (I)"),
            (
                "Show all",
                Edit::ShowAll.into(),
                "Show all that is hidden (Ctrl H)",
            ),
        ] {
            if ui.button(title).tip(says).clicked() {
                state.requests.push(command);
            }
        }
    });
}

/// The part of the cell that was clicked.
fn part(state: &State, neuron: usize, ui: &mut egui::Ui) {
    let Some(picked) = state.pointing.picked.filter(|p| p.neuron == neuron) else {
        return;
    };
    let Some(source) = state.source_of(neuron) else {
        return;
    };
    let morphology = &source.morphology;
    match picked.part {
        CellPart::Soma => soma(source, ui),
        CellPart::Section(section) => {
            let Some(facts) = source.sections.get(section as usize) else {
                return;
            };
            let points = morphology.sections[section as usize].range();
            let radii = morphology.points[points.clone()]
                .iter()
                .map(|p| f64::from(p.radius));
            let mean = radii.sum::<f64>() / points.len().max(1) as f64;
            heading(ui, &format!("Section {section}"));
            figures(
                ui,
                "section",
                &[
                    ("kind", kind_name(morphology, section as usize)),
                    ("neurite", (facts.neurite + 1).to_string()),
                    ("branch order", facts.order.to_string()),
                    ("length", measured(facts.length, "µm")),
                    ("path from the soma", measured(facts.path, "µm")),
                    ("mean radius", measured(mean, "µm")),
                    ("points", points.len().to_string()),
                ],
            );
        }
        CellPart::Neurite(neurite) => {
            let of = || source.sections.iter().filter(|f| f.neurite == neurite);
            let length: f64 = of().map(|f| f.length).sum();
            let longest = of().map(|f| f.path).fold(0.0, f64::max);
            heading(ui, &format!("Neurite {}", neurite + 1));
            figures(
                ui,
                "neurite",
                &[
                    ("length", measured(length, "µm")),
                    ("sections", of().count().to_string()),
                    (
                        "max. branch order",
                        of().map(|f| f.order).max().unwrap_or(0).to_string(),
                    ),
                    ("longest path", measured(longest, "µm")),
                ],
            );
        }
    }
}

/// The generated soma; the traced one is below, with the cell's figures.
fn soma(source: &Source, ui: &mut egui::Ui) {
    heading(ui, "Soma");
    let generated = &source.generated;
    let stems = generated.rings.len();
    let Some(first) = generated.somata.first() else {
        ui.weak("Not meshed: the method is \"none\", see Soma.");
        return;
    };
    let somata = || generated.somata.iter();
    let volume: f64 = somata().map(|s| s.volume).sum();
    let mut rows = vec![
        ("neurites that leave it", stems.to_string()),
        ("volume of the mesh", measured(volume, "µm³")),
        (
            "area of the mesh",
            measured(somata().map(|s| s.area).sum(), "µm²"),
        ),
        ("traced volume", measured(first.traced_volume, "µm³")),
        ("samples", samples(source).to_string()),
    ];
    if generated.somata.len() > 1 {
        rows.insert(0, ("somata", generated.somata.len().to_string()));
    }
    figures(ui, "rebuilt soma", &rows);
}

/// Traced samples of all somata.
fn samples(source: &Source) -> usize {
    let somata = source.morphology.somata.iter();
    somata.map(|soma| soma.samples.len()).sum()
}

fn cell(source: &Source, ui: &mut egui::Ui) {
    let m: &Measures = &source.measures;
    heading(ui, "Tracing");
    let mut rows = vec![
        ("length", measured(m.length, "µm")),
        ("area", measured(m.area, "µm²")),
        ("volume", measured(m.volume, "µm³")),
        ("neurites", m.n_neurites.to_string()),
        ("sections", grouped(m.n_sections as u64)),
        (
            "forks",
            grouped((m.n_bifurcations + m.n_multifurcations) as u64),
        ),
        ("ends", grouped(m.n_ends as u64)),
        ("max. branch order", m.max_branch_order.to_string()),
        ("points", grouped(m.n_points as u64)),
    ];
    if let Some(bounds) = m.bbox {
        let side = |k: usize| bounds.max[k] - bounds.min[k];
        rows.push((
            "bounding box",
            format!("{:.0} × {:.0} × {:.0} µm", side(0), side(1), side(2)),
        ));
    }
    figures(ui, "tracing", &rows);
    by_type(m, ui);
    if m.soma.kind != "none" {
        heading(ui, "Soma, as traced");
        figures(
            ui,
            "soma",
            &[
                ("kind", m.soma.kind.replace('_', " ")),
                ("radius", measured(m.soma.radius, "µm")),
                ("area", measured(m.soma.area, "µm²")),
                ("volume", measured(m.soma.volume, "µm³")),
            ],
        );
    }
    let mesh = &source.generated.mesh;
    heading(ui, "Coarse mesh");
    figures(
        ui,
        "mesh",
        &[
            ("patches", grouped(mesh.patches.len() as u64)),
            ("vertices", grouped(mesh.vertices.len() as u64)),
        ],
    );
    if !source.warnings.is_empty() {
        heading(ui, "Notes on the tracing and its mesh");
        // Warnings that the user should look into come first.
        for concerns in [true, false] {
            for note in source.warnings.iter().filter(|w| w.concerns == concerns) {
                let text = RichText::new(format!("• {}", note.text)).small();
                let warn = ui.visuals().warn_fg_color;
                ui.label(if concerns { text.color(warn) } else { text });
            }
        }
    }
}

fn by_type(m: &Measures, ui: &mut egui::Ui) {
    let l = m.length_by_type;
    let rows: Vec<(&str, String)> = [
        ("axon", l.axon),
        ("basal dendrite", l.basal_dendrite),
        ("apical dendrite", l.apical_dendrite),
        ("other", l.other),
    ]
    .into_iter()
    .filter(|(_, length)| *length > 0.0)
    .map(|(name, length)| (name, measured(length, "µm")))
    .collect();
    if rows.len() > 1 {
        heading(ui, "Length by type");
        figures(ui, "by type", &rows);
    }
}

/// Sums over the selected neurons, or over all.
fn sums(state: &State, ui: &mut egui::Ui) {
    let sums = state.totals();
    heading(ui, "Totals");
    figures(
        ui,
        "sums",
        &[
            ("length", measured(sums.length, "µm")),
            ("area", measured(sums.area, "µm²")),
            ("volume", measured(sums.volume, "µm³")),
            ("neurites", grouped(sums.neurites as u64)),
            ("sections", grouped(sums.sections as u64)),
            ("ends", grouped(sums.ends as u64)),
            ("points", grouped(sums.points as u64)),
        ],
    );
}

fn all(state: &mut State, ui: &mut egui::Ui) {
    let neurons = state.document.neurons.len();
    if neurons == 1 {
        measures::show(state, ui);
        crossings::show(state, ui);
        if let Some(source) = state.source_of(0) {
            cell(source, ui);
        }
    } else {
        sums(state, ui);
    }
    let kinds = state.kinds();
    if kinds.len() > 1 && neurons > 1 {
        let names: Vec<String> = kinds
            .iter()
            .map(|&k| NeuriteKind(k).name().replace('_', " "))
            .collect();
        ui.add_space(4.0);
        ui.weak(format!("Types: {}", names.join(", ")));
    }
}
