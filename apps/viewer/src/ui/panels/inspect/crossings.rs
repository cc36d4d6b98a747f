//! The list of places where the selected cells' surfaces cross themselves, in *Inspect*, and their marks.

use std::sync::Arc;

use eframe::egui::{Button, Color32, Painter, Rect, RichText, ScrollArea, Stroke, TextStyle, Ui};
use neurotess::render::BoundingSphere;
use neurotess::union::Kin;

use crate::model::command::Command;
use crate::model::crossings::Crossing;
use crate::model::state::State;
use crate::ui::panels::cells::count;
use crate::ui::panels::widgets::marks;
use crate::ui::panels::widgets::tip::Tip;

/// Most marks in the picture; the deepest ones have them.
const MARKED: usize = 500;
/// Height of the list.
const HEIGHT: f32 = 180.0;
const COLOR: Color32 = Color32::from_rgb(214, 39, 119);

/// A switch, and the list.
pub(crate) fn show(state: &mut State, ui: &mut Ui) {
    let mut open = state.crossings.open;
    let switch = ui.checkbox(&mut open, "Self-crossings of the surface").tip(
        "Places where the surface crosses itself, as meshes of level 4 have it; click to go there",
    );
    if switch.changed() {
        state.requests.push(Command::ListCrossings(open));
    }
    if open {
        list(state, ui);
    }
}

fn list(state: &mut State, ui: &mut Ui) {
    let crossings = match state.crossing_list() {
        None if state.crossing_key().is_none() => return,
        None | Some((_, false)) => {
            ui.spinner();
            return;
        }
        Some((Err(why), true)) => {
            let color = ui.visuals().warn_fg_color;
            ui.label(RichText::new(why).color(color).small());
            return;
        }
        Some((Ok(list), true)) => Arc::clone(list),
    };
    if crossings.is_empty() {
        ui.weak("None: the surface crosses itself nowhere.");
        return;
    }
    let apart = crossings.iter().filter(|c| c.place.kin == Kin::Apart);
    let apart = apart.count();
    ui.weak(format!(
        "{}: {apart} of branches through one another, {} of bends and forks",
        count(crossings.len(), "place"),
        crossings.len() - apart
    ));
    let text = ui.text_style_height(&TextStyle::Button);
    let row = (text + 2.0 * ui.spacing().button_padding.y).max(ui.spacing().interact_size.y);
    let rows = ScrollArea::vertical()
        .id_salt("crossings")
        .max_height(HEIGHT);
    rows.auto_shrink([false, true])
        .show_rows(ui, row, crossings.len(), |ui, shown| {
            for index in shown {
                line(state, index, &crossings[index], ui);
            }
        });
}

fn line(state: &mut State, index: usize, crossing: &Crossing, ui: &mut Ui) {
    let place = &crossing.place;
    let what = match place.kin {
        Kin::Apart => "branches",
        Kin::Near => "bend or fork",
    };
    let [a, b] = place.points;
    let text = format!("{:.2} µm, {what} ({a}, {b})", place.depth);
    let chosen = state.crossings.pointed == Some(index);
    // A line is a row of the list: it must not wrap.
    let button = ui.add(Button::selectable(chosen, text).truncate());
    let tip = format!("Between samples {a} and {b}, so deep in one another: go there");
    if button.tip(&tip).clicked() {
        state.requests.push(Command::GoCrossing(index));
    }
}

/// Rings around the places in the picture, while the list is open.
pub(crate) fn marks(state: &State, rect: Rect, painter: &Painter) {
    let Some((Ok(crossings), true)) = state.crossing_list() else {
        return;
    };
    let chosen = state.crossings.pointed;
    for (index, crossing) in crossings.iter().take(MARKED).enumerate() {
        if let Some(sphere) = state.sphere_of_crossing(crossing) {
            ring(state, sphere, chosen == Some(index), rect, painter);
        }
    }
}

/// A ring as large as the place, or large enough to be found.
fn ring(state: &State, (center, radius): BoundingSphere, chosen: bool, rect: Rect, to: &Painter) {
    let camera = state.view.camera();
    let Some(at) = marks::at(&camera, rect, center) else {
        return;
    };
    let wide = marks::wide(&camera, rect, center, 1.5 * radius).clamp(4.0, 200.0);
    if rect.expand(wide).contains(at) {
        to.circle_stroke(at, wide, Stroke::new(3.5, Color32::from_white_alpha(150)));
        let width = if chosen { 2.5 } else { 1.2 };
        to.circle_stroke(at, wide, Stroke::new(width, COLOR));
    }
}
