//! The plots of a run: figure 15 as `neurotess bench refinement` draws it, and times over the number of neurons.

use neurotess_plot::{Axis, Plot, Series, panels};
use serde_json::Value;

use super::goals::rows;
use super::results::Results;

/// Size of a panel (pixels).
const PANEL: [u32; 2] = [480, 300];

/// A curve: its name, and its points.
type Curve = (&'static str, Vec<[f64; 2]>);

/// Draws what the parts so far have figures for.
pub(crate) fn draw(results: &mut Results) {
    let mut parts = results.parts.iter_mut();
    let refinement = parts.find(|part| part.name == "refinement");
    let figures = refinement.and_then(|part| part.figures.as_object_mut());
    // It is kept once.
    if let Some(Value::String(svg)) = figures.and_then(|figures| figures.remove("plot")) {
        results.plots.insert("refinement".into(), svg);
    }
    let plots: Vec<Plot> = curves(results).into_iter().map(plot).collect();
    if !plots.is_empty() {
        let svg = panels(&plots, plots.len(), PANEL);
        results.plots.insert("neurons".into(), svg);
    }
}

fn plot((title, curves): (&str, Vec<Curve>)) -> Plot {
    let curves = curves.into_iter().enumerate();
    Plot {
        title: title.to_owned(),
        x: Axis::new("neurons", "").logarithmic(),
        y: Axis::new("time", "ms").logarithmic(),
        series: curves
            .flat_map(|(color, (name, points))| Series::dotted(name, color, points))
            .collect(),
    }
}

/// Titles and curves over the number of neurons.
fn curves(results: &Results) -> Vec<(&'static str, Vec<Curve>)> {
    let curve = |part: &str, of: fn(&Value) -> Option<f64>| -> Vec<[f64; 2]> {
        let rows = results.figures(part).map(|figures| rows(figures, "rows"));
        let point = |row: &Value| Some([row["neurons"].as_f64()?, of(row)?]);
        rows.iter().flatten().filter_map(point).collect()
    };
    let panels = [
        (
            "exploration within a budget",
            vec![
                (
                    "waited",
                    curve("exploration", |row| row["exploration"]["waited"].as_f64()),
                ),
                (
                    "of it choosing",
                    curve("exploration", |row| row["exploration"]["choose"].as_f64()),
                ),
                (
                    "of it drawing",
                    curve("exploration", |row| row["exploration"]["draw"].as_f64()),
                ),
            ],
        ),
        (
            "a picture of a recording",
            vec![
                (
                    "colored anew",
                    curve("recording", |row| row["recolored_ms"].as_f64()),
                ),
                (
                    "drawn anew",
                    curve("recording", |row| row["drawn_ms"].as_f64()),
                ),
            ],
        ),
    ];
    let mut panels: Vec<_> = panels.into();
    for (_, curves) in &mut panels {
        curves.retain(|(_, points)| !points.is_empty());
    }
    panels.retain(|(_, curves)| !curves.is_empty());
    panels
}
