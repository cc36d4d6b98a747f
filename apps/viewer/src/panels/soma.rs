//! The soma editor: the surface follows while a slider is dragged.

use eframe::egui::{Button, Slider, Ui};

use super::{figures, heading, measured, rings};
use crate::command::Command;
use crate::document::{Method, SomaEdit, SourceId};
use crate::state::State;

pub(super) fn show(state: &mut State, ui: &mut Ui) {
    let mut sources = state.document.selected_sources();
    let every = state.document.neurons.len();
    if sources.is_empty() {
        sources = state.document.neurons.iter().map(|n| n.source).collect();
        sources.sort_unstable();
        sources.dedup();
        if every > 1 {
            ui.weak("Nothing is selected: changes concern all somata.");
        }
    } else if sources.len() > 1 {
        ui.weak(format!("Changes concern {} somata.", sources.len()));
    }
    let Some(&first) = sources.first() else {
        return;
    };
    let mut edit = state.document.soma(first);
    let before = edit.clone();
    heading(ui, "Method");
    ui.horizontal_wrapped(|ui| {
        for (method, name, says) in METHODS {
            ui.selectable_value(&mut edit.method, method, name)
                .on_hover_text(says);
        }
    });
    let mut dropped = false;
    if edit.method == Method::Elastic {
        heading(ui, "Material");
        let says = "Poisson's ratio ν of the soma's material: how much it thins where it is pulled.\n\
                    0: not at all; near 0.5: its volume stays.";
        dropped |= number(
            ui,
            "Poisson's ratio",
            &mut edit.poisson,
            0.0..=0.49,
            "",
            0.3,
            says,
        );
    }
    if edit.method != Method::None {
        heading(ui, "Size");
        let says = "Factor on the radius that was traced.";
        dropped |= number(
            ui,
            "Radius factor",
            &mut edit.scale,
            0.3..=3.0,
            "×",
            1.0,
            says,
        );
        reference(&mut edit, ui);
    }
    ui.add_space(6.0);
    let usual = SomaEdit {
        rings: edit.rings.clone(),
        ..SomaEdit::default()
    };
    if ui
        .add_enabled(edit != usual, Button::new("As usual"))
        .on_hover_text("Reset these values")
        .clicked()
    {
        edit = usual;
    }
    if edit != before {
        state
            .asked
            .push(Command::SetSoma(sources.clone(), edit.clone()));
    } else if dropped {
        state.history.end_joining();
    }
    if edit.places_rings() {
        match sources.len() {
            1 => rings::show(state, first, ui),
            _ => {
                heading(ui, "First rings");
                ui.weak("Select one neuron to place the first rings of its neurites.");
            }
        }
    }
    measures(state, first, &edit, ui);
}

const METHODS: [(Method, &str, &str); 4] = [
    (
        Method::Elastic,
        "Elastic",
        "A sphere that the neurites pull out, by linear elasticity (García-Cantero et al. 2017)",
    ),
    (
        Method::Sphere,
        "Sphere",
        "The sphere as it is; neurites grow out of it",
    ),
    (
        Method::Profile,
        "Profile",
        "LiveMesh's radius function: round near the centre, a tube far out",
    ),
    (
        Method::None,
        "None",
        "No soma: every neurite is closed by itself",
    ),
];

/// A slider with a value to type and a button that resets it; whether it was let go.
fn number(
    ui: &mut Ui,
    name: &str,
    value: &mut f64,
    range: std::ops::RangeInclusive<f64>,
    unit: &str,
    usual: f64,
    says: &str,
) -> bool {
    ui.label(name).on_hover_text(says);
    ui.horizontal(|ui| {
        let slider = Slider::new(value, range).suffix(unit).fixed_decimals(2);
        let response = ui.add(slider).on_hover_text(says);
        let reset = Button::new("reset").small();
        if ui
            .add_enabled(*value != usual, reset)
            .on_hover_text(format!("Back to {usual}"))
            .clicked()
        {
            *value = usual;
        }
        response.drag_stopped() || response.lost_focus()
    })
    .inner
}

fn reference(edit: &mut SomaEdit, ui: &mut Ui) {
    heading(ui, "Reference sphere");
    ui.horizontal(|ui| {
        let changed = ui
            .selectable_value(&mut edit.octahedron, false, "Cube")
            .clicked()
            | ui.selectable_value(&mut edit.octahedron, true, "Octahedron")
                .on_hover_text("The paper's")
                .clicked();
        if changed {
            edit.level = 0;
        }
    });
    let (low, high) = edit.levels();
    let mut fits = edit.level == 0;
    ui.checkbox(&mut fits, "Resolution that fits the neurites");
    if fits {
        edit.level = 0;
    } else {
        edit.level = edit.level.clamp(low, high);
        ui.add(Slider::new(&mut edit.level, low..=high).text("resolution"));
    }
}

fn measures(state: &State, source: SourceId, edit: &SomaEdit, ui: &mut Ui) {
    let Some(source) = state.sources.get(source) else {
        return;
    };
    ui.add_space(4.0);
    ui.separator();
    if source.soma != *edit {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.weak("working…");
        });
    }
    let Some(soma) = source.generated.somata.first() else {
        ui.weak("This cell has no soma, or its method makes none.");
        return;
    };
    heading(ui, &format!("Soma of {}", source.name));
    let change = |value: f64, sphere: f64| 100.0 * (value / sphere - 1.0);
    figures(
        ui,
        "soma figures",
        &[
            ("volume", measured(soma.volume, "µm³")),
            (
                "against the sphere",
                format!("{:+.1} %", change(soma.volume, soma.sphere_volume)),
            ),
            ("area", measured(soma.area, "µm²")),
            (
                "against the sphere ",
                format!("{:+.1} %", change(soma.area, soma.sphere_area)),
            ),
            (
                "solved in",
                format!("{:.1} ms", 1e3 * source.generated.soma_seconds),
            ),
        ],
    );
}
