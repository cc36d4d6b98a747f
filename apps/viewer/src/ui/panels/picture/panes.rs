//! The picture, or two of them side by side, each with its own view and its own stage.

use eframe::egui::{Color32, Pos2, Rect, Stroke, Ui};

use super::viewport::{self, Before, Pane};
use crate::ui::panels::Screen;

/// Width (points) between the two.
const GAP: f32 = 3.0;

/// Shows the picture, or both.
pub(crate) fn show(screen: &mut Screen<'_>, before: Before, ui: &mut Ui) {
    let rect = ui.available_rect_before_wrap();
    screen.motion.note_window(ui.ctx().content_rect().size());
    if screen.state.views.split.is_none() || screen.second.is_none() {
        viewport::show(screen, before, Pane::Only, rect, ui);
        return;
    }
    screen.state.follow();
    let middle = rect.center().x;
    let left = Rect::from_min_max(rect.min, Pos2::new(middle - GAP / 2.0, rect.bottom()));
    let right = Rect::from_min_max(Pos2::new(middle + GAP / 2.0, rect.top()), rect.max);
    pane(screen, before, false, left, ui);
    // The figures of the panels are those of the left one.
    let counters = screen.state.drawing.counters.clone();
    pane(screen, before, true, right, ui);
    screen.state.drawing.counters = counters;
    screen.state.follow();
    let pressed = ui.input(|i| {
        let at = i.pointer.press_origin();
        at.filter(|_| i.pointer.any_pressed())
    });
    if let Some(at) = pressed.filter(|at| left.contains(*at) || right.contains(*at)) {
        let is_right = right.contains(at);
        if screen
            .state
            .views
            .split
            .is_some_and(|split| split.right != is_right)
        {
            // A flight is one of the other view.
            screen.motion.stop();
        }
        screen.state.command_view(is_right);
    }
}

/// Shows one of the two.
fn pane(screen: &mut Screen<'_>, before: Before, right: bool, rect: Rect, ui: &mut Ui) {
    let commanded = screen
        .state
        .views
        .split
        .is_some_and(|split| split.right == right);
    if right {
        exchange_stages(screen);
    }
    if !commanded {
        screen.state.exchange_views();
    }
    let which = match (right, commanded) {
        (false, commanded) => Pane::Left { commanded },
        (true, commanded) => Pane::Right { commanded },
    };
    viewport::show(screen, before, which, rect, ui);
    if !commanded {
        screen.state.exchange_views();
    }
    if right {
        exchange_stages(screen);
    }
    if commanded {
        let accent = Color32::from_rgb(0x2f, 0x7d, 0xc4);
        let y = rect.top() + 1.0;
        ui.painter()
            .hline(rect.x_range(), y, Stroke::new(2.0, accent));
    }
}

fn exchange_stages(screen: &mut Screen<'_>) {
    if let Some(second) = &mut screen.second {
        std::mem::swap(screen.stage, *second);
    }
}
