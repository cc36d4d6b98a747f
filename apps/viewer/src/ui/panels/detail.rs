//! The level of detail, and the time and memory that it takes.

use std::ops::RangeInclusive;

use eframe::egui::emath::Numeric;
use eframe::egui::{self, Color32, Pos2, Sense, Stroke, Ui, vec2};

use crate::model::command::{Command, Edit};
use crate::model::document::{Detail, LodKind, RestChoice};
use crate::model::state::{Draft, Lowered, State};
use crate::ui::file_panel::size;
use crate::ui::panels::widgets::number::slider;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::panels::{figures, grouped, heading};

pub(super) fn show(state: &mut State, ui: &mut Ui) {
    let mut detail = state.document.detail;
    let before = detail;
    heading(ui, "Triangle size by");
    ui.horizontal_wrapped(|ui| {
        for (criterion, name, says) in LOD_KINDS {
            ui.selectable_value(&mut detail.criterion, criterion, name)
                .tip(says);
        }
    });
    ui.add_space(4.0);
    sliders(&mut detail, ui);
    let says = "What is smaller than this in the picture is not drawn; 0 draws everything";
    slider(ui, &mut detail.smallest, 0.0..=8.0, Some(1), |slider| {
        slider.text("hide below (px)")
    })
    .tip(says);
    ui.horizontal(|ui| {
        let usual = Detail::default();
        if ui
            .add_enabled(detail != usual, egui::Button::new("Reset all"))
            .tip("The defaults of this panel")
            .clicked()
        {
            detail = usual;
        }
        let mut wireframe = state.document.look.wireframe;
        if ui.checkbox(&mut wireframe, "Wireframe").changed() {
            let mut look = state.document.look.clone();
            look.wireframe = wireframe;
            state.requests.push(Edit::SetLook(Box::new(look)).into());
        }
    });
    let mut frozen = state.views.frozen.is_some();
    let says = "Keeps the triangles of this view while you move on, to look at them from elsewhere";
    if ui.checkbox(&mut frozen, "Freeze").tip(says).changed() {
        state.requests.push(Command::SetFrozen(frozen));
    }
    if detail != before {
        state.requests.push(Edit::SetDetail(detail).into());
    } else if ui.input(|i| i.pointer.any_released()) {
        state.history.end_joining();
    }
    ui.separator();
    heading(ui, "Picture at rest");
    let mut detail = state.document.detail;
    ui.horizontal_wrapped(|ui| {
        for (choice, name, says) in REST_CHOICES {
            ui.selectable_value(&mut detail.at_rest, choice, name)
                .tip(says);
        }
    });
    if detail.at_rest != state.document.detail.at_rest {
        state.requests.push(Edit::SetDetail(detail).into());
    }
    counters(state, ui);
}

const LOD_KINDS: [(LodKind, &str, &str); 4] = [
    (
        LodKind::Error,
        "Error",
        "At most so many pixels between the triangles and the smooth surface",
    ),
    (
        LodKind::Size,
        "Size",
        "Edges of triangles are at most so many pixels long",
    ),
    (
        LodKind::Homogeneous,
        "Uniform",
        "The same number of subdivisions everywhere",
    ),
    (
        LodKind::Distance,
        "Distance",
        "Fewer subdivisions with the distance from the camera (García-Cantero et al. 2017)",
    ),
];

const REST_CHOICES: [(RestChoice, &str, &str); 3] = [
    (
        RestChoice::Automatic,
        "Automatic",
        "With all detail, or within a budget where that would block the window",
    ),
    (
        RestChoice::Full,
        "Full",
        "With all detail, however long it takes",
    ),
    (
        RestChoice::Budget,
        "Budget",
        "As many triangles as there is time for, as while moving",
    ),
];

fn sliders(detail: &mut Detail, ui: &mut Ui) {
    match detail.criterion {
        LodKind::Error => {
            log(ui, &mut detail.error, 0.05..=20.0, "max. error (px)");
        }
        LodKind::Size => {
            log(ui, &mut detail.size, 1.0..=100.0, "max. edge (px)");
        }
        LodKind::Homogeneous => {
            log(ui, &mut detail.level, 1..=64, "subdivisions");
        }
        LodKind::Distance => {
            log(ui, &mut detail.level, 1..=64, "at the camera");
            log(ui, &mut detail.far, 1.0..=100_000.0, "none beyond (µm)");
        }
    }
}

fn log<N: Numeric>(ui: &mut Ui, value: &mut N, range: RangeInclusive<N>, name: &str) {
    slider(ui, value, range, None, |slider| {
        slider.logarithmic(true).text(name)
    });
}

fn counters(state: &State, ui: &mut Ui) {
    let c = &state.drawing.counters;
    let mut rows = match c.lowered {
        None => vec![
            ("triangles", grouped(c.triangles)),
            (
                "patches drawn",
                format!("{} of {}", grouped(c.patches[0]), grouped(c.patches[1])),
            ),
        ],
        Some(Lowered::Triangles(Some([drawn, wanted]))) => vec![
            ("triangles, reduced", grouped(drawn)),
            ("for full detail", grouped(wanted)),
        ],
        Some(Lowered::Triangles(None)) => vec![],
        Some(Lowered::Error(times)) => vec![("reduced", format!("{times:.0} times as coarse"))],
    };
    if let Some(picture) = c.static_picture {
        rows.push(("distinct colors in view", grouped(picture.colors as u64)));
        if let Some(compartments) = picture.compartments {
            rows.push(("values read per frame", grouped(compartments as u64)));
        }
        rows.push(("GPU memory, recoloring", size(picture.bytes)));
    }
    let [fine, clamped] = c.clamped;
    if clamped > 0 {
        rows.push(("clamped neurons", format!("{fine} of {clamped} fine")));
    }
    rows.push(("GPU memory, neurons", size(c.bytes[0])));
    rows.push(("GPU memory, images", size(c.bytes[1])));
    figures(ui, "counters", &rows);
    heading(ui, "Drawing times");
    graph(&c.frames_ms, ui);
    match c.draft {
        Draft::Budget(triangles) => {
            let most = grouped(u64::from(triangles));
            ui.weak(format!("While moving: at most {most} triangles."));
        }
        Draft::Error(times) if times > 1.05 => {
            ui.weak(format!("While moving: {times:.0} times as coarse."));
        }
        Draft::Error(_) => {}
    }
}

/// Height (points) of the names of lines in the graph.
const LINE: f32 = 11.0;

/// A graph of the milliseconds of the last frames, with lines at 16.7 and 100.
fn graph(frames: &[f32], ui: &mut Ui) {
    let size = vec2(ui.available_width().min(260.0), 64.0);
    let (response, painter) = ui.allocate_painter(size, Sense::hover());
    let rect = response.rect;
    let visuals = ui.visuals();
    painter.rect_filled(rect, 4.0, visuals.extreme_bg_color);
    let most = frames.iter().copied().fold(33.3_f32, f32::max) * 1.1;
    let y = |ms: f32| rect.bottom() - rect.height() * (ms / most).min(1.0);
    let mut above = f32::NEG_INFINITY;
    for ms in [100.0, 16.7] {
        if ms < most {
            let line = [
                Pos2::new(rect.left(), y(ms)),
                Pos2::new(rect.right(), y(ms)),
            ];
            painter.line_segment(
                line,
                Stroke::new(1.0, visuals.weak_text_color().gamma_multiply(0.4)),
            );
            // Where the lines are close, the lower one has no room for its name.
            if y(ms) - above < LINE {
                continue;
            }
            above = y(ms);
            let at = Pos2::new(rect.right() - 3.0, y(ms) - 1.0);
            let text = format!("{ms:.0} ms");
            let font = egui::FontId::proportional(9.0);
            painter.text(
                at,
                egui::Align2::RIGHT_BOTTOM,
                text,
                font,
                visuals.weak_text_color(),
            );
        }
    }
    let step = rect.width() / 90.0;
    for (i, &ms) in frames.iter().enumerate() {
        let x = rect.left() + (i as f32 + 0.5) * step;
        let color = if ms > 100.0 {
            visuals.warn_fg_color
        } else {
            Color32::from_rgb(0x2f, 0x7d, 0xc4)
        };
        let bar = [Pos2::new(x, rect.bottom()), Pos2::new(x, y(ms))];
        painter.line_segment(bar, Stroke::new((step - 1.0).max(1.0), color));
    }
    let last = frames.last().copied().unwrap_or(0.0);
    ui.weak(format!("last: {last:.1} ms"));
}
