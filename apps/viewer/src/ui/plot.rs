//! Draws a plot: what a file gets by [`Plot::svg`], with zoom, and a line at a time that can be dragged.

use std::sync::Arc;

use eframe::egui::{Color32, CursorIcon, Id, Rangef, Role, Stroke, Ui, WidgetInfo, vec2};
use egui_plot::{
    AxisHints, Bar, BarChart, GridMark, HoverPosition, Line, PlotMemory, PlotPoint, PlotPoints,
    PlotUi, VLine,
};
use neurotess::plot::{Axis, Data, Plot, Series, TICK, digits, step, thinned, ticks};

use crate::model::numbers::significant;

/// Points of the window from a line within which it is dragged.
const NEAR: f32 = 7.0;
/// Zoom for each point that the wheel scrolls.
const WHEEL: f32 = 0.004;
/// Least distances (points of the window) of ticks, along and up.
const TICKS: [f32; 2] = [64.0, 32.0];
/// Distances of ticks from which on their texts begin to show, and show fully.
const LABELS: [[f32; 2]; 2] = [[20.0, 32.0], [10.0, 16.0]];
/// Room at the right.
const RIGHT: f32 = 12.0;
/// Thickness of a bar of a barcode.
const THICK: f64 = 0.7;

/// How a plot is shown.
pub(crate) struct PlotView {
    pub(crate) id: Id,
    /// What it is called for those who do not see it.
    pub(crate) name: &'static str,
    pub(crate) height: f32,
    /// Whether it is dragged and zoomed; else the wheel is left to what is around it.
    pub(crate) moves: bool,
    /// Where the line is.
    pub(crate) time: Option<f64>,
}

/// What the cursor does in a plot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pointed {
    /// Where it is on the horizontal axis.
    pub(crate) x: Option<f64>,
    /// Where it drags the line to.
    pub(crate) dragged: Option<f64>,
}

/// Shows a plot.
pub(crate) fn show(plot: &Arc<Plot>, view: &PlotView, ui: &mut Ui) -> Pointed {
    let drags = drags(view, ui);
    let told = (plot.x.clone(), plot.y.clone());
    let moves = view.moves && !drags;
    let across = ((ui.available_width() / TICKS[0]) as usize).max(2);
    let up = ((view.height / TICKS[1]) as usize).max(2);
    let grid = ui.visuals().weak_text_color().gamma_multiply(0.25);
    let drawn = egui_plot::Plot::new(view.id)
        .id(view.id)
        .height(view.height)
        // Half of the last tick's text is beside the plot.
        .width(ui.available_width() - RIGHT)
        .allow_drag(moves)
        .allow_zoom(view.moves)
        .allow_axis_zoom_drag(view.moves)
        .allow_boxed_zoom(view.moves)
        .allow_double_click_reset(view.moves)
        .allow_scroll(false)
        .set_margin_fraction(vec2(0.01, 0.06))
        .custom_x_axes(vec![axis(AxisHints::new_x(), &plot.x, LABELS[0])])
        .custom_y_axes(vec![axis(AxisHints::new_y(), &plot.y, LABELS[1])])
        .x_grid_spacer(|input| marks(input.bounds, across))
        .y_grid_spacer(|input| marks(input.bounds, up))
        .grid_color(grid)
        .grid_fade(0.0)
        .label_formatter(move |at| Some(label(at, &told.0, &told.1)))
        .show(ui, |plot_ui| {
            if view.moves {
                zoom(plot_ui);
            }
            let lines = lines(plot, view.id, plot_ui);
            for (place, series) in plot.series.iter().enumerate() {
                items(place, series, &lines, plot_ui);
            }
            if let Some(time) = view.time {
                let ink = plot_ui.ctx().global_style().visuals.text_color();
                let stroke = Stroke::new(if drags { 2.5 } else { 1.5 }, ink);
                plot_ui.vline(VLine::new("", time).stroke(stroke).allow_hover(false));
            }
            let hovered = plot_ui.response().contains_pointer() || drags;
            plot_ui.pointer_coordinate().filter(|_| hovered)
        });
    let enabled = ui.is_enabled();
    let response = drawn.response;
    response.widget_info(|| WidgetInfo::labeled(Role::GraphicsDocument, enabled, view.name));
    let x = drawn.inner.map(|at| at.x);
    if drags || near_line(view, ui) {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    Pointed {
        x,
        // The last move may come with the release.
        dragged: x.filter(|_| drags && (response.dragged() || response.drag_stopped())),
    }
}

/// Whether the line is being dragged: from a press near it until the button is released.
fn drags(view: &PlotView, ui: &Ui) -> bool {
    let id = view.id.with("line");
    let (pressed, down) = ui.input(|i| (i.pointer.primary_pressed(), i.pointer.primary_down()));
    let was: bool = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let drags = if pressed {
        near_line(view, ui)
    } else {
        was && down
    };
    ui.data_mut(|data| data.insert_temp(id, drags));
    // In the frame of its release the drag still counts.
    drags || (was && ui.input(|i| i.pointer.primary_released()))
}

/// Whether the cursor is near the line.
fn near_line(view: &PlotView, ui: &Ui) -> bool {
    let memory = PlotMemory::load(ui.ctx(), view.id);
    let at = ui.input(|i| i.pointer.latest_pos());
    let (Some(memory), Some(at), Some(time)) = (memory, at, view.time) else {
        return false;
    };
    let transform = memory.transform();
    let line = transform.position_from_point(&PlotPoint::new(time, 0.0));
    transform.frame().contains(at) && (at.x - line.x).abs() <= NEAR
}

/// Zooms by the wheel: the horizontal axis, or with Shift the vertical one.
fn zoom(plot_ui: &mut PlotUi<'_>) {
    let (scroll, other) = plot_ui.ctx().input(|i| {
        let scroll = i.smooth_scroll_delta();
        // With Shift, egui makes a vertical wheel a horizontal one.
        let sum = scroll.x + scroll.y;
        (sum, i.modifiers.shift)
    });
    if scroll == 0.0 || !plot_ui.response().contains_pointer() {
        return;
    }
    let factor = (scroll * WHEEL).exp();
    let factor = match other {
        true => vec2(1.0, factor),
        false => vec2(factor, 1.0),
    };
    plot_ui.zoom_bounds_around_hovered(factor);
}

/// Thinned lines of a plot, by series, kept until what they are thinned for changes.
#[derive(Clone)]
struct Lines {
    plot: Arc<Plot>,
    range: [f64; 2],
    columns: usize,
    lines: Arc<Vec<Vec<[f64; 2]>>>,
}

/// The lines of all series, of as many points as can be seen.
fn lines(plot: &Arc<Plot>, id: Id, plot_ui: &PlotUi<'_>) -> Arc<Vec<Vec<[f64; 2]>>> {
    let columns = plot_ui.transform().frame().width().max(1.0) as usize;
    let bounds = plot_ui.plot_bounds();
    // While the plot fits its content, the whole content decides what that is.
    let range = match plot_ui.auto_bounds().x || plot_ui.response().double_clicked() {
        true => plot.bounds().map_or([0.0, 1.0], |[x, _]| x),
        false => [bounds.min()[0], bounds.max()[0]],
    };
    let id = id.with("lines");
    let known: Option<Lines> = plot_ui.ctx().data(|data| data.get_temp(id));
    let fits = |known: &Lines| {
        Arc::ptr_eq(&known.plot, plot) && known.range == range && known.columns == columns
    };
    if let Some(known) = known.filter(fits) {
        return known.lines;
    }
    let thin = |series: &Series| match &series.data {
        Data::Line(points) => thinned(points, range, columns),
        _ => Vec::new(),
    };
    let lines: Arc<Vec<_>> = Arc::new(plot.series.iter().map(thin).collect());
    let kept = Lines {
        plot: Arc::clone(plot),
        range,
        columns,
        lines: Arc::clone(&lines),
    };
    plot_ui.ctx().data_mut(|data| data.insert_temp(id, kept));
    lines
}

/// What is said beside the cursor.
fn label(at: &HoverPosition<'_>, x: &Axis, y: &Axis) -> String {
    let number = |value: f64, unit: &str| match unit.is_empty() {
        true => significant(value),
        false => format!("{} {unit}", significant(value)),
    };
    let (name, at) = match at {
        HoverPosition::NearDataPoint {
            plot_name,
            position,
            ..
        } => (format!("{plot_name}\n"), position),
        HoverPosition::Elsewhere { position } => (String::new(), position),
    };
    let [x, y] = [number(at.x, &x.unit), number(at.y, &y.unit)];
    format!("{}{x}\n{y}", name.trim_start_matches('\n'))
}

/// An axis with its title; `few`, `all`: see [`LABELS`].
fn axis<'a>(hints: AxisHints<'a>, of: &Axis, [few, all]: [f32; 2]) -> AxisHints<'a> {
    hints
        .label(of.title())
        .formatter(|mark, _| tick(mark.value, mark.step_size))
        .label_spacing(Rangef::new(few, all))
}

/// Ticks at round numbers, at most so many.
fn marks((low, high): (f64, f64), most: usize) -> Vec<GridMark> {
    let step_size = step(high - low, most);
    let places = ticks([low, high], most).into_iter();
    let mark = |value| GridMark { value, step_size };
    places.map(mark).collect()
}

/// Text of a tick.
fn tick(value: f64, size: f64) -> String {
    let text = format!("{value:.*}", digits(size));
    if text == "-0" { "0".into() } else { text }
}

/// Adds what is drawn of a series.
fn items(place: usize, series: &Series, lines: &[Vec<[f64; 2]>], plot_ui: &mut PlotUi<'_>) {
    let [r, g, b] = series.color;
    let color = Color32::from_rgb(r, g, b);
    let name = series.name.as_str();
    match &series.data {
        Data::Line(_) => {
            let points = lines.get(place).map_or(&[][..], Vec::as_slice);
            // Each part between gaps is a line of its own.
            for part in points.split(|point| !point[1].is_finite()) {
                if !part.is_empty() {
                    let points = PlotPoints::new(part.to_vec());
                    plot_ui.line(Line::new(name, points).color(color).width(1.6));
                }
            }
        }
        Data::Bars(bars) => {
            let bars = bars.iter().map(|bar| {
                Bar::new((bar.from + bar.to) / 2.0, bar.height)
                    .width(bar.to - bar.from)
                    .fill(color.gamma_multiply(0.5))
                    .stroke(Stroke::new(1.0, color))
            });
            let height = |bar: &Bar, _: &BarChart| {
                let half = bar.bar_width / 2.0;
                let [low, high] = [bar.argument - half, bar.argument + half].map(significant);
                format!("{low} to {high}: {}", significant(bar.value))
            };
            let chart = BarChart::new(name, bars.collect()).element_formatter(Box::new(height));
            plot_ui.bar_chart(chart.color(color));
        }
        Data::Spans(spans) => {
            let bars = spans.iter().map(|span| {
                Bar::new(span.y, span.to - span.from)
                    .base_offset(span.from)
                    .width(THICK)
                    .fill(color)
            });
            let ends = |bar: &Bar, _: &BarChart| {
                let from = bar.base_offset.unwrap_or(0.0);
                let [from, to] = [from, from + bar.value].map(significant);
                format!("{from} to {to}")
            };
            let chart = BarChart::new(name, bars.collect()).element_formatter(Box::new(ends));
            plot_ui.bar_chart(chart.color(color).horizontal());
        }
        Data::Ticks { x, y } => {
            let bars = x.iter().map(|&x| {
                Bar::new(x, 2.0 * TICK)
                    .base_offset(y - TICK)
                    .width(0.0)
                    .stroke(Stroke::new(1.5, color))
            });
            let at = |bar: &Bar, _: &BarChart| significant(bar.argument);
            let chart = BarChart::new(name, bars.collect()).element_formatter(Box::new(at));
            plot_ui.bar_chart(chart.color(color));
        }
        _ => {}
    }
}
