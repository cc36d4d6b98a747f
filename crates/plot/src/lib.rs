//! Plots of numbers: lines, bars, spans and ticks over two axes.
//!
//! A [`Plot`] is plain data. A window draws it, and files get the same one: [`Plot::svg`] for figures,
//! [`Plot::csv`] with all its numbers. [`of_measure`] makes the plots of what
//! [`neurotess_morphology`] measures.
//!
//! ```
//! use neurotess_plot::{Axis, Data, Plot, Series};
//!
//! let plot = Plot {
//!     title: "a cell".into(),
//!     x: Axis::new("time", "ms"),
//!     y: Axis::new("voltage", "mV"),
//!     series: vec![Series::new("soma", 0, Data::Line(vec![[0.0, -65.0], [0.5, -64.0]]))],
//! };
//! assert_eq!(plot.csv(), "time_ms,soma (mV)\n0,-65\n0.5,-64\n");
//! assert!(plot.svg([480, 320]).starts_with("<svg"));
//! ```
#![forbid(unsafe_code)]

mod csv;
mod measures;
mod panels;
mod scale;
mod svg;
mod thin;
mod ticks;

pub use measures::{Measure, SHOLL_STEP, TooMany, of_measure};
pub use panels::panels;
pub use thin::thinned;
pub use ticks::{digits, step, ticks};

/// Colors of series, which the color-blind can distinguish (Okabe and Ito, Color Universal Design, 2008), without those
/// that are hard to see on white or on black.
pub const COLORS: [[u8; 3]; 7] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0x80, 0x80, 0x80],
];

/// Numbers over two axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// Its title; empty: none.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What it shows, the first below the others.
    pub series: Vec<Series>,
}

/// What an axis is of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// What is measured.
    pub label: String,
    /// The unit; empty: none.
    pub unit: String,
    /// Whether equal ratios are equally far apart in figures; numbers of 0 and below are left out then.
    pub logarithmic: bool,
}

/// Numbers that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in legends.
    pub name: String,
    /// Its color (sRGB).
    pub color: [u8; 3],
    /// The numbers.
    pub data: Data,
}

/// Numbers, and how they are drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Data {
    /// A line through points, x ascending. It has a gap where y is no number.
    Line(Vec<[f64; 2]>),
    /// Points.
    Dots(Vec<[f64; 2]>),
    /// Bars that stand on 0.
    Bars(Vec<Bar>),
    /// Level lines.
    Spans(Vec<Span>),
    /// Short upright lines around a y, as of a raster of spikes.
    Ticks {
        /// Where they are, ascending.
        x: Vec<f64>,
        /// Their middle; they are 0.8 high.
        y: f64,
    },
}

/// A level line, as of a barcode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Where it begins on the horizontal axis.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Its place on the vertical axis.
    pub y: f64,
}

/// Half of the height of ticks.
pub const TICK: f64 = 0.4;

/// A bar of a histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Where it begins on the horizontal axis.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Its height.
    pub height: f64,
}

impl Axis {
    /// An axis.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            unit: unit.into(),
            logarithmic: false,
        }
    }

    /// The same with equal ratios equally far apart.
    #[must_use]
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// Whether a number has a place on it.
    fn holds(&self, n: f64) -> bool {
        n.is_finite() && (n > 0.0 || !self.logarithmic)
    }

    /// What is beside it: `time (ms)`.
    pub fn title(&self) -> String {
        match self.unit.is_empty() {
            true => self.label.clone(),
            false => format!("{} ({})", self.label, self.unit),
        }
    }
}

impl Series {
    /// A series with the color of this number of [`COLORS`], which begin again after the last.
    pub fn new(name: impl Into<String>, color: usize, data: Data) -> Self {
        Self {
            name: name.into(),
            color: COLORS[color % COLORS.len()],
            data,
        }
    }
}

impl Series {
    /// A line with a dot at each of its points, whose name only the line has.
    pub fn dotted(name: impl Into<String>, color: usize, points: Vec<[f64; 2]>) -> [Self; 2] {
        let dots = Self::new("", color, Data::Dots(points.clone()));
        [Self::new(name, color, Data::Line(points)), dots]
    }
}

impl Data {
    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Line(points) | Self::Dots(points) => points.is_empty(),
            Self::Bars(bars) => bars.is_empty(),
            Self::Spans(spans) => spans.is_empty(),
            Self::Ticks { x, .. } => x.is_empty(),
        }
    }

    fn for_each_point(&self, mut of: impl FnMut([f64; 2])) {
        match self {
            Self::Line(points) | Self::Dots(points) => {
                points.iter().for_each(|&point| of(point));
            }
            Self::Bars(bars) => bars.iter().for_each(|bar| {
                of([bar.from, 0.0]);
                of([bar.to, bar.height]);
            }),
            Self::Spans(spans) => spans.iter().for_each(|span| {
                of([span.from, span.y]);
                of([span.to, span.y]);
            }),
            Self::Ticks { x, y } => x.iter().for_each(|&x| {
                of([x, y - TICK]);
                of([x, y + TICK]);
            }),
        }
    }
}

impl Plot {
    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.series.iter().all(|series| series.data.is_empty())
    }

    /// Least and greatest x, and least and greatest y, of what is a number; none if nothing is.
    pub fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let mut bounds = [[f64::MAX, f64::MIN]; 2];
        for series in &self.series {
            series.data.for_each_point(|point| {
                if self.x.holds(point[0]) && self.y.holds(point[1]) {
                    for (bound, n) in bounds.iter_mut().zip(point) {
                        *bound = [bound[0].min(n), bound[1].max(n)];
                    }
                }
            });
        }
        (bounds[0][0] <= bounds[0][1]).then_some(bounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_hold_what_is_a_number() {
        let mut plot = Plot::default();
        assert_eq!((plot.bounds(), plot.is_empty()), (None, true));
        let line = Data::Line(vec![[0.0, 2.0], [1.0, f64::NAN], [2.0, -3.0]]);
        plot.series.push(Series::new("line", 0, line));
        let bar = Bar {
            from: 4.0,
            to: 5.0,
            height: 7.0,
        };
        plot.series
            .push(Series::new("bars", 8, Data::Bars(vec![bar])));
        assert_eq!(plot.bounds(), Some([[0.0, 5.0], [-3.0, 7.0]]));
        assert_eq!(plot.series[1].color, COLORS[1], "colors begin again");
    }
}
