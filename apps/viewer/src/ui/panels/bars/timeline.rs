//! The time line of a recording: play, step, scrub.

use eframe::egui::{Button, Rect, Response, RichText, Role, Shape, Stroke, Ui, WidgetInfo, vec2};

use crate::model::command::{Command, Edit};
use crate::model::playback::{Facts, Pace, digits};
use crate::model::state::State;
use crate::ui::panels::widgets::number::{field, slider};

pub(crate) fn show(state: &mut State, facts: &Facts, ui: &mut Ui) {
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        buttons(state, ui);
        scrub(state, facts, ui);
    });
    ui.horizontal(|ui| {
        what(facts, ui);
        pace(state, ui);
        if ui
            .small_button("×")
            .on_hover_text("Close the report")
            .clicked()
        {
            state.requests.push(Edit::SetReport(None).into());
        }
    });
    ui.add_space(2.0);
}

fn buttons(state: &mut State, ui: &mut Ui) {
    let (sign, name, keys) = match state.playback.playing {
        true => (Sign::Stop, "Stop", " (Space)"),
        false => (Sign::Play, "Play", " (Space)"),
    };
    for (sign, name, keys, command) in [
        (
            Sign::Begin,
            "To the start",
            "",
            Command::Seek(f64::NEG_INFINITY),
        ),
        (Sign::Back, "Previous frame", " (,)", Command::StepTime(-1)),
        (sign, name, keys, Command::TogglePlay),
        (Sign::On, "Next frame", " (.)", Command::StepTime(1)),
    ] {
        let response = button(sign, name, ui);
        if response.on_hover_text(format!("{name}{keys}")).clicked() {
            state.requests.push(command);
        }
    }
}

/// Signs on buttons, which are drawn since the fonts do not have them.
#[derive(Clone, Copy, PartialEq)]
enum Sign {
    Begin,
    Back,
    Play,
    Stop,
    On,
}

fn button(sign: Sign, name: &str, ui: &mut Ui) -> Response {
    let wide = matches!(sign, Sign::Play | Sign::Stop);
    let size = vec2(if wide { 36.0 } else { 24.0 }, 20.0);
    let response = ui.add(Button::new("").min_size(size));
    let enabled = ui.is_enabled();
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    let ink = ui.style().interact(&response).text_color();
    let (c, painter) = (response.rect.center(), ui.painter());
    let bar = |x: f32, width: f32| {
        let rect = Rect::from_center_size(c + vec2(x, 0.0), vec2(width, 10.0));
        painter.rect_filled(rect, 0.5, ink);
    };
    let triangle = |x: f32, tip: f32| {
        let points = [vec2(x, -5.0), vec2(x, 5.0), vec2(x + tip, 0.0)].map(|v| c + v);
        let shape = Shape::convex_polygon(points.to_vec(), ink, Stroke::NONE);
        painter.add(shape);
    };
    match sign {
        Sign::Begin => {
            bar(-4.5, 2.0);
            triangle(4.5, -8.0);
        }
        Sign::Back => {
            triangle(1.5, -6.0);
            bar(4.0, 2.0);
        }
        Sign::Play => triangle(-3.0, 8.0),
        Sign::Stop => {
            bar(-3.0, 3.0);
            bar(3.0, 3.0);
        }
        Sign::On => {
            bar(-4.0, 2.0);
            triangle(-1.5, 6.0);
        }
    }
    response
}

fn scrub(state: &mut State, facts: &Facts, ui: &mut Ui) {
    let axis = &facts.time;
    let last = axis.time_of(axis.frames.saturating_sub(1));
    let digits = digits(axis.step);
    let before = state.playback.pace.time;
    let mut time = before;
    ui.spacing_mut().slider_width = (ui.available_width() - 100.0).max(60.0);
    let range = axis.start..=last.max(axis.start);
    slider(ui, &mut time, range, Some(digits), |slider| {
        slider.suffix(" ms")
    });
    if time != before {
        state.requests.push(Command::Seek(time));
    }
}

fn what(facts: &Facts, ui: &mut Ui) {
    let mut text = facts.title.clone();
    if !facts.unit.is_empty() {
        text.push_str(&format!(" ({})", facts.unit));
    }
    ui.label(RichText::new(text).strong());
    let axis = &facts.time;
    let frames = match facts.spikes {
        true => format!("spikes until {} ms", axis.end),
        false => format!(
            "{} frames, {} to {} ms",
            crate::ui::panels::grouped(axis.frames),
            axis.start,
            axis.time_of(axis.frames)
        ),
    };
    ui.weak(frames);
    let [without, all] = facts.without;
    if without > 0 {
        let text = format!("{without} of {all} neurons without values");
        ui.colored_label(ui.visuals().warn_fg_color, text)
            .on_hover_text("The report does not have them; they are gray");
    }
    if !facts.warnings.is_empty() {
        let text = "the report contradicts itself";
        ui.colored_label(ui.visuals().warn_fg_color, text)
            .on_hover_text(facts.warnings.join("\n"));
    }
}

fn pace(state: &mut State, ui: &mut Ui) {
    let mut pace: Pace = state.playback.pace;
    ui.separator();
    let step = 0.02 * pace.speed;
    field(ui, &mut pace.speed, 0.001..=100_000.0, 3, |field| {
        field.speed(step).suffix(" ms")
    })
    .on_hover_text("Simulated time per second of the clock");
    ui.weak("per second");
    ui.checkbox(&mut pace.loops, "loop")
        .on_hover_text("At the end, start over");
    if pace != state.playback.pace {
        state.requests.push(Command::SetPace(pace));
    }
}
