//! Files that are held over the window.

use eframe::egui::{Align2, Color32, Context, Event, FontId, Id, LayerId, Order};

/// Files that the desktop says are held, which it goes on saying if what held them vanished.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    /// Number of files in the frame before.
    before: usize,
    /// Number of those that nobody holds any more.
    gone: usize,
}

impl Held {
    /// Number of files that are held. `moved`: whether the pointer moved, which it does not for the window while
    /// something is dragged.
    fn shown(&mut self, count: usize, moved: bool) -> usize {
        if count < self.before {
            self.gone = 0;
        } else if count == self.before && moved {
            self.gone = count;
        }
        self.before = count;
        count - self.gone.min(count)
    }
}

/// While files are dragged over the window: says what dropping them would do.
pub(super) fn show(ctx: &Context) {
    let (count, moved) = ctx.input(|input| {
        let is_free =
            |event: &Event| matches!(event, Event::PointerMoved(_) | Event::PointerButton { .. });
        let moved = input.events.iter().any(is_free);
        (input.raw.hovered_files.len(), moved)
    });
    let count = ctx.data_mut(|data| {
        let held: &mut Held = data.get_temp_mut_or_default(Id::unique("held files"));
        held.shown(count, moved)
    });
    if count == 0 {
        return;
    }
    let rect = ctx.content_rect();
    let layer = LayerId::new(Order::Foreground, Id::unique("drop"));
    let painter = ctx.layer_painter(layer);
    painter.rect_filled(rect, 0.0, Color32::from_black_alpha(150));
    let text = match count {
        1 => "Drop it to open it".to_owned(),
        n => format!("Drop these {n} to open them"),
    };
    painter.text(
        rect.center(),
        Align2::CENTER_CENTER,
        text,
        FontId::proportional(26.0),
        Color32::WHITE,
    );
}

#[cfg(test)]
mod tests {
    use super::Held;

    #[test]
    fn files_whose_source_vanished_are_not_announced_for_ever() {
        let mut held = Held::default();
        // The last place of the pointer may come with the files.
        assert_eq!(held.shown(4, true), 4);
        assert_eq!(held.shown(4, false), 4);
        assert_eq!(held.shown(4, true), 0);
        assert_eq!(held.shown(4, false), 0);
        // Others come: the desktop adds them to those.
        assert_eq!(held.shown(6, false), 2);
        // They are dropped, and further ones come.
        assert_eq!(held.shown(0, true), 0);
        assert_eq!(held.shown(1, false), 1);
    }
}
