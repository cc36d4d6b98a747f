//! Values over time of the compartments that were clicked, below the picture.

use eframe::egui::{
    Align, Button, Color32, Id, Label, Layout, Painter, Pos2, Rect, RichText, Role, ScrollArea, Ui,
    WidgetInfo, vec2,
};

use crate::io::task::Progress;
use crate::model::command::{Command, Edit, FilePurpose, PlotOf};
use crate::model::document::Trace;
use crate::model::numbers::significant;
use crate::model::state::State;
use crate::model::traces::TraceContent;
use crate::ui::panels::cells::count;
use crate::ui::plot::{self, PlotView};

/// Width of the list beside the plot.
const LIST: f32 = 300.0;
/// Width of the button of a color.
const SWATCH: f32 = 20.0;

/// Shows the plot. `reading`: progress of reading values, while that goes on.
pub(crate) fn show(state: &mut State, reading: Option<&Progress>, ui: &mut Ui) {
    ui.add_space(2.0);
    head(state, reading, ui);
    let height = ui.available_height();
    let list = LIST.min(0.4 * ui.available_width());
    let plot = state.trace_plot();
    let time = state
        .playback
        .facts
        .as_ref()
        .map(|_| state.playback.pace.time);
    ui.horizontal_top(|ui| {
        let width = ui.available_width() - list - 8.0;
        let mut pointed = plot::Pointed::default();
        ui.allocate_ui(vec2(width, height), |ui| {
            let view = PlotView {
                id: Id::unique("traces"),
                name: "Plot of traces",
                height,
                moves: true,
                time,
            };
            pointed = plot::show(&plot, &view, ui);
        });
        if let Some(time) = pointed.dragged {
            state.requests.push(Command::Seek(time));
        }
        ui.vertical(|ui| {
            let at = pointed.x.filter(|_| pointed.dragged.is_none()).or(time);
            rows(state, at, ui);
        });
    });
}

fn head(state: &mut State, reading: Option<&Progress>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        ui.label(RichText::new("Values over time").strong());
        if let Some(progress) = reading {
            ui.spinner();
            ui.weak(format!("{:.0} %", 100.0 * progress.share()));
        }
        if state.playback.facts.is_none() {
            let color = ui.visuals().warn_fg_color;
            let text = "No report shows: open one (Ctrl Shift O), or color by its values (Look)";
            ui.colored_label(color, text);
        } else if state.document.traces.is_empty() {
            ui.weak("Click a compartment in the picture; with Shift several");
        } else {
            ui.weak("Drag the line to change the time; wheel: zoom; double click: all");
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui
                .small_button("×")
                .on_hover_text("Close the plot (T)")
                .clicked()
            {
                state.requests.push(Command::ShowTraces(false));
            }
            let any = !state.document.traces.is_empty();
            let clear = Button::new("Clear").small();
            if ui
                .add_enabled(any, clear)
                .on_hover_text("Remove all traces")
                .clicked()
            {
                state.requests.push(Edit::ClearTraces.into());
            }
            save_buttons(state, PlotOf::Traces, any, ui);
        });
    });
}

/// Buttons that save a plot.
pub(crate) fn save_buttons(state: &mut State, of: PlotOf, any: bool, ui: &mut Ui) {
    for (title, says, extension) in [
        ("SVG…", "Save the plot as a figure", "svg"),
        ("CSV…", "Save the numbers as a table", "csv"),
    ] {
        let button = Button::new(title).small();
        if ui.add_enabled(any, button).on_hover_text(says).clicked() {
            let purpose = FilePurpose::SavePlot(of, extension);
            state.requests.push(Command::AskFiles(purpose));
        }
    }
}

/// The list of traces with their values at a time (ms).
fn rows(state: &mut State, at: Option<f64>, ui: &mut Ui) {
    if let Some(at) = at {
        let rounded = (at * 1e4).round() / 1e4;
        ui.weak(format!("at {} ms", significant(rounded)));
    }
    let traces = state.document.traces.to_vec();
    let scroll = ScrollArea::vertical().id_salt("traces").auto_shrink(false);
    scroll.show(ui, |ui| {
        for (which, trace) in traces.iter().enumerate() {
            ui.horizontal(|ui| row(state, which, trace, at, ui));
        }
    });
}

fn row(state: &mut State, which: usize, trace: &Trace, at: Option<f64>, ui: &mut Ui) {
    let mut color = trace.color;
    ui.spacing_mut().interact_size.x = SWATCH;
    ui.spacing_mut().item_spacing.x = 5.0;
    if ui.color_edit_button_srgb(&mut color).changed() {
        state
            .requests
            .push(Edit::SetTraceColor(which, color).into());
    }
    let name = state.trace_name(trace.place);
    let remove = ui.small_button("×");
    let enabled = ui.is_enabled();
    remove.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, format!("Remove {name}")));
    if remove.on_hover_text("Remove this trace").clicked() {
        state.requests.push(Edit::RemoveTrace(which).into());
    }
    // From right to left: the value first, then the name in the remaining width.
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let (text, why) = value(state, trace, at);
        let text = match &why {
            Some(_) => RichText::new(text).color(ui.visuals().warn_fg_color),
            None => RichText::new(text).strong(),
        };
        let shown = ui.label(text);
        if let Some(why) = why {
            shown.on_hover_text(why);
        }
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let [part, cell] = parts(state, trace);
            ui.add(Label::new(part)).on_hover_text(&name);
            let cell = Label::new(RichText::new(cell).weak()).truncate();
            ui.add(cell).on_hover_text(&name);
        });
    });
}

/// The part of the cell that a trace is of, and the cell.
fn parts(state: &State, trace: &Trace) -> [String; 2] {
    let neuron = state.document.neurons.get(trace.place.neuron);
    let cell = neuron.map_or(String::new(), |neuron| neuron.name.clone());
    let name = state.trace_name(trace.place);
    match name.strip_prefix(&format!("{cell}, ")) {
        Some(part) => [part.to_owned(), cell],
        None => [cell, String::new()],
    }
}

/// The value of a trace at a time, and what is wrong with it.
fn value(state: &State, trace: &Trace, at: Option<f64>) -> (String, Option<String>) {
    let Some(read) = state.traces.of(trace.place) else {
        return ("…".into(), None);
    };
    let unit = state
        .playback
        .facts
        .as_ref()
        .map_or("", |f| f.unit.as_str());
    let text = match &read.content {
        TraceContent::Nothing if read.problem.is_none() => {
            let why = "The report has no values of this part of the cell";
            return ("no values".into(), Some(why.into()));
        }
        TraceContent::Spikes(times) => count(times.len(), "spike"),
        _ => match at.and_then(|at| read.value_at(at)) {
            Some(value) => {
                let number = significant(f64::from(value));
                format!("{number} {unit}").trim_end().to_owned()
            }
            None => "–".into(),
        },
    };
    (text, read.problem.clone())
}

/// Marks the compartments in the picture, in the colors of their lines.
pub(crate) fn marks(state: &State, rect: Rect, painter: &Painter) {
    if !state.traces.open {
        return;
    }
    let camera = state.view.camera();
    // In sixteenths of a point, since sizes are whole numbers.
    let size = [rect.width(), rect.height()].map(|n| (16.0 * n) as u32);
    for trace in state.document.traces.iter() {
        let position = state.trace_position(trace);
        let Some([x, y]) = position.and_then(|at| camera.pixel_of(at, size)) else {
            continue;
        };
        let at: Pos2 = rect.min + vec2(x as f32, y as f32) / 16.0;
        let [r, g, b] = trace.color;
        painter.circle_filled(at, 6.5, Color32::from_gray(30));
        painter.circle_filled(at, 5.5, Color32::WHITE);
        painter.circle_filled(at, 4.0, Color32::from_rgb(r, g, b));
    }
}
