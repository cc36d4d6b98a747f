//! Plots of what the tracings of cells measure, with the numbers of [`neurotess_morphology`].

use neurotess_morphology::barcode::barcode;
use neurotess_morphology::sholl::{self, TooManySpheres};
use neurotess_morphology::{Morphology, shape};

use crate::{Axis, Bar, Data, Plot, Series, Span, step};

/// Usual distance (µm) of the spheres of a Sholl profile.
pub const SHOLL_STEP: f64 = 10.0;
/// Fewest and most bins of a histogram.
const BINS: [f64; 2] = [6.0, 40.0];
/// Width of the bins of angles (degrees).
const ANGLE_BIN: f64 = 10.0;
/// Most cells whose Sholl profiles are drawn.
const MOST: usize = 500;

/// What is measured of cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Measure {
    /// How often neurites cross spheres around the soma, a line for each cell ([`sholl::crossings`]).
    #[default]
    Sholl,
    /// Path lengths from the neurite's first point to the ends of its sections ([`shape::path_lengths`]).
    PathLengths,
    /// Angles between the two branches of forks, to their first points and to their ends
    /// ([`shape::fork_angles`]).
    ForkAngles,
    /// Diameters of traced points.
    Diameters,
    /// The persistence barcode ([`barcode`](fn@barcode)): a bar for each end.
    Barcode,
}

impl Measure {
    /// All of them, with their names.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Sholl, "Sholl profile"),
        (Self::PathLengths, "Path lengths"),
        (Self::ForkAngles, "Fork angles"),
        (Self::Diameters, "Diameters"),
        (Self::Barcode, "Persistence barcode"),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        let mut all = Self::ALL.into_iter();
        all.find(|(measure, _)| *measure == self)
            .map_or("", |(_, name)| name)
    }
}

/// The spheres of a Sholl profile are too many.
pub type TooMany = TooManySpheres;

/// The plot of a measure of cells. Sholl profiles have a line for each cell, of at most 500 cells; the numbers of all other
/// measures are those of all cells together. `step` (µm, above 0): distance of the spheres of Sholl profiles.
///
/// # Errors
/// [`TooMany`] spheres.
///
/// # Panics
/// If `step` is not above 0.
pub fn of_measure(
    measure: Measure,
    cells: &[(&str, &Morphology)],
    step: f64,
) -> Result<Plot, TooMany> {
    let title = match cells {
        [(name, _)] => format!("{}: {name}", measure.name()),
        cells => format!("{}: {} cells", measure.name(), cells.len()),
    };
    let morphologies: Vec<&Morphology> = cells.iter().map(|(_, morphology)| *morphology).collect();
    let all = || morphologies.iter().copied();
    let (x, y, series) = match measure {
        Measure::Sholl => (
            Axis::new("distance from the soma", "µm"),
            Axis::new("crossings", ""),
            profiles(cells, step)?,
        ),
        Measure::PathLengths => (
            Axis::new("path length to the section's end", "µm"),
            Axis::new("sections", ""),
            vec![histogram(all().flat_map(shape::path_lengths))],
        ),
        Measure::ForkAngles => (
            Axis::new("angle", "°"),
            Axis::new("forks", ""),
            angles(&morphologies),
        ),
        Measure::Diameters => (
            Axis::new("diameter", "µm"),
            Axis::new("points", ""),
            vec![histogram(all().flat_map(|morphology| {
                let points = morphology.points.iter();
                points.map(|point| 2.0 * f64::from(point.radius))
            }))],
        ),
        Measure::Barcode => (
            Axis::new("distance from the soma", "µm"),
            Axis::new("bar", ""),
            vec![bars(all())],
        ),
    };
    Ok(Plot {
        title,
        x,
        y,
        series: series.into_iter().filter(|s| !s.data.is_empty()).collect(),
    })
}

fn profiles(cells: &[(&str, &Morphology)], step: f64) -> Result<Vec<Series>, TooMany> {
    let profile = |(color, (name, morphology)): (usize, &(&str, &Morphology))| {
        let sections = 0..morphology.sections.len() as u32;
        let crossings = sholl::crossings(morphology, step, sections)?;
        let points = (1..).zip(crossings);
        let points = points.map(|(k, count)| [f64::from(k) * step, count as f64]);
        Ok(Series::new(*name, color, Data::Line(points.collect())))
    };
    cells.iter().take(MOST).enumerate().map(profile).collect()
}

/// Bars of numbers of these values, in bins at round numbers; none without values.
fn histogram(values: impl Iterator<Item = f64>) -> Series {
    let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    let (low, high) = (values.iter().copied()).fold((f64::MAX, f64::MIN), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let bins = (values.len() as f64).sqrt().clamp(BINS[0], BINS[1]);
    let width = step(high - low, bins as usize);
    Series::new("", 0, Data::Bars(binned(&values, width)))
}

fn angles(cells: &[&Morphology]) -> Vec<Series> {
    let of = |reach: f64| -> Vec<f64> {
        let angles = cells
            .iter()
            .flat_map(|cell| shape::fork_angles(cell, reach));
        angles.flatten().map(f64::to_degrees).collect()
    };
    let kinds = [
        ("to the first points", shape::LOCAL),
        ("to the ends", shape::REMOTE),
    ];
    let series = |(color, (name, reach)): (usize, (&str, f64))| {
        Series::new(name, color, Data::Bars(binned(&of(reach), ANGLE_BIN)))
    };
    kinds.into_iter().enumerate().map(series).collect()
}

/// How many values are in each bin of this width; bins begin at its multiples.
fn binned(values: &[f64], width: f64) -> Vec<Bar> {
    let bin = |value: &f64| (value / width + 1e-9).floor() as i64;
    let bins = values.iter().map(bin);
    let (Some(first), Some(last)) = (bins.clone().min(), bins.clone().max()) else {
        return Vec::new();
    };
    let mut counts = vec![0_u64; (last - first + 1) as usize];
    bins.for_each(|bin| counts[(bin - first) as usize] += 1);
    let bars = (first..).zip(counts).map(|(bin, count)| Bar {
        from: bin as f64 * width,
        to: (bin + 1) as f64 * width,
        height: count as f64,
    });
    bars.collect()
}

/// The barcode with the longest bar at the bottom.
fn bars<'a>(cells: impl Iterator<Item = &'a Morphology>) -> Series {
    let of = |morphology: &'a Morphology| {
        let center = sholl::center(morphology).unwrap_or_default();
        barcode(morphology, center)
    };
    let bars = cells.flat_map(of);
    let mut ends: Vec<[f64; 2]> = bars.map(|b| [b.fork_distance, b.end_distance]).collect();
    let length = |ends: &[f64; 2]| (ends[1] - ends[0]).abs();
    ends.sort_by(|a, b| length(b).total_cmp(&length(a)).then(a[0].total_cmp(&b[0])));
    let spans = (1..).zip(ends).map(|(bar, [from, to])| Span {
        from,
        to,
        y: f64::from(bar),
    });
    Series::new("", 0, Data::Spans(spans.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use neurotess_morphology::{NeuriteKind, Node};

    /// A trunk of 10 µm with a right angle between its branches of 20 and 10 µm.
    fn cell() -> Morphology {
        let row = |id: i64, x: f64, y: f64, parent| Node {
            id,
            kind: NeuriteKind::AXON,
            position: DVec3::new(x, y, 0.0),
            radius: if id == 1 { 2.0 } else { 0.5 },
            parent,
            section: None,
        };
        let nodes = [
            row(1, 0.0, 0.0, None),
            row(2, 10.0, 0.0, Some(0)),
            row(3, 30.0, 0.0, Some(1)),
            row(4, 10.0, 10.0, Some(1)),
        ];
        let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
        built.expect("built").morphology
    }

    fn data(measure: Measure) -> Vec<Data> {
        let cell = cell();
        let plot = of_measure(measure, &[("cell", &cell)], 5.0).expect("few spheres");
        assert_eq!(plot.title, format!("{}: cell", measure.name()));
        plot.series.into_iter().map(|series| series.data).collect()
    }

    fn heights(data: &Data) -> Vec<[f64; 2]> {
        match data {
            Data::Bars(bars) => {
                let filled = bars.iter().filter(|bar| bar.height > 0.0);
                filled.map(|bar| [bar.from, bar.height]).collect()
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn plots_have_the_numbers_of_the_measures() {
        let cell = cell();
        let [Data::Line(profile)] = &data(Measure::Sholl)[..] else {
            panic!("a line");
        };
        let crossings = sholl::crossings(&cell, 5.0, 0..3).expect("few");
        let counts: Vec<u64> = profile.iter().map(|p| p[1] as u64).collect();
        assert_eq!((counts, profile[1][0]), (crossings, 10.0));
        let paths = data(Measure::PathLengths);
        assert_eq!(heights(&paths[0]), [[10.0, 1.0], [20.0, 1.0], [30.0, 1.0]]);
        let angles = data(Measure::ForkAngles);
        assert_eq!(angles.len(), 2);
        assert_eq!(heights(&angles[1]), [[90.0, 1.0]]);
        assert_eq!(
            heights(&data(Measure::Diameters)[0]),
            [[1.0, 3.0], [4.0, 1.0]]
        );
        let [Data::Spans(bars)] = &data(Measure::Barcode)[..] else {
            panic!("bars");
        };
        assert_eq!([bars[0].from, bars[0].to, bars[0].y], [0.0, 30.0, 1.0]);
        assert_eq!(bars.len(), 2);
    }

    #[test]
    fn cells_without_forks_have_no_angles_and_many_cells_one_histogram() {
        let none = Morphology::default();
        for (measure, _) in Measure::ALL {
            let plot = of_measure(measure, &[("none", &none)], 5.0).expect("none");
            assert!(plot.is_empty(), "{measure:?}");
        }
        let cell = cell();
        let both = [("a", &cell), ("b", &cell)];
        let plot = |measure| of_measure(measure, &both, 5.0).expect("few");
        assert_eq!(plot(Measure::Sholl).series.len(), 2);
        let paths = plot(Measure::PathLengths);
        assert_eq!(paths.title, "Path lengths: 2 cells");
        assert_eq!(heights(&paths.series[0].data)[0], [10.0, 2.0]);
        assert!(of_measure(Measure::Sholl, &both, 1e-9).is_err());
    }
}
