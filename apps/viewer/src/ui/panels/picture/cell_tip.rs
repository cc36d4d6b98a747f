//! What is under the cursor while it rests on a cell of a circuit: the cell's attributes, and the value of its compartment
//! at the current time.

use std::time::Duration;

use eframe::egui::{Align2, Area, Id, Order, Rect, RichText, TextWrapMode, Ui, vec2};
use neurotess::circuit::Population;

use crate::model::numbers::significant;
use crate::model::state::State;
use crate::model::state::part_name;
use crate::ui::panels::{figures, plate};

/// Time (s) that the cursor rests before the tip shows.
const REST: f32 = 0.35;
/// Most attributes that are told.
const MOST: usize = 8;

/// Shows the tip, if there is something to tell.
pub(crate) fn show(state: &State, rect: Rect, ui: &Ui) {
    let (at, rests, down) = ui.input(|i| {
        let pointer = &i.pointer;
        let rests = pointer.time_since_last_movement();
        (pointer.hover_pos(), rests, pointer.any_down())
    });
    let (Some(at), Some(hovered), false) = (
        at.filter(|at| rect.contains(*at)),
        state.pointing.hovered,
        down,
    ) else {
        return;
    };
    if rests < REST {
        let left = f64::from(REST - rests).max(0.01);
        ui.ctx()
            .request_repaint_after(Duration::from_secs_f64(left));
        return;
    }
    let mut rows = attributes(state, hovered.neuron);
    rows.extend(value(state));
    if rows.is_empty() {
        return;
    }
    let name = state.document.neurons.get(hovered.neuron);
    let name = name.map_or(String::new(), |neuron| neuron.name.clone());
    let high = 22.0 * (rows.len() as f32 + 2.0);
    // Below the cursor, unless the picture ends there.
    let (offset, pivot) = match at.y + high > rect.bottom() {
        true => (vec2(16.0, -12.0), Align2::LEFT_BOTTOM),
        false => (vec2(16.0, 16.0), Align2::LEFT_TOP),
    };
    Area::new(Id::unique("cell under the cursor"))
        .order(Order::Middle)
        .interactable(false)
        .fixed_pos(at + offset)
        .pivot(pivot)
        // Over a panel, its lines would show through.
        .constrain_to(rect)
        .show(ui.ctx(), |ui| {
            plate(ui).inner_margin(6.0).show(ui, |ui| {
                ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
                ui.label(RichText::new(name).strong());
                figures(ui, "cell under the cursor", &rows);
            });
        });
}

/// Attributes of the node that a neuron shows.
fn attributes(state: &State, neuron: usize) -> Vec<(String, String)> {
    let of = state.document.neurons.get(neuron).and_then(|n| n.node);
    let Some(node) = of.and_then(|of| state.circuits.node(of)) else {
        return Vec::new();
    };
    let populations: &[Population] = &node.circuit.populations;
    let Some(population) = populations.get(node.node.population as usize) else {
        return Vec::new();
    };
    let row = node.node.row as usize;
    let value = |name: &String| {
        let attribute = population.attributes.get(name)?;
        let number = || attribute.number(row).map(significant);
        attribute.text(row).map(str::to_owned).or_else(number)
    };
    let names = population.attributes.keys();
    let known = names.filter_map(|name| Some((name.clone(), value(name)?)));
    known.take(MOST).collect()
}

/// The value of the compartment, and which one that is.
fn value(state: &State) -> Vec<(String, String)> {
    let (Some(place), Some(frame), Some(facts)) = (
        state.traces.pointed,
        state.playback.frame(),
        state.playback.facts.as_ref(),
    ) else {
        return Vec::new();
    };
    let read = state.traces.value.as_ref();
    let value = read.filter(|read| read.of == (place, frame));
    let Some((compartment, value)) = value.and_then(|read| read.value.as_ref()) else {
        return Vec::new();
    };
    let number = format!("{} {}", significant(f64::from(*value)), facts.unit);
    vec![
        ("compartment".into(), part_name(compartment)),
        (facts.title.clone(), number.trim_end().to_owned()),
    ]
}
