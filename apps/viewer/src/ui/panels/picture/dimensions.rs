//! Dimensions, drawn over the picture: the same lines as in saved pictures.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2};
use neurotess::render::color::is_dark;
use neurotess::render::overlay::{Annotation, AnnotationLine};

use crate::model::measuring::Figure;
use crate::model::state::State;
use crate::scene::dimensions::annotations;

/// Height (points) of a line of text, as that of the legend.
const LINE: f32 = 14.0;
/// Width (points) of the rim of lines, on each side.
const RIM: f32 = 1.4;

/// Draws the dimensions of the neurons that are shown, and `going`, which is being measured. That
/// one is highlighted, and so is the one whose line in the list is under the cursor.
pub(crate) fn show(state: &State, going: Option<Figure>, rect: Rect, painter: &Painter) {
    let kept = state.shown_figures().into_iter();
    let kept = kept.map(|(index, figure)| (state.pointing.dimension == Some(index), figure));
    let figures: Vec<(bool, Figure)> = kept.chain(going.map(|figure| (true, figure))).collect();
    if figures.is_empty() {
        return;
    }
    let size = [rect.width(), rect.height()].map(f64::from);
    let camera = state.view.camera();
    let shapes = figures.iter().map(|(_, figure)| figure);
    let drawn = annotations(shapes, &camera, size, f64::from(LINE));
    let marked = figures.iter().map(|(marked, _)| *marked);
    let all = || drawn.iter().zip(marked.clone());
    let all = || all().filter_map(|(drawn, marked)| Some((drawn.as_ref()?, marked)));
    let [plain, marked] = [false, true].map(|marked| Colors::of(state, marked));
    let colors = |is_marked: bool| if is_marked { &marked } else { &plain };
    for (annotation, is_marked) in all() {
        for line in &annotation.lines {
            draw(line, colors(is_marked), rect, painter);
        }
    }
    // Labels are above all lines.
    for (annotation, is_marked) in all() {
        label(annotation, colors(is_marked), rect, painter);
    }
}

struct Colors {
    ink: Color32,
    rim: Color32,
}

impl Colors {
    fn of(state: &State, marked: bool) -> Self {
        let [r, g, b] = state.document.look.background;
        let dark = is_dark([r, g, b]);
        let ink = match (marked, dark) {
            (true, true) => Color32::from_rgb(255, 196, 64),
            (true, false) => Color32::from_rgb(200, 80, 0),
            (false, true) => Color32::from_gray(240),
            (false, false) => Color32::from_gray(20),
        };
        let rim = Color32::from_rgba_unmultiplied(r, g, b, 190);
        Self { ink, rim }
    }
}

fn place(rect: Rect, [x, y]: [f64; 2]) -> Pos2 {
    rect.min + vec2(x as f32, y as f32)
}

fn draw(line: &AnnotationLine, colors: &Colors, rect: Rect, painter: &Painter) {
    let width = (line.width * LINE).max(1.0);
    let points: Vec<Pos2> = line.points.iter().map(|&p| place(rect, p)).collect();
    let within = rect.expand(50.0);
    match points[..] {
        [a, b] if a == b => {
            painter.circle_filled(a, width / 2.0 + RIM, colors.rim);
            painter.circle_filled(a, width / 2.0, colors.ink);
        }
        // Far outside, the numbers are too large for lines.
        _ if !Rect::from_points(&points).intersects(within) => {}
        _ => {
            painter.line(points.clone(), Stroke::new(width + 2.0 * RIM, colors.rim));
            painter.line(points, Stroke::new(width, colors.ink));
        }
    }
}

fn label(annotation: &Annotation, colors: &Colors, rect: Rect, painter: &Painter) {
    let middle = place(rect, annotation.label_at);
    let text = annotation.label.join("\n");
    let font = FontId::proportional(LINE - 1.0);
    let galley = painter.layout_no_wrap(text, font, colors.ink);
    let around = Align2::CENTER_CENTER.anchor_size(middle, galley.size());
    if !around.intersects(rect) {
        return;
    }
    painter.rect_filled(around.expand2(vec2(4.0, 2.0)), 4.0, colors.rim);
    painter.galley(pos2(around.left(), around.top()), galley, colors.ink);
}
