//! Legend, scale bar and axes over the picture.

use eframe::egui::{
    self, Align2, Color32, ColorImage, FontId, Id, Pos2, Rect, Stroke, TextureOptions, Ui, vec2,
};
use glam::DVec3;
use neurotess::render::color::is_dark;
use neurotess::render::overlay::{Legend, nice_length};

use crate::model::state::State;
use crate::ui::panels::Screen;

/// Draws the legend as a texture, which is replaced when the legend changes.
pub(crate) fn legend(legend: Legend, screen: &Screen<'_>, rect: Rect, ui: &Ui) {
    type Kept = (Legend, [u8; 3], u32, egui::TextureHandle);
    let points = ui.ctx().pixels_per_point();
    let background = screen.state.document.look.background;
    let ink = if is_dark(background) {
        [230; 3]
    } else {
        [25; 3]
    };
    let id = Id::unique("legend");
    let line = (14.0 * points).round();
    let kept: Option<Kept> = ui.data(|data| data.get_temp(id));
    let fits = |kept: &Kept| kept.0 == legend && kept.1 == ink && kept.2 == line as u32;
    let texture = match kept.filter(fits) {
        Some((.., texture)) => texture,
        None => {
            let image = legend.draw(line, ink);
            let size = [image.width as usize, image.height as usize];
            if size.contains(&0) {
                return;
            }
            let image = ColorImage::from_rgba_unmultiplied(size, &image.pixels);
            let texture = ui
                .ctx()
                .load_texture("legend", image, TextureOptions::NEAREST);
            ui.data_mut(|data| data.insert_temp(id, (legend, ink, line as u32, texture.clone())));
            texture
        }
    };
    let size = texture.size_vec2() / points;
    if size.y > 0.8 * rect.height() || size.x > 0.6 * rect.width() || size.x < 4.0 {
        return;
    }
    let place = Rect::from_min_size(rect.left_top() + vec2(14.0, 14.0), size);
    set_off(screen.state, place.expand(7.0), ui);
    let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
    ui.painter()
        .image(texture.id(), place, whole, Color32::WHITE);
}

/// Draws a background behind what is in a corner, so that it stands out from the picture.
fn set_off(state: &State, rect: Rect, ui: &Ui) {
    let [r, g, b] = state.document.look.background;
    let behind = Color32::from_rgba_unmultiplied(r, g, b, 190);
    ui.painter().rect_filled(rect, 5.0, behind);
}

/// Draws the scale bar.
pub(crate) fn scale_bar(state: &State, rect: Rect, ui: &Ui) {
    let camera = state.view.camera();
    let pixel = camera.pixel_at_target(f64::from(rect.height()));
    let length = nice_length(0.18 * f64::from(rect.width()) * pixel);
    let width = (length / pixel) as f32;
    if !width.is_finite() || width > rect.width() {
        return;
    }
    let text = match length {
        l if l >= 1000.0 => format!("{} mm", l / 1000.0),
        l if l < 1.0 => format!("{} nm", (l * 1e3).round()),
        l => format!("{l} µm"),
    };
    // Nearer things are larger: a length is true at the depth that the camera turns around.
    let text = match state.view.orthographic {
        true => text,
        false => format!("{text} at the focus"),
    };
    let (painter, ink) = (ui.painter(), ink(state));
    let name = painter.layout_no_wrap(text, FontId::proportional(13.0), ink);
    let end = rect.right_bottom() - vec2(20.0, 22.0);
    let start = end - vec2(width, 0.0);
    // Above the middle, but no farther to the right than the bar.
    let left = (start.lerp(end, 0.5).x - name.size().x / 2.0).min(end.x - name.size().x);
    let at = Pos2::new(left, end.y - 6.0 - name.size().y);
    let shown = Rect::from_min_max(Pos2::new(start.x.min(left), end.y - 24.0), end).expand(8.0);
    set_off(state, shown, ui);
    painter.line_segment([start, end], Stroke::new(3.0, ink));
    painter.galley(at, name, ink);
}

/// Draws the directions of the axes.
pub(crate) fn axes(state: &State, rect: Rect, ui: &Ui) {
    let [right, up, backward] = state.view.camera().axes();
    let center = rect.left_bottom() + vec2(44.0, -44.0);
    let mut arms = [
        (DVec3::X, "x", Color32::from_rgb(214, 60, 60)),
        (DVec3::Y, "y", Color32::from_rgb(70, 160, 70)),
        (DVec3::Z, "z", Color32::from_rgb(60, 110, 220)),
    ];
    set_off(state, Rect::from_center_size(center, vec2(84.0, 84.0)), ui);
    // The farthest first.
    arms.sort_by(|a, b| a.0.dot(backward).total_cmp(&b.0.dot(backward)));
    for (axis, name, color) in arms {
        let tip = vec2(axis.dot(right) as f32, -axis.dot(up) as f32) * 26.0;
        ui.painter()
            .line_segment([center, center + tip], Stroke::new(2.0, color));
        ui.painter().text(
            center + tip * 1.35,
            Align2::CENTER_CENTER,
            name,
            FontId::proportional(12.0),
            color,
        );
    }
}

fn ink(state: &State) -> Color32 {
    if is_dark(state.document.look.background) {
        Color32::from_gray(225)
    } else {
        Color32::from_gray(30)
    }
}
