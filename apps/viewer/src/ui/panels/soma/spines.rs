//! Spines of the selected cells, below the soma editor.

use eframe::egui::{Button, Ui};

use crate::model::command::Edit;
use crate::model::document::{SourceId, SpineEdit, SpinePlaces};
use crate::model::state::State;
use crate::ui::panels::widgets::number::slider;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::panels::{figures, heading};

/// `sources`: the cells that are edited.
pub(crate) fn show(state: &mut State, sources: &[SourceId], ui: &mut Ui) {
    let Some(&first) = sources.first() else {
        return;
    };
    let before = state.document.soma(first).spines;
    let mut spines = before;
    heading(ui, "Spines");
    let told = state
        .sources
        .get(first)
        .map_or(0, |s| s.traced.spines.len());
    let in_circuit = state.node_of(first).is_some();
    ui.horizontal_wrapped(|ui| {
        let says = "The cell as it was traced";
        ui.selectable_value(&mut spines, None, "None").tip(says);
        for (places, name, says, possible) in [
            (SpinePlaces::Random, "Random", "At random places of basal and apical dendrites", true),
            (SpinePlaces::File, "Of the file", "Where the file (ASC, H5) tells of spines", told > 0),
            (
                SpinePlaces::Synapses,
                "At synapses",
                "Where the cell gets synapses in its circuit, if no other cell in the list shares its tracing",
                in_circuit,
            ),
        ] {
            let chosen = spines.is_some_and(|spines| spines.places == places);
            let button = Button::selectable(chosen, name);
            if ui.add_enabled(possible, button).tip(says).clicked() && !chosen {
                let edit = spines.unwrap_or_default();
                spines = Some(SpineEdit { places, ..edit });
            }
        }
    });
    let mut dropped = false;
    if let Some(edit) = &mut spines {
        if edit.places == SpinePlaces::Random {
            let says = "How many grow on each µm, as far as there is room: they are two radii of the dendrite apart";
            let range = 0.1..=3.0;
            let density = slider(ui, &mut edit.density, range, Some(2), |slider| {
                slider.suffix(" /µm")
            });
            let density = density.tip(says);
            dropped = density.drag_stopped() || density.lost_focus();
        }
        let says = "Other sizes, directions and random places";
        if ui.button("Shuffle").tip(says).clicked() {
            edit.seed = edit.seed.wrapping_add(1);
        }
    }
    if spines.is_some() && state.document.report.is_some() {
        ui.weak("While a report shows, cells are drawn without spines.");
    }
    if spines != before {
        let edit = Edit::SetSpines(sources.to_vec(), spines);
        state.requests.push(edit.into());
    } else if dropped {
        state.history.end_joining();
    }
    measures(state, first, ui);
}

/// How many spines a cell has.
fn measures(state: &State, source: SourceId, ui: &mut Ui) {
    let Some(source) = state.sources.get(source) else {
        return;
    };
    if source.spines.is_some() {
        let grown = source.spine_count();
        figures(ui, "spine figures", &[("spines", grown.to_string())]);
    }
}
