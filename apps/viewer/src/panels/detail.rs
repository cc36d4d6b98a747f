//! The level of detail, with what it costs.

use eframe::egui::{self, Color32, Pos2, Sense, Slider, Stroke, Ui, vec2};

use super::{figures, grouped, heading};
use crate::command::Command;
use crate::document::{Criterion, Detail};
use crate::files::size;
use crate::state::{Draft, Lowered, State};

pub(super) fn show(state: &mut State, ui: &mut Ui) {
    let mut detail = state.document.detail;
    let before = detail;
    heading(ui, "Chosen by");
    ui.horizontal_wrapped(|ui| {
        for (criterion, name, says) in CRITERIA {
            ui.selectable_value(&mut detail.criterion, criterion, name)
                .on_hover_text(says);
        }
    });
    ui.add_space(4.0);
    sliders(&mut detail, ui);
    let says = "What is smaller in the picture is left out; 0: nothing";
    ui.add(
        Slider::new(&mut detail.smallest, 0.0..=8.0)
            .text("smallest (px)")
            .fixed_decimals(1),
    )
    .on_hover_text(says);
    ui.horizontal(|ui| {
        let usual = Detail::default();
        if ui
            .add_enabled(detail != usual, egui::Button::new("As usual"))
            .clicked()
        {
            detail = usual;
        }
        let mut wires = state.document.look.wires;
        if ui.checkbox(&mut wires, "Triangles").changed() {
            let mut look = state.document.look.clone();
            look.wires = wires;
            state.asked.push(Command::SetLook(Box::new(look)));
        }
    });
    let mut frozen = state.frozen.is_some();
    let says = "Keeps the levels and what is left out as they are now, so that you can go round and look at them";
    if ui
        .checkbox(&mut frozen, "Freeze")
        .on_hover_text(says)
        .changed()
    {
        state.asked.push(Command::SetFrozen(frozen));
    }
    if detail != before {
        state.asked.push(Command::SetDetail(detail));
    } else if ui.input(|i| i.pointer.any_released()) {
        state.history.end_joining();
    }
    ui.separator();
    counters(state, ui);
}

const CRITERIA: [(Criterion, &str, &str); 4] = [
    (
        Criterion::Error,
        "Error",
        "No surface farther than this from the finest one, in pixels",
    ),
    (
        Criterion::Size,
        "Size",
        "No edge longer than this, in pixels",
    ),
    (Criterion::Homogeneous, "Same", "The same level everywhere"),
    (
        Criterion::Distance,
        "Distance",
        "The level falls with the distance from the eye (García-Cantero et al. 2017)",
    ),
];

fn sliders(detail: &mut Detail, ui: &mut Ui) {
    match detail.criterion {
        Criterion::Error => {
            ui.add(
                Slider::new(&mut detail.error, 0.05..=20.0)
                    .logarithmic(true)
                    .text("error (px)"),
            );
        }
        Criterion::Size => {
            ui.add(
                Slider::new(&mut detail.size, 1.0..=100.0)
                    .logarithmic(true)
                    .text("size (px)"),
            );
        }
        Criterion::Homogeneous => {
            ui.add(
                Slider::new(&mut detail.level, 1..=64)
                    .logarithmic(true)
                    .text("level"),
            );
        }
        Criterion::Distance => {
            ui.add(
                Slider::new(&mut detail.level, 1..=64)
                    .logarithmic(true)
                    .text("level at the eye"),
            );
            ui.add(
                Slider::new(&mut detail.far, 1.0..=100_000.0)
                    .logarithmic(true)
                    .text("level 1 from (µm)"),
            );
        }
    }
}

fn counters(state: &State, ui: &mut Ui) {
    let c = &state.counters;
    heading(ui, "At rest");
    let mut rows = match c.lowered {
        None => vec![
            ("triangles", grouped(c.triangles)),
            (
                "patches drawn",
                format!("{} of {}", grouped(c.patches[0]), grouped(c.patches[1])),
            ),
        ],
        Some(Lowered::Triangles(Some([drawn, wanted]))) => vec![
            ("triangles, lowered", grouped(drawn)),
            ("wanted", grouped(wanted)),
        ],
        Some(Lowered::Triangles(None)) => vec![],
        Some(Lowered::Error(times)) => vec![("lowered", format!("{times:.0} times as coarse"))],
    };
    rows.push(("memory, cells", size(c.bytes[0])));
    rows.push(("memory, pictures", size(c.bytes[1])));
    figures(ui, "counters", &rows);
    heading(ui, "Frames");
    graph(&c.frames_ms, ui);
    match c.draft {
        Draft::Budget(triangles) => {
            let most = grouped(u64::from(triangles));
            ui.weak(format!(
                "While moving: at most {most} triangles, to keep up."
            ));
        }
        Draft::Error(times) if times > 1.05 => {
            ui.weak(format!(
                "While moving: {times:.0} times as coarse, to keep up."
            ));
        }
        Draft::Error(_) => {}
    }
}

/// Milliseconds of the last frames; a line at 16.7 and at 100.
fn graph(frames: &[f32], ui: &mut Ui) {
    let size = vec2(ui.available_width().min(260.0), 64.0);
    let (response, painter) = ui.allocate_painter(size, Sense::hover());
    let rect = response.rect;
    let visuals = ui.visuals();
    painter.rect_filled(rect, 4.0, visuals.extreme_bg_color);
    let most = frames.iter().copied().fold(33.3_f32, f32::max) * 1.1;
    let y = |ms: f32| rect.bottom() - rect.height() * (ms / most).min(1.0);
    for ms in [16.7, 100.0] {
        if ms < most {
            let line = [
                Pos2::new(rect.left(), y(ms)),
                Pos2::new(rect.right(), y(ms)),
            ];
            painter.line_segment(
                line,
                Stroke::new(1.0, visuals.weak_text_color().gamma_multiply(0.4)),
            );
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
        let colour = if ms > 100.0 {
            visuals.warn_fg_color
        } else {
            Color32::from_rgb(0x2f, 0x7d, 0xc4)
        };
        let bar = [Pos2::new(x, rect.bottom()), Pos2::new(x, y(ms))];
        painter.line_segment(bar, Stroke::new((step - 1.0).max(1.0), colour));
    }
    let last = frames.last().copied().unwrap_or(0.0);
    ui.weak(format!("last piece of work {last:.1} ms"));
}
