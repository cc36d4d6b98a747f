//! The soma editor: the surface is updated while a slider is dragged.

mod rings;
mod spines;

use eframe::egui::{Button, Ui};

use crate::model::command::Edit;
use crate::model::document::{Keep, Method, SomaEdit, SourceId};
use crate::model::numbers::change;
use crate::model::state::State;
use crate::ui::panels::widgets::number::slider;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::panels::{figures, heading, measured};

pub(crate) fn show(state: &mut State, ui: &mut Ui) {
    let neurons = &state.document.neurons;
    let sources = neurons.meant_sources();
    if neurons.selected().is_empty() && neurons.len() > 1 {
        ui.weak("No neuron is selected: changes apply to all somata.");
    } else if sources.len() > 1 {
        ui.weak(format!("Changes apply to {} somata.", sources.len()));
    }
    let (count, Some(&first)) = (sources.len(), sources.first()) else {
        return;
    };
    let mut edit = state.document.soma(first);
    let before = edit.clone();
    heading(ui, "Method");
    ui.horizontal_wrapped(|ui| {
        for (method, name, says) in METHODS {
            ui.selectable_value(&mut edit.method, method, name)
                .tip(says);
        }
    });
    let mut dropped = false;
    if edit.method == Method::Elastic {
        heading(ui, "Material");
        let says = "Poisson's ratio ν of the soma: how much it thins where the neurites pull it.\n\
                    0: not at all; close to 0.5: its volume is kept.";
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
        if edit.method == Method::Elastic {
            ui.horizontal_wrapped(|ui| {
                ui.label("As traced");
                for (keep, name, says) in KEEPS {
                    ui.selectable_value(&mut edit.keep, keep, name).tip(says);
                }
            });
        }
        let says = "The soma's traced radius is multiplied by this.";
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
    ui.checkbox(&mut state.layout.traced_somata, "Tracing over the surface")
        .tip("The traced outline in red, or circles around the soma's samples");
    ui.add_space(6.0);
    let usual = SomaEdit {
        rings: edit.rings.clone(),
        spines: edit.spines,
        ..SomaEdit::default()
    };
    if ui
        .add_enabled(edit != usual, Button::new("Reset all"))
        .tip("Method, material, size and mesh at their defaults; first rings stay")
        .clicked()
    {
        edit = usual;
    }
    if edit != before {
        let command = Edit::SetSoma(sources.clone(), edit.clone()).into();
        state.requests.push(command);
    } else if dropped {
        state.history.end_joining();
    }
    if edit.places_rings() {
        match count {
            1 => rings::show(state, first, ui),
            _ => {
                heading(ui, "First rings");
                ui.weak("Select a single neuron to move the first rings of its neurites.");
            }
        }
    }
    spines::show(state, &sources, ui);
    measures(state, first, &edit, ui);
}

const METHODS: [(Method, &str, &str); 4] = [
    (
        Method::Elastic,
        "Elastic",
        "An elastic sphere that the neurites pull into shape (García-Cantero et al. 2017)",
    ),
    (
        Method::Sphere,
        "Sphere",
        "A plain sphere, from whose surface the neurites start",
    ),
    (
        Method::Profile,
        "Profile",
        "Round near the center, passing into the neurites' tubes by the radius function of LiveMesh",
    ),
    (
        Method::None,
        "None",
        "No soma: every neurite is a closed mesh of its own",
    ),
];

const KEEPS: [(Keep, &str, &str); 3] = [
    (
        Keep::Volume,
        "Volume",
        "Drawn out by its neurites, the soma has the volume that was traced",
    ),
    (
        Keep::Area,
        "Area",
        "Drawn out by its neurites, the soma has the area that was traced, as for electrical properties",
    ),
    (
        Keep::Scale,
        "Shape",
        "Neurites draw out what was traced, and volume and area become what they may",
    ),
];

/// A slider with a field for its value and a button that resets it. True if it was released.
fn number(
    ui: &mut Ui,
    name: &str,
    value: &mut f64,
    range: std::ops::RangeInclusive<f64>,
    unit: &str,
    usual: f64,
    says: &str,
) -> bool {
    ui.label(name).tip(says);
    ui.horizontal(|ui| {
        let slider = slider(ui, value, range, Some(2), |slider| slider.suffix(unit));
        let response = slider.tip(says);
        let reset = Button::new("reset").small();
        if ui
            .add_enabled(*value != usual, reset)
            .tip(format!("Reset to {usual}"))
            .clicked()
        {
            *value = usual;
        }
        response.drag_stopped() || response.lost_focus()
    })
    .inner
}

fn reference(edit: &mut SomaEdit, ui: &mut Ui) {
    heading(ui, "Sphere to start from");
    ui.horizontal(|ui| {
        let changed = ui
            .selectable_value(&mut edit.octahedron, false, "Cube")
            .tip("A subdivided cube, blown up to a sphere")
            .clicked()
            | ui.selectable_value(&mut edit.octahedron, true, "Octahedron")
                .tip("A subdivided octahedron, as in García-Cantero et al. 2017")
                .clicked();
        if changed {
            edit.level = 0;
        }
    });
    let (low, high) = edit.levels();
    let mut fits = edit.level == 0;
    ui.checkbox(&mut fits, "Automatic resolution")
        .tip("Fine enough for the neurites that start on it");
    if fits {
        edit.level = 0;
    } else {
        if edit.level == 0 {
            edit.level = low;
        }
        slider(ui, &mut edit.level, low..=high, None, |slider| {
            slider.text("subdivisions")
        });
    }
}

fn measures(state: &State, id: SourceId, edit: &SomaEdit, ui: &mut Ui) {
    let Some(source) = state.sources.get(id) else {
        return;
    };
    ui.add_space(4.0);
    ui.separator();
    let waits = source.spines != state.document.drawn_spines(id);
    if source.soma != *edit || waits {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.weak("updating…");
        });
    }
    let Some(soma) = source.generated.somata.first() else {
        ui.weak("No soma: none was traced, or the method is None.");
        return;
    };
    heading(ui, &format!("Soma of {}", source.name));
    let beside = |value: f64, traced: f64| change(100.0 * (value / traced - 1.0));
    figures(
        ui,
        "soma figures",
        &[
            ("volume", measured(soma.volume, "µm³")),
            ("volume / traced", beside(soma.volume, soma.traced_volume)),
            ("area", measured(soma.area, "µm²")),
            ("area / traced", beside(soma.area, soma.traced_area)),
            (
                "computed in",
                format!("{:.1} ms", 1e3 * source.generated.soma_seconds),
            ),
        ],
    );
}
