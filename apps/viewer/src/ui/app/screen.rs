//! The window opens no larger than what the screen has room for.

use eframe::egui::{Context, Vec2, ViewportCommand, vec2};

use super::Viewer;

/// Points that the desktop takes: the sides of the window's frame; its title, and the desktop's own bars. Nobody tells
/// them before the window shows: GNOME, KDE, Windows and macOS have titles of 22 to 37 and bars of 24 to 48.
const TAKEN: Vec2 = vec2(16.0, 100.0);

impl Viewer {
    /// Makes the window smaller that does not fit the screen with its frame, once the size of the screen is known: in
    /// the first frame, which is not shown yet, on most desktops.
    pub(super) fn fit_screen(&mut self, ctx: &Context) {
        if self.fits_screen || ctx.zoom_factor() != self.state.settings.zoom.clamp(0.5, 3.0) {
            return;
        }
        let viewport = ctx.input(|input| input.viewport().clone());
        let Some(screen) = viewport.monitor_size else {
            return;
        };
        self.fits_screen = true;
        let fills = viewport.fullscreen == Some(true) || viewport.maximized == Some(true);
        let size = ctx.content_rect().size();
        let fitting = fitting(size, screen);
        if !fills && fitting != size {
            ctx.send_viewport_cmd(ViewportCommand::InnerSize(fitting));
        }
    }
}

/// The size of a window of this size on a screen (points).
fn fitting(size: Vec2, screen: Vec2) -> Vec2 {
    // Some remote desktops have a screen of no size.
    let room = (screen - TAKEN).max(vec2(480.0, 320.0));
    size.min(room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_leave_room_for_frames_and_bars() {
        let usual = vec2(1280.0, 820.0);
        let on = |width, height| fitting(usual, vec2(width, height));
        assert_eq!(on(1920.0, 1080.0), usual);
        assert_eq!(on(1280.0, 800.0), vec2(1264.0, 700.0));
        assert_eq!(on(1366.0, 768.0), vec2(1280.0, 668.0));
        assert_eq!(on(0.0, 0.0), vec2(480.0, 320.0));
    }
}
