//! A plot of a measure of the selected cells, in *Inspect*.

use std::sync::Arc;

use eframe::egui::{Color32, ComboBox, Id, RichText, Sense, Ui, vec2};
use neurotess::plot::Measure;

use crate::model::command::{Command, PlotOf};
use crate::model::state::State;
use crate::ui::panels::bars::traces::save_buttons;
use crate::ui::panels::widgets::number::field;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::plot::{self, PlotView};

/// Height of the plot for its width, and its least height.
const SHARE: f32 = 0.8;
const LEAST: f32 = 180.0;
/// Most cells that are named below a Sholl profile.
const NAMED: usize = 12;

/// The choice of a measure, and its plot.
pub(crate) fn show(state: &mut State, ui: &mut Ui) {
    let mut form = state.measures.form;
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.label("plot");
        let name = form.measure.map_or("none", Measure::name);
        let choice = ComboBox::from_id_salt("measure").selected_text(name);
        let shown = choice.show_ui(ui, |ui| {
            ui.selectable_value(&mut form.measure, None, "none");
            for (measure, name) in Measure::ALL {
                ui.selectable_value(&mut form.measure, Some(measure), name);
            }
        });
        shown.response.tip("Of the selected cells");
        if form.measure == Some(Measure::Sholl) {
            let spheres = field(ui, &mut form.step, 0.01..=10_000.0, 2, |field| {
                field.speed(0.1).suffix(" µm")
            });
            spheres.tip("Distance of the spheres");
        }
    });
    if form != state.measures.form {
        state.requests.push(Command::PlotMeasure(form));
    }
    if form.measure.is_some() {
        of_selection(state, ui);
    }
}

fn of_selection(state: &mut State, ui: &mut Ui) {
    let (plot, current) = match state.measure_plot() {
        None => {
            ui.spinner();
            return;
        }
        Some((Err(why), _)) => {
            let color = ui.visuals().warn_fg_color;
            ui.label(RichText::new(why).color(color).small());
            return;
        }
        Some((Ok(plot), current)) => (Arc::clone(plot), current),
    };
    ui.horizontal(|ui| {
        ui.weak(&plot.title);
        if !current {
            ui.spinner();
        }
    });
    if plot.is_empty() {
        ui.weak("These cells have none.");
        return;
    }
    let view = PlotView {
        // Each measure fits its own numbers.
        id: Id::unique(("measure", plot.x.title(), plot.y.title())),
        name: "Plot of measures",
        height: (SHARE * ui.available_width()).max(LEAST),
        moves: false,
        time: None,
    };
    plot::show(&plot, &view, ui);
    let named = plot.series.len() > 1 && plot.series.len() <= NAMED;
    for series in plot.series.iter().filter(|_| named) {
        let [r, g, b] = series.color;
        let color = Color32::from_rgb(r, g, b);
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(14.0, 4.0), Sense::hover());
            ui.painter().rect_filled(rect, 1.0, color);
            ui.label(&series.name);
        });
    }
    ui.horizontal(|ui| save_buttons(state, PlotOf::Measure, current, ui));
}
