//! What was traced of somata, drawn over their surfaces: outlines, and circles around samples with radii.

use eframe::egui::{Color32, Painter, Pos2, Rect, Stroke};
use glam::DVec3;
use neurotess::morphology::{Soma, SomaKind};

use crate::model::command::Tab;
use crate::model::state::State;
use crate::ui::panels::widgets::marks::Projection;

/// Neurons whose somata are drawn, at most: of more, lines hide each other.
const MAX_NEURONS: usize = 100;
/// Corners of a circle.
const CORNERS: usize = 64;

/// Draws what was traced of the somata that the panel *Soma* is about, while it shows.
pub(crate) fn show(state: &State, rect: Rect, painter: &Painter) {
    let layout = &state.layout;
    if !(layout.traced_somata && layout.panels && layout.tab == Tab::Soma) {
        return;
    }
    let (placements, neurons) = (state.placements(), &state.document.neurons);
    let camera = state.view.camera();
    let axes = camera.axes();
    let shown = neurons.iter().zip(placements.iter()).enumerate();
    let selected = neurons.selected();
    let is_meant = |neuron: usize| selected.is_empty() || selected.contains(neuron);
    let shown = shown.filter(|(index, _)| is_meant(*index) && neurons.shows(*index));
    for (_, (neuron, placement)) in shown.take(MAX_NEURONS) {
        let Some(source) = state.sources.get(neuron.source) else {
            continue;
        };
        let projection = Projection {
            camera,
            rect,
            placement,
            origin: source.traced.origin,
        };
        // Towards the right and up in the picture, in the cell's own directions.
        let back = placement.rotation.inverse();
        let across = [back * axes[0], back * axes[1]];
        for line in source
            .traced
            .somata
            .iter()
            .flat_map(|soma| lines(soma, across))
        {
            let points: Option<Vec<Pos2>> = line.iter().map(|&p| projection.at(p)).collect();
            if let Some(points) = points {
                painter.line(
                    points.clone(),
                    Stroke::new(4.0, Color32::from_white_alpha(140)),
                );
                painter.line(points, Stroke::new(1.6, Color32::from_rgb(208, 32, 48)));
            }
        }
    }
}

/// Closed lines (µm, relative to the morphology's origin) of what was traced.
fn lines(soma: &Soma, across: [DVec3; 2]) -> Vec<Vec<DVec3>> {
    let outlines = soma.outlines();
    if !outlines.is_empty() {
        let closed = |mut outline: Vec<DVec3>| {
            outline.extend(outline.first().copied());
            outline
        };
        return outlines.into_iter().map(closed).collect();
    }
    let circle = |center: DVec3, radius: f64| {
        let corner = |i: usize| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
            center + (across[0] * cos + across[1] * sin) * radius
        };
        (0..=CORNERS).map(corner).collect()
    };
    match soma.kind {
        SomaKind::Cylinders => (soma.samples.iter())
            .map(|sample| circle(sample.position.as_dvec3(), sample.radius.into()))
            .collect(),
        SomaKind::Point | SomaKind::ThreePoint | SomaKind::Contour | SomaKind::Surface => {
            vec![circle(soma.center.as_dvec3(), soma.radius.into())]
        }
    }
}

#[cfg(test)]
mod tests {
    use neurotess::formats::{ReadOptions, asc, swc};

    use super::*;

    fn lines_of(soma: &Soma) -> Vec<Vec<DVec3>> {
        lines(soma, [DVec3::X, DVec3::Y])
    }

    #[test]
    fn outlines_are_closed_and_samples_have_circles() {
        let options = ReadOptions::default();
        let outline = "(\"CellBody\" (CellBody) (6 0 0 0) (0 4 0 0) (-6 0 0 0) (0 -4 0 0))";
        let outlined = asc::read_bytes(outline.as_bytes(), "cell.asc", &options).expect("a cell");
        let [line] = &lines_of(&outlined.morphology.somata[0])[..] else {
            panic!("one outline");
        };
        assert_eq!((line.len(), line[0]), (5, line[4]));
        let cylinders = b"1 1 0 0 0 3 -1\n2 1 8 0 0 2 1\n3 1 15 0 0 1 2\n";
        let cylinders = swc::read_bytes(cylinders, "cell.swc", &options).expect("a cell");
        let circles = lines_of(&cylinders.morphology.somata[0]);
        assert_eq!(circles.len(), 3);
        let far = circles.iter().flatten().map(|p| p.y);
        assert!((far.fold(0.0, f64::max) - 3.0).abs() < 0.01);
    }
}
