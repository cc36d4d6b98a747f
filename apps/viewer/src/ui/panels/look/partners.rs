//! The paths from the synapse that was clicked to the somata of its two cells: over the picture, and in *Inspect*.

use eframe::egui::{Color32, Painter, Pos2, Rect, RichText, Stroke, Ui};

use crate::model::partners::Role;
use crate::model::state::State;
use crate::ui::panels::measured;
use crate::ui::panels::widgets::marks;
use crate::ui::panels::widgets::tip::Tip;

/// Widths (points) of a line and of its rim.
const LINE: f32 = 3.0;
const RIM: f32 = 1.6;

/// Told apart by color-blind eyes too, on light and dark ground (M. Okabe and K. Ito, Color Universal Design, 2008).
fn color(role: Role) -> Color32 {
    match role {
        Role::Presynaptic => Color32::from_rgb(230, 159, 0),
        Role::Postsynaptic => Color32::from_rgb(86, 180, 233),
    }
}

/// Draws the paths of the neurons that are shown.
pub(crate) fn show(state: &State, rect: Rect, painter: &Painter) {
    let camera = state.view.camera();
    let [r, g, b] = state.document.look.background;
    let rim = Color32::from_rgba_unmultiplied(r, g, b, 200);
    for path in state.partner_paths().iter() {
        if !state.document.neurons.shows(path.neuron) {
            continue;
        }
        let corners = path.corners.iter();
        let corners: Vec<Option<Pos2>> = corners.map(|&c| marks::at(&camera, rect, c)).collect();
        // Corners behind the eye have no place.
        for seen in corners.split(Option::is_none) {
            let line: Vec<Pos2> = seen.iter().copied().flatten().collect();
            if line.len() < 2 || !Rect::from_points(&line).intersects(rect.expand(50.0)) {
                continue;
            }
            painter.line(line.clone(), Stroke::new(LINE + 2.0 * RIM, rim));
            painter.line(line, Stroke::new(LINE, color(path.role)));
        }
    }
}

/// A line for each path in *Inspect*.
pub(crate) fn figures(state: &State, ui: &mut Ui) {
    for path in state.partner_paths().iter() {
        let Some(neuron) = state.document.neurons.get(path.neuron) else {
            continue;
        };
        let (what, role) = match path.role {
            Role::Presynaptic => ("axon", "presynaptic"),
            Role::Postsynaptic => ("dendrite", "postsynaptic"),
        };
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            ui.label(RichText::new("•").color(color(path.role)).strong());
            ui.label(RichText::new(&neuron.name).strong());
            let length = measured(path.length, "µm");
            let mut text = format!("{role}: {length} along the {what} to the soma");
            if path.length == 0.0 {
                text = format!("{role}: on the soma");
            }
            if path.gap > FAR {
                text.push_str(&format!(", {} away", measured(path.gap, "µm")));
            }
            ui.label(text).tip(
                "The path from the place of the cell that is nearest to the synapse. 'Away' is how far that is from it",
            );
        });
    }
}

/// A synapse is on the membrane if it is no farther (µm) from it.
const FAR: f64 = 0.5;
