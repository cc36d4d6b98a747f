//! Handles that move and turn the selected cells: arrows along the axes, rings about them, and a disc in the middle.

use std::f64::consts::TAU;

use eframe::egui::{
    Color32, CursorIcon, Key, Painter, PointerButton, Pos2, Rect, Response, Shape, Stroke, Ui, Vec2,
};
use glam::DVec3;

use crate::model::command::{Command, Edit};
use crate::model::placing::{self, ARROW, Handle, RING};
use crate::model::state::State;
use crate::ui::panels::widgets::marks;

/// Distance (points) at which the mouse is on a line.
const NEAR: f32 = 7.0;
/// Radius (points) of the disc in the middle.
const DISC: f32 = 9.0;
/// Part of an arrow, from the middle on, that is left to the disc and the rings' middle.
const BEGIN: f64 = 0.2;
/// Cosine between its axis and the view from which on a ring faces the camera.
const FACES: f64 = 0.8;
/// Number of points that a ring is drawn with.
const ROUND: usize = 64;
/// Of the axes, as those in the corner of the picture have.
const COLORS: [Color32; 3] = [
    Color32::from_rgb(214, 60, 60),
    Color32::from_rgb(70, 160, 70),
    Color32::from_rgb(60, 110, 220),
];
const LIT: Color32 = Color32::from_rgb(255, 200, 60);

/// Handles a drag of a handle. True while there is one: it does not move the camera.
pub(crate) fn drag(state: &mut State, response: &Response, ui: &Ui) -> bool {
    let Some(shape) = Gizmo::of(state, response.rect) else {
        if let Some(placing) = &mut state.tools.placing {
            (placing.under, placing.drag) = (None, None);
        }
        return false;
    };
    let (modifiers, origin, cancels) = ui.input(|i| {
        let cancels = i.key_pressed(Key::Escape);
        (i.modifiers, i.pointer.press_origin(), cancels)
    });
    let under = response.hover_pos().and_then(|at| shape.handle_at(at));
    let from = |at: Pos2| {
        let at: Vec2 = at - response.rect.min;
        [f64::from(at.x), f64::from(at.y)]
    };
    let begins = response.drag_started_by(PointerButton::Primary) && !modifiers.any();
    if let Some(at) = origin.filter(|_| begins)
        && let Some(handle) = shape.handle_at(at)
    {
        let size = [response.rect.width(), response.rect.height()].map(f64::from);
        state.begin_placing(handle, from(at), size);
    }
    let Some(placing) = &mut state.tools.placing else {
        return false;
    };
    placing.under = under;
    let Some(drag) = placing.drag.clone() else {
        if let Some(handle) = under {
            ui.set_cursor_icon(CursorIcon::Grab);
            response.clone().on_hover_text_at_pointer(handle.says());
        }
        return false;
    };
    let at = response.interact_pointer_pos();
    let step = at.filter(|_| !cancels).map(|at| {
        let step = drag.step(from(at), modifiers.command);
        (drag.placements(step), step.to_string())
    });
    match step {
        Some((places, says)) => {
            ui.set_cursor_icon(CursorIcon::Grabbing);
            state.requests.push(Edit::Place(places).into());
            state.messages.status = says;
        }
        None => state.requests.push(Edit::Place(drag.before).into()),
    }
    if response.drag_stopped() || at.is_none() || cancels {
        // The whole drag is one edit.
        state.requests.push(Command::EndPlacing);
    }
    true
}

/// Draws the handles.
pub(crate) fn show(state: &State, rect: Rect, painter: &Painter) {
    let Some(shape) = Gizmo::of(state, rect) else {
        return;
    };
    let placing = state.tools.placing.as_ref();
    let dragged = placing.and_then(|p| p.drag.as_ref()).map(|d| d.handle);
    let lit = dragged.or(placing.and_then(|p| p.under));
    let color = |handle: Handle, usual: Color32| if lit == Some(handle) { LIT } else { usual };
    for (index, ring) in shape.rings.iter().enumerate() {
        let color = color(Handle::Turn(index), COLORS[index]);
        for (ends, front) in ring {
            let width = if *front { 2.0 } else { 1.0 };
            let color = if *front {
                color
            } else {
                color.gamma_multiply(0.35)
            };
            painter.line_segment(*ends, Stroke::new(width, color));
        }
    }
    for (index, arrow) in shape.arrows.iter().enumerate() {
        let Some([begin, tip]) = *arrow else { continue };
        let color = color(Handle::Move(index), COLORS[index]);
        painter.line_segment([begin, tip], Stroke::new(3.0, color));
        let way = (tip - begin).normalized();
        let side = way.rot90() * 6.0;
        let head = vec![tip + way * 13.0, tip + side, tip - side];
        painter.add(Shape::convex_polygon(head, color, Stroke::NONE));
    }
    let middle = color(Handle::Slide, Color32::from_gray(235));
    painter.circle(
        shape.middle,
        DISC - 3.0,
        middle,
        Stroke::new(1.5, Color32::from_gray(60)),
    );
}

/// Where the handles are in the window.
struct Gizmo {
    middle: Pos2,
    /// Those that the mouse can follow.
    arrows: [Option<[Pos2; 2]>; 3],
    /// Pieces of the rings, and whether they are in front.
    rings: [Vec<([Pos2; 2], bool)>; 3],
}

impl Gizmo {
    /// None if there are none.
    fn of(state: &State, rect: Rect) -> Option<Self> {
        // While a ring is dragged, the middle of several somata goes around it.
        let drag = state.tools.placing.as_ref()?.drag.as_ref();
        let turned = drag.filter(|drag| matches!(drag.handle, Handle::Turn(_)));
        let pivot = match turned {
            Some(drag) => drag.pivot,
            None => state.pivot()?,
        };
        let view = &state.view;
        let camera = view.camera();
        let middle = marks::at(&camera, rect, pivot)?;
        let pixel = placing::pixel(view, pivot, f64::from(rect.height()));
        let at = |offset: DVec3| marks::at(&camera, rect, pivot + offset * pixel);
        let ray = placing::ray_to(view, pivot);
        let arrow = |index: usize| {
            let along = placing::axis(index) * ARROW;
            let there = placing::can_follow(view, pivot, index);
            there.then(|| Some([at(along * BEGIN)?, at(along)?]))?
        };
        let ring = |index: usize| {
            let [u, v] = [1, 2].map(|next| placing::axis((index + next) % 3) * RING);
            let place = |i: usize| {
                let angle = TAU * i as f64 / ROUND as f64;
                u * angle.cos() + v * angle.sin()
            };
            // A ring that faces the camera is in front all around.
            let faces = placing::axis(index).dot(ray).abs() > FACES;
            let piece = |i: usize| {
                let [a, b] = [place(i), place(i + 1)];
                Some(([at(a)?, at(b)?], faces || (a + b).dot(ray) < 0.1 * RING))
            };
            (0..ROUND).filter_map(piece).collect()
        };
        Some(Self {
            middle,
            arrows: [0, 1, 2].map(arrow),
            rings: [0, 1, 2].map(ring),
        })
    }

    /// The handle at a place of the window: the disc, else the closest arrow, else the closest ring.
    fn handle_at(&self, at: Pos2) -> Option<Handle> {
        if at.distance(self.middle) < DISC {
            return Some(Handle::Slide);
        }
        let closest = |all: Vec<(f32, Handle)>| {
            let near = all.into_iter().filter(|(distance, _)| *distance < NEAR);
            let least = near.min_by(|a, b| a.0.total_cmp(&b.0));
            least.map(|(_, handle)| handle)
        };
        let arrows = self.arrows.iter().enumerate().filter_map(|(index, arrow)| {
            let [begin, tip] = (*arrow)?;
            let head = tip + (tip - begin).normalized() * 12.0;
            Some((apart(at, [begin, head]), Handle::Move(index)))
        });
        let rings = self.rings.iter().enumerate().map(|(index, ring)| {
            let front = ring.iter().filter(|(_, front)| *front);
            let distances = front.map(|(ends, _)| apart(at, *ends));
            (distances.fold(f32::MAX, f32::min), Handle::Turn(index))
        });
        closest(arrows.collect()).or_else(|| closest(rings.collect()))
    }
}

/// Distance of a place from a line between two.
fn apart(at: Pos2, [a, b]: [Pos2; 2]) -> f32 {
    let (way, to) = (b - a, at - a);
    let share = (to.dot(way) / way.length_sq().max(1e-6)).clamp(0.0, 1.0);
    (to - way * share).length()
}
