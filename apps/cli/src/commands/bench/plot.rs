//! The figures as a picture: one panel a scene, frame time over level, one curve a method.

use neurotess::plot::{Axis, Plot, Series, panels};

use super::methods::{Method, Row};

/// Size of a panel (pixels).
const PANEL: [u32; 2] = [480, 300];
/// Panels in a row.
const COLUMNS: usize = 2;

/// Curves with their names and the numbers of their colors.
const CURVES: [(Method, &str, usize); 3] = [
    (Method::Prerefined, "pre-refined", 1),
    (Method::Homogeneous, "homogeneous", 0),
    (Method::Adaptive, "adaptive", 2),
];

/// Draws all scenes that have levels, as SVG.
pub(crate) fn svg(rows: &[Row]) -> String {
    let mut scenes: Vec<u32> = with_level(rows).map(|(row, _)| row.neurons).collect();
    scenes.sort_unstable();
    scenes.dedup();
    let plots: Vec<Plot> = scenes
        .into_iter()
        .map(|neurons| plot(rows, neurons))
        .collect();
    panels(&plots, COLUMNS, PANEL)
}

fn plot(rows: &[Row], neurons: u32) -> Plot {
    let series = CURVES.iter().flat_map(|&(method, name, color)| {
        let shown = |(row, _): &(&Row, u32)| row.neurons == neurons && row.method == method;
        let points = with_level(rows).filter(shown);
        let points: Vec<[f64; 2]> = points
            .map(|(row, level)| [f64::from(level), row.ms])
            .collect();
        Series::dotted(name, color, points)
    });
    Plot {
        title: format!("{neurons} neuron{}", if neurons == 1 { "" } else { "s" }),
        x: Axis::new("level", ""),
        y: Axis::new("frame", "ms").logarithmic(),
        series: series.collect(),
    }
}

fn with_level(rows: &[Row]) -> impl Iterator<Item = (&Row, u32)> {
    rows.iter().filter_map(|row| Some((row, row.level?)))
}
