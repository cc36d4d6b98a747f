//! Tooltips beside the panels: egui would place them below a control, where they cover the next
//! one.

use eframe::egui::{Context, Id, Rect, RectAlign, Response, Tooltip, WidgetText};

/// Key under which the picture's rectangle is kept, over which tooltips are placed.
fn place() -> Id {
    Id::unique("place of the picture")
}

/// Sets the picture's rectangle for the next frame.
pub(crate) fn set_picture(ctx: &Context, rect: Rect) {
    ctx.data_mut(|data| data.insert_temp(place(), rect));
}

pub(crate) trait Tip {
    /// Shows a text about a control while the cursor stays on it.
    fn tip(self, text: impl Into<WidgetText>) -> Self;
}

impl Tip for Response {
    fn tip(self, text: impl Into<WidgetText>) -> Self {
        let picture = self.ctx.data(|data| data.get_temp::<Rect>(place()));
        let beside = picture.and_then(|picture| beside(self.rect, picture));
        let mut tooltip = Tooltip::for_enabled(&self);
        if let Some((anchor, align)) = beside {
            tooltip.popup = tooltip.popup.anchor(anchor).align(align).gap(10.0);
        }
        tooltip.show(|ui| ui.label(text));
        self
    }
}

/// The rectangle that a tooltip is placed next to, as wide as the control's panel, and the side
/// that the picture is on.
fn beside(control: Rect, picture: Rect) -> Option<(Rect, RectAlign)> {
    let middle = control.center();
    if !picture.y_range().contains(middle.y) {
        return None;
    }
    let (x, align) = if middle.x > picture.right() {
        (picture.right()..=control.right(), RectAlign::LEFT_START)
    } else if middle.x < picture.left() {
        (control.left()..=picture.left(), RectAlign::RIGHT_START)
    } else {
        return None;
    };
    Some((Rect::from_x_y_ranges(x, control.y_range()), align))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{pos2, vec2};

    #[test]
    fn tips_of_panels_lie_over_the_picture() {
        let picture = Rect::from_min_max(pos2(200.0, 30.0), pos2(700.0, 500.0));
        let control = |x, y| Rect::from_min_size(pos2(x, y), vec2(60.0, 20.0));
        let (anchor, align) = beside(control(760.0, 100.0), picture).expect("on the right");
        assert_eq!((anchor.left(), align), (700.0, RectAlign::LEFT_START));
        let (anchor, align) = beside(control(10.0, 100.0), picture).expect("on the left");
        assert_eq!((anchor.right(), align), (200.0, RectAlign::RIGHT_START));
        assert_eq!(
            beside(control(10.0, 510.0), picture),
            None,
            "the line below"
        );
    }
}
