//! Where the selected cells are, in numbers: beside the handles in the picture.

use eframe::egui::Ui;
use glam::DVec3;

use crate::model::command::Command;
use crate::model::placing::PlaceNumbers;
use crate::model::state::State;
use crate::ui::panels::heading;
use crate::ui::panels::widgets::number::field;
use crate::ui::panels::widgets::tip::Tip;

/// Farthest place (µm): a meter.
const FAR: f64 = 1e6;

pub(crate) fn show(state: &mut State, ui: &mut Ui) {
    let Some(before) = state.place_numbers() else {
        return;
    };
    let several = state.document.neurons.selected().len() > 1;
    let mut numbers = before;
    heading(ui, "Place");
    let [position, rotation] = match several {
        true => [
            "The middle of the selected cells' somata: all move together",
            "Of the first selected cell; all turn together about their middle, about z first",
        ],
        false => [
            "The soma's center, or where the first neurite begins",
            "About x, y and z, about z first; the soma stays where it is",
        ],
    };
    let PlaceNumbers {
        position: to,
        rotation: turn,
    } = &mut numbers;
    let mut ended = row(ui, "position (µm)", position, to, FAR);
    ended |= row(ui, "rotation (°)", rotation, turn, 360.0);
    if numbers != before
        && let Some(edit) = state.placed_at(numbers)
    {
        state.requests.push(edit.into());
    }
    if ended {
        // What was typed, or a whole drag, is one step of undo.
        state.requests.push(Command::EndPlacing);
    }
    ui.horizontal_wrapped(|ui| {
        let placing = state.tools.placing.is_some();
        let tip = "Arrows and rings in the picture (P)";
        if ui.selectable_label(placing, "Handles").tip(tip).clicked() {
            state.requests.push(Command::SetPlacing(!placing));
        }
        let tip = "Where the selected cells were traced";
        if ui.button("Put back").tip(tip).clicked() {
            state.requests.push(Command::PutBack);
        }
    });
}

/// Fields for three numbers up to a greatest one. True if one is not edited any more.
fn row(ui: &mut Ui, name: &str, says: &str, numbers: &mut DVec3, most: f64) -> bool {
    let mut ended = false;
    crate::ui::panels::widgets::number::kept(ui, name, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.label(name).tip(says);
            for (number, axis) in numbers.as_mut().iter_mut().zip(["x", "y", "z"]) {
                let response = field(ui, number, -most..=most, 2, |field| {
                    let field = field.prefix(format!("{axis} "));
                    field.speed(0.5).update_while_editing(false)
                });
                let response = response.tip(says);
                ended |= response.drag_stopped() || response.lost_focus();
            }
        });
    });
    ended
}
