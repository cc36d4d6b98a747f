//! Several plots in one figure.

use std::fmt::Write;

use crate::Plot;

/// Plots side by side, in rows of so many, as SVG; each of this size (pixels).
///
/// ```
/// use neurotess_plot::{Data, Plot, Series, panels};
///
/// let line = |end: f64| Series::new("", 0, Data::Line(vec![[0.0, 0.0], [1.0, end]]));
/// let plots = [1.0, 2.0, 3.0].map(|end| Plot { series: vec![line(end)], ..Plot::default() });
/// assert!(panels(&plots, 2, [300, 200]).contains("width=\"600\" height=\"400\""));
/// ```
pub fn panels(plots: &[Plot], columns: usize, size: [u32; 2]) -> String {
    let columns = columns.clamp(1, plots.len().max(1));
    let [width, height] = size.map(|n| f64::from(n.max(80)));
    let rows = plots.len().div_ceil(columns).max(1);
    let (whole, high) = (width * columns as f64, height * rows as f64);
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{whole}\" height=\"{high}\" viewBox=\"0 0 {whole} {high}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    );
    for (number, plot) in plots.iter().enumerate() {
        let (left, top) = (
            width * (number % columns) as f64,
            height * (number / columns) as f64,
        );
        let content = plot.svg_content([width, height]);
        let _ = match plots.len() {
            1 => write!(text, "{content}"),
            _ => writeln!(
                text,
                "<g transform=\"translate({left} {top})\">\n{content}</g>"
            ),
        };
    }
    text.push_str("</svg>\n");
    text
}
