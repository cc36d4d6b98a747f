//! The tool that measures: what is under the cursor, clicks, and what it says over the picture.

use eframe::egui::{
    self, Align2, Area, CursorIcon, Id, Order, Pos2, Rect, Response, RichText, Ui, vec2,
};
use glam::DVec3;

use super::dimensions;
use crate::model::command::Command;
use crate::model::document::{Anchor, Dimension, TracePlace};
use crate::model::measuring::{Measured, Measuring, Pointed, degrees};
use crate::model::numbers::measured;
use crate::model::state::State;
use crate::scene::locate::{Ray, pointed};
use crate::scene::picks::CursorHit;
use crate::ui::panels::plate;

/// Points of the window within which two clicks are at the same place, and the cursor is at a fork.
const NEAR: f64 = 9.0;

/// Finds what the cursor is at.
pub(crate) fn point(state: &mut State, seen: Option<CursorHit>, response: &Response) {
    let under = response.hover_pos().zip(seen).and_then(|(at, seen)| {
        let (ray, pixel) = ray_at(state, &seen, at, response.rect);
        pointed(state, &seen, ray, NEAR * pixel)
    });
    if let Some(tool) = &mut state.tools.measuring {
        tool.under = under;
    }
    if response.hovered() {
        response.ctx.set_cursor_icon(CursorIcon::Crosshair);
    }
}

/// The place on a neuron's tracing that the cursor is at.
pub(crate) fn trace_place(
    state: &State,
    seen: Option<CursorHit>,
    response: &Response,
) -> Option<TracePlace> {
    let (at, seen) = response.hover_pos().zip(seen)?;
    let (ray, _) = ray_at(state, &seen, at, response.rect);
    let Anchor {
        neuron, location, ..
    } = pointed(state, &seen, ray, 0.0)?.at;
    let morphology = &state.source_of(neuron)?.morphology;
    Some(TracePlace::of(neuron, location, morphology))
}

/// The ray from the eye through the cursor, and the size (µm) of a point of the window at what was hit.
fn ray_at(state: &State, seen: &CursorHit, at: Pos2, rect: Rect) -> (Ray, f64) {
    let camera = state.view.camera();
    let offset = at - rect.min;
    let pixel = [f64::from(offset.x), f64::from(offset.y)];
    let size = [f64::from(rect.width()), f64::from(rect.height())];
    let depth = state.view.depth_in_front(seen.place);
    let through = state.view.at_depth(pixel, size, depth);
    // Without perspective, all rays are parallel.
    let eye = match camera.is_orthographic() {
        true => through + camera.axes()[2] * camera.eye().distance(camera.target()),
        false => camera.eye(),
    };
    let ray = Ray { eye, through };
    (ray, camera.pixel_size(size[1]).at(depth))
}

/// Handles a click: the first one begins a distance, the second one keeps it. Two at the same place
/// keep the diameter there, or the angle of a fork.
pub(crate) fn click(state: &mut State, rect: Rect) {
    let Some(Measuring { first, under }) = state.tools.measuring else {
        return;
    };
    let Some(under) = under else {
        state.messages.status = "Measuring: click a neuron".into();
        return;
    };
    match first {
        None => state.requests.push(Command::MeasureFrom(under.at)),
        Some(first) => {
            let dimension = dimension(state, first, under, rect);
            state.request_dimension(dimension);
        }
    }
}

/// What a second click keeps.
fn dimension(state: &State, first: Anchor, under: Pointed, rect: Rect) -> Dimension {
    let places = [first, under.at].map(|anchor| place(state, anchor, rect));
    let near = |[a, b]: [Pos2; 2]| f64::from(a.distance(b)) <= NEAR;
    let [a, b] = places;
    let same = first.neuron == under.at.neuron && a.zip(b).is_some_and(|(a, b)| near([a, b]));
    match (same || first == under.at, under.fork) {
        (true, Some(at)) => Dimension::Angle { at },
        (true, None) => Dimension::Diameter { at: under.at },
        (false, _) => Dimension::Distance {
            from: first,
            to: under.at,
        },
    }
}

/// Where the picture shows an anchor.
fn place(state: &State, anchor: Anchor, rect: Rect) -> Option<Pos2> {
    let placement = *state.placements().get(anchor.neuron)?;
    let position: DVec3 = placement.world_from_cell(anchor.position);
    let size = [rect.width(), rect.height()].map(|n| n.round() as u32);
    let [x, y] = state.view.camera().pixel_of(position, size)?;
    Some(rect.min + vec2(x as f32, y as f32))
}

/// Draws the dimensions and what is being measured, and says how to go on.
pub(crate) fn show(state: &State, rect: Rect, ui: &Ui) {
    let painter = ui.painter().with_clip_rect(rect);
    let Some(tool) = state.tools.measuring else {
        dimensions::show(state, None, rect, &painter);
        return;
    };
    hint(&tool, rect, ui);
    let going = tool.first.map(|first| match tool.under {
        Some(under) => dimension(state, first, under, rect),
        None => Dimension::Diameter { at: first },
    });
    let going = going.and_then(|dimension| state.figure(&dimension));
    dimensions::show(state, going, rect, &painter);
    let cursor = ui.input(|i| i.pointer.hover_pos());
    if let (Some(under), Some(at)) = (tool.under, cursor.filter(|at| rect.contains(*at))) {
        beside_cursor(state, under, at, rect, ui);
    }
}

fn hint(tool: &Measuring, rect: Rect, ui: &Ui) {
    let text = match tool.first {
        None => {
            "Click two places: distance and path. One place twice: diameter, or at a fork the angle. \
             Esc ends."
        }
        Some(_) => {
            "Click the second place, or the same one again for its diameter (at a fork: the angle). \
             Esc goes back."
        }
    };
    // Between the axes and the scale bar, or above them where there is no room.
    let between = rect.width() - 2.0 * (0.18 * rect.width() + 60.0).max(110.0);
    let (above, most) = match between >= 180.0 {
        true => (14.0, between.min(420.0)),
        false => (96.0, (rect.width() - 40.0).clamp(120.0, 420.0)),
    };
    Area::new(Id::unique("measuring hint").with(rect.left() as i32))
        .order(Order::Middle)
        .interactable(false)
        .fixed_pos(rect.center_bottom() - vec2(0.0, above))
        .pivot(Align2::CENTER_BOTTOM)
        .show(ui.ctx(), |ui| {
            plate(ui).show(ui, |ui| {
                ui.set_max_width(most);
                ui.label(text);
            });
        });
}

/// Figures of what the cursor is at, beside it.
fn beside_cursor(state: &State, under: Pointed, at: Pos2, rect: Rect, ui: &Ui) {
    let mut lines = Vec::new();
    let diameter = Dimension::Diameter { at: under.at };
    if let Some(Measured::Diameter(diameter)) = state.figure(&diameter).map(|f| f.measured) {
        let radius = measured(diameter / 2.0, "µm");
        lines.push(format!("Ø {}   radius {radius}", measured(diameter, "µm")));
    }
    if let Some(path) = state.path_from_soma(under.at) {
        lines.push(format!("{} along the neurite", measured(path, "µm")));
    }
    let angle = under
        .fork
        .and_then(|at| state.figure(&Dimension::Angle { at }));
    if let Some(Measured::Angle { local, remote }) = angle.map(|f| f.measured) {
        let (local, remote) = (degrees(&local), degrees(&remote));
        lines.push(format!("fork {local}   remote {remote}"));
    }
    // Below the cursor, unless the window ends there.
    let (offset, pivot) = match at.y + 90.0 > rect.bottom() {
        true => (vec2(16.0, -12.0), Align2::LEFT_BOTTOM),
        false => (vec2(16.0, 14.0), Align2::LEFT_TOP),
    };
    Area::new(Id::unique("measuring at the cursor"))
        .order(Order::Middle)
        .interactable(false)
        .fixed_pos(at + offset)
        .pivot(pivot)
        .show(ui.ctx(), |ui| {
            plate(ui).inner_margin(5.0).show(ui, |ui| {
                ui.spacing_mut().item_spacing.y = 1.0;
                ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
                for line in lines {
                    ui.label(RichText::new(line).size(12.5));
                }
            });
        });
}
