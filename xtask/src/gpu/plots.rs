//! The plots of a run: figure 15 as `neurotess bench refinement` draws it, and times over the number of neurons.

use plotters::coord::Shift;
use plotters::prelude::*;
use serde_json::Value;

use super::goals::rows;
use super::results::Results;

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (400, 300);

/// A curve: its name, and its points.
type Curve = (&'static str, Vec<(f64, f64)>);

/// Colors that the color-blind can distinguish (Okabe and Ito, Color Universal Design, 2008).
const COLORS: [RGBColor; 3] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
];

/// Draws what the parts so far have figures for.
pub(crate) fn draw(results: &mut Results) -> anyhow::Result<()> {
    let mut parts = results.parts.iter_mut();
    let refinement = parts.find(|part| part.name == "refinement");
    let figures = refinement.and_then(|part| part.figures.as_object_mut());
    // It is kept once.
    if let Some(Value::String(svg)) = figures.and_then(|figures| figures.remove("plot")) {
        results.plots.insert("refinement".into(), svg);
    }
    let panels = panels(results);
    if !panels.is_empty() {
        results.plots.insert("neurons".into(), svg(&panels)?);
    }
    Ok(())
}

/// Titles and curves over the number of neurons.
fn panels(results: &Results) -> Vec<(&'static str, Vec<Curve>)> {
    let curve = |part: &str, of: fn(&Value) -> Option<f64>| -> Vec<(f64, f64)> {
        let rows = results.figures(part).map(|figures| rows(figures, "rows"));
        let point = |row: &Value| Some((row["neurons"].as_f64()?, of(row)?));
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

fn svg(panels: &[(&str, Vec<Curve>)]) -> anyhow::Result<String> {
    let mut text = String::new();
    {
        let size = (PANEL.0 * panels.len() as u32, PANEL.1);
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).map_err(fault)?;
        let areas = root.split_evenly((1, panels.len()));
        for (area, (title, curves)) in areas.iter().zip(panels) {
            panel(area, title, curves)?;
        }
        root.present().map_err(fault)?;
    }
    Ok(text)
}

fn panel(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    title: &str,
    curves: &[Curve],
) -> anyhow::Result<()> {
    let points = || curves.iter().flat_map(|(_, points)| points);
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = points().map(of).map(|value| value.max(1e-3));
        (
            values.clone().fold(f64::MAX, f64::min),
            values.fold(0.0, f64::max),
        )
    };
    let ((left, right), (low, high)) = (range(|point| point.0), range(|point| point.1));
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(34)
        .y_label_area_size(60)
        .build_cartesian_2d(
            (left / 1.5..right * 1.5).log_scale(),
            (low / 2.0..high * 8.0).log_scale(),
        )
        .map_err(fault)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("neurons")
        .y_desc("ms")
        .x_labels(5)
        .y_labels(6)
        .x_label_formatter(&|neurons| format!("{neurons:.0}"))
        .y_label_formatter(&|ms| format!("{ms}"))
        .draw()
        .map_err(fault)?;
    for ((name, points), color) in curves.iter().zip(COLORS) {
        let points = || points.iter().map(|&(x, y)| (x, y.max(1e-3)));
        let marks = points().map(|point| Circle::new(point, 3, color.filled()));
        chart.draw_series(marks).map_err(fault)?;
        let line = LineSeries::new(points(), color.stroke_width(2));
        let series = chart.draw_series(line).map_err(fault)?;
        series
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .draw()
        .map_err(fault)?;
    Ok(())
}

fn fault(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow::anyhow!("cannot draw the plot ({error})")
}
