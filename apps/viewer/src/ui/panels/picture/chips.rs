//! What the picture shows otherwise than it was traced, said in the picture.

use eframe::egui::{Align2, Area, Id, Rect, Ui, vec2};

use crate::model::command::Edit;
use crate::model::state::State;
use crate::ui::panels::plate;
use crate::ui::panels::widgets::tip::Tip;

/// Says in the corner of the picture what a glance at it would take for the cell's own, with a button that ends it.
pub(crate) fn show(state: &mut State, rect: Rect, ui: &Ui) {
    let says = state.document.look.falsifies();
    if says.is_empty() {
        return;
    }
    Area::new(Id::unique("chips"))
        .fixed_pos(rect.right_top() + vec2(-14.0, 14.0))
        .pivot(Align2::RIGHT_TOP)
        .show(ui.ctx(), |ui| {
            plate(ui).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.colored_label(ui.visuals().warn_fg_color, says.join(", "));
                    let reset = ui.small_button("×").tip("Reset look");
                    if reset.clicked() {
                        state.requests.push(Edit::ResetLook.into());
                    }
                });
            });
        });
}
