//! The figures as a picture: one panel a scene, frame time over level, one curve a method.

use anyhow::anyhow;
use plotters::prelude::*;

use super::methods::{Method, Row};

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (360, 300);

/// Curves with their names and colors, which the color-blind can distinguish.
const CURVES: [(Method, &str, RGBColor); 3] = [
    (
        Method::Prerefined,
        "pre-refined",
        RGBColor(0xd5, 0x5e, 0x00),
    ),
    (
        Method::Homogeneous,
        "homogeneous, on the fly",
        RGBColor(0x00, 0x72, 0xb2),
    ),
    (
        Method::Adaptive,
        "adaptive, on the fly",
        RGBColor(0x00, 0x9e, 0x73),
    ),
];

/// Draws all scenes that have levels, as SVG.
pub(crate) fn svg(rows: &[Row]) -> anyhow::Result<String> {
    let mut scenes: Vec<u32> = with_level(rows).map(|(row, _)| row.neurons).collect();
    scenes.sort_unstable();
    scenes.dedup();
    let (columns, lines) = (scenes.len().clamp(1, 2), scenes.len().div_ceil(2).max(1));
    let size = (PANEL.0 * columns as u32, PANEL.1 * lines as u32);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).map_err(fault)?;
        for (area, neurons) in root.split_evenly((lines, columns)).iter().zip(&scenes) {
            panel(area, rows, *neurons)?;
        }
        root.present().map_err(fault)?;
    }
    Ok(text)
}

fn panel(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    rows: &[Row],
    neurons: u32,
) -> anyhow::Result<()> {
    let here: Vec<(&Row, u32)> = with_level(rows)
        .filter(|(r, _)| r.neurons == neurons)
        .collect();
    let times = || here.iter().map(|(row, _)| row.ms.max(1e-3));
    let (least, most) = (
        times().fold(f64::MAX, f64::min),
        times().fold(0.0, f64::max),
    );
    let highest = here.iter().map(|&(_, level)| level).max().unwrap_or(1);
    let lowest = here.iter().map(|&(_, level)| level).min().unwrap_or(1);
    let title = format!("{neurons} neuron{}", if neurons == 1 { "" } else { "s" });
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(34)
        .y_label_area_size(60)
        .build_cartesian_2d(
            f64::from(lowest) - 0.25..f64::from(highest) + 0.25,
            (0.5 * least..8.0 * most).log_scale(),
        )
        .map_err(fault)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("level")
        .y_desc("frame (ms)")
        .y_label_formatter(&|ms| format!("{ms}"))
        .x_labels(2 * (highest - lowest) as usize + 3)
        .x_label_formatter(&|level| whole(*level))
        .draw()
        .map_err(fault)?;
    for (method, name, color) in CURVES {
        let points: Vec<(f64, f64)> = here
            .iter()
            .filter(|(row, _)| row.method == method)
            .map(|&(row, level)| (f64::from(level), row.ms.max(1e-3)))
            .collect();
        let marks = points
            .iter()
            .map(|&point| Circle::new(point, 3, color.filled()));
        chart.draw_series(marks).map_err(fault)?;
        let line = LineSeries::new(points, color.stroke_width(2));
        let series = chart.draw_series(line).map_err(fault)?;
        series
            .label(name)
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

/// Label of a level; none between levels.
fn whole(level: f64) -> String {
    if (level - level.round()).abs() < 1e-6 {
        format!("{level:.0}")
    } else {
        String::new()
    }
}

fn with_level(rows: &[Row]) -> impl Iterator<Item = (&Row, u32)> {
    rows.iter().filter_map(|row| Some((row, row.level?)))
}

fn fault(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("cannot draw the plot ({error})")
}
