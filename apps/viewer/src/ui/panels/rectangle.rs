//! Selects neurons by a rectangle over the picture: Ctrl and the left button.

use eframe::egui::{
    Color32, CursorIcon, Id, Key, Painter, PointerButton, Pos2, Rect, Response, Stroke, StrokeKind,
    Ui,
};
use glam::DVec3;
use neurotess::morphology::Morphology;

use crate::model::command::Edit;
use crate::model::state::State;

/// Handles a drag that selects. True while there is one: it does not move the camera.
pub(super) fn drag(state: &mut State, response: &Response, ui: &Ui) -> bool {
    let id = Id::unique("rectangle");
    let (modifiers, origin, cancels) = ui.input(|i| {
        let cancels = i.key_pressed(Key::Escape);
        (i.modifiers, i.pointer.press_origin(), cancels)
    });
    let begins = response.drag_started_by(PointerButton::Primary) && modifiers.command;
    let kept: Option<Pos2> = ui.data(|data| data.get_temp(id));
    let Some(start) = kept.or(origin.filter(|_| begins)) else {
        return false;
    };
    let Some(end) = response.interact_pointer_pos().filter(|_| !cancels) else {
        ui.data_mut(|data| data.remove_temp::<Pos2>(id));
        return kept.is_some();
    };
    ui.data_mut(|data| data.insert_temp(id, start));
    if response.drag_stopped() {
        ui.data_mut(|data| data.remove_temp::<Pos2>(id));
        let inside = neurons(state, Rect::from_two_pos(start, end), response.rect);
        state.status = format!(
            "{} in the rectangle",
            super::cells::count(inside.len(), "neuron")
        );
        state
            .requests
            .push(Edit::Select(inside, modifiers.shift).into());
    } else {
        ui.set_cursor_icon(CursorIcon::Crosshair);
    }
    true
}

/// Draws the rectangle of a drag that selects.
pub(super) fn show(response: &Response, painter: &Painter, ui: &Ui) {
    let start: Option<Pos2> = ui.data(|data| data.get_temp(Id::unique("rectangle")));
    let (Some(start), Some(end)) = (start, response.interact_pointer_pos()) else {
        return;
    };
    let rect = Rect::from_two_pos(start, end);
    let color = Color32::from_rgb(0x2f, 0x7d, 0xc4);
    painter.rect_filled(rect, 0.0, color.gamma_multiply(0.12));
    painter.rect_stroke(rect, 0.0, Stroke::new(1.0, color), StrokeKind::Middle);
}

/// Indices of the neurons that are shown whose somata are in a rectangle, also behind others.
fn neurons(state: &State, rect: Rect, picture: Rect) -> Vec<usize> {
    let camera = state.view.camera();
    // In sixteenths of a point, since sizes are whole numbers.
    let size = [picture.width(), picture.height()].map(|n| (16.0 * n) as u32);
    let placements = state.placements();
    let neurons = state
        .document
        .neurons
        .iter()
        .zip(placements.iter())
        .enumerate();
    let inside = neurons.filter(|(_, (neuron, placement))| {
        let source = state.sources.get(neuron.source).filter(|_| !neuron.hidden);
        let place = source.map(|source| placement.world_from_cell(middle(&source.morphology)));
        let pixel = place.and_then(|place| camera.pixel_of(place, size));
        pixel.is_some_and(|[x, y]| {
            let at = picture.min + eframe::egui::vec2(x as f32, y as f32) / 16.0;
            rect.contains(at)
        })
    });
    inside.map(|(index, _)| index).collect()
}

/// Where a neuron is: its soma, or where its first neurite begins.
fn middle(morphology: &Morphology) -> DVec3 {
    let soma = morphology.soma().map(|soma| soma.center);
    let first = morphology.points.first().map(|point| point.position);
    let place = soma.or(first).unwrap_or_default();
    morphology.origin + place.as_dvec3()
}
