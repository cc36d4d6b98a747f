//! Selects neurons by an area over the picture, drawn with Ctrl and the left button: a rectangle, or a lasso.

use eframe::egui::{
    Color32, CursorIcon, Event, Key, Painter, PointerButton, Pos2, Rect, Response, Shape, Stroke,
    StrokeKind, Ui,
};

use crate::model::command::Edit;
use crate::model::state::State;
use crate::ui::panels::widgets::marks;

/// Least distance (points) of two places of a lasso.
const STEP: f32 = 3.0;
/// Where the drag that selects has been.
const KEPT: &str = "area";

/// Handles a drag that selects. True while there is one: it does not move the camera.
pub(crate) fn drag(state: &mut State, response: &Response, ui: &Ui) -> bool {
    let id = response.id.with(KEPT);
    let (modifiers, origin, cancels) = ui.input(|i| {
        let cancels = i.key_pressed(Key::Escape);
        (i.modifiers, i.pointer.press_origin(), cancels)
    });
    let begins = response.drag_started_by(PointerButton::Primary) && modifiers.command;
    let kept: Option<Vec<Pos2>> = ui.data(|data| data.get_temp(id));
    let goes_on = kept.is_some();
    let Some(mut way) = kept.or(origin.filter(|_| begins).map(|start| vec![start])) else {
        return false;
    };
    let Some(end) = response.interact_pointer_pos().filter(|_| !cancels) else {
        ui.data_mut(|data| data.remove_temp::<Vec<Pos2>>(id));
        return goes_on;
    };
    // All places that the pointer was at: a slow frame has many.
    let places = ui.input(|i| {
        let place = |event: &Event| match event {
            Event::PointerMoved(at) => Some(*at),
            _ => None,
        };
        i.events.iter().filter_map(place).collect::<Vec<Pos2>>()
    });
    for at in places.into_iter().chain([end]) {
        if way.last().is_some_and(|last| last.distance(at) >= STEP) {
            way.push(at);
        }
    }
    let area = Area::of(&way, end, state.settings.lasso);
    if response.drag_stopped() {
        ui.data_mut(|data| data.remove_temp::<Vec<Pos2>>(id));
        let inside = neurons(state, &area, response.rect);
        let found = crate::ui::panels::cells::count(inside.len(), "neuron");
        state.messages.status = format!("{found} in the {}", area.name());
        state
            .requests
            .push(Edit::Select(inside, modifiers.shift).into());
    } else {
        ui.data_mut(|data| data.insert_temp(id, way));
        ui.set_cursor_icon(CursorIcon::Crosshair);
    }
    true
}

/// Draws the area of a drag that selects.
pub(crate) fn show(state: &State, response: &Response, painter: &Painter, ui: &Ui) {
    let way: Option<Vec<Pos2>> = ui.data(|data| data.get_temp(response.id.with(KEPT)));
    let (Some(way), Some(end)) = (way, response.interact_pointer_pos()) else {
        return;
    };
    let color = Color32::from_rgb(0x2f, 0x7d, 0xc4);
    let stroke = Stroke::new(1.0, color);
    match Area::of(&way, end, state.settings.lasso) {
        Area::Rectangle(rect) => {
            painter.rect_filled(rect, 0.0, color.gamma_multiply(0.12));
            painter.rect_stroke(rect, 0.0, stroke, StrokeKind::Middle);
        }
        Area::Lasso(outline) => {
            let closing: Vec<Pos2> = [outline.last(), outline.first()]
                .into_iter()
                .flatten()
                .copied()
                .collect();
            painter.extend(Shape::dashed_line(&closing, stroke, 5.0, 4.0));
            painter.add(Shape::line(outline, Stroke::new(1.5, color)));
        }
    }
}

/// An area of the window.
enum Area {
    Rectangle(Rect),
    /// The corners of a polygon, which may cross itself.
    Lasso(Vec<Pos2>),
}

impl Area {
    /// The area of a drag that has been here, and is now at `end`.
    fn of(way: &[Pos2], end: Pos2, lasso: bool) -> Self {
        match (lasso, way) {
            (false, [start, ..]) => Self::Rectangle(Rect::from_two_pos(*start, end)),
            _ => Self::Lasso(way.iter().copied().chain([end]).collect()),
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Rectangle(_) => "rectangle",
            Self::Lasso(_) => "lasso",
        }
    }

    fn contains(&self, at: Pos2) -> bool {
        match self {
            Self::Rectangle(rect) => rect.contains(at),
            Self::Lasso(outline) => is_inside(outline, at),
        }
    }
}

/// Whether a ray to the right leaves a polygon an odd number of times.
fn is_inside(outline: &[Pos2], at: Pos2) -> bool {
    let next = outline.iter().cycle().skip(1);
    let crossed = outline.iter().zip(next).filter(|(a, b)| {
        let level = (a.y > at.y) != (b.y > at.y);
        level && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)
    });
    crossed.count() % 2 == 1
}

/// Indices of the neurons that are shown whose somata are in an area, also behind others.
fn neurons(state: &State, area: &Area, picture: Rect) -> Vec<usize> {
    let camera = state.view.camera();
    let shown = |&index: &usize| {
        let shows = state.document.neurons.shows(index);
        let place = state.middle_of(index).filter(|_| shows);
        let seen = place.and_then(|place| marks::at(&camera, picture, place));
        seen.is_some_and(|at| area.contains(at))
    };
    (0..state.document.neurons.len()).filter(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasso_contains_what_its_line_goes_around() {
        // The letter C, open to the right.
        let corners = [
            (0.0, 0.0),
            (10.0, 0.0),
            (10.0, 2.0),
            (2.0, 2.0),
            (2.0, 8.0),
            (10.0, 8.0),
            (10.0, 10.0),
            (0.0, 10.0),
        ];
        let outline: Vec<Pos2> = corners.map(|(x, y)| Pos2::new(x, y)).to_vec();
        let lasso = Area::of(&outline[..7], outline[7], true);
        let inside = |x, y| lasso.contains(Pos2::new(x, y));
        assert!(inside(1.0, 5.0) && inside(8.0, 1.0) && inside(8.0, 9.0));
        assert!(!inside(6.0, 5.0), "in its hollow");
        assert!(!inside(-1.0, 5.0) && !inside(11.0, 1.0) && !inside(5.0, 11.0));
        let rectangle = Area::of(&outline[..7], outline[6], false);
        assert!(rectangle.contains(Pos2::new(6.0, 5.0)));
        assert!(!is_inside(&[], Pos2::ZERO) && !is_inside(&outline[..1], outline[0]));
    }
}
