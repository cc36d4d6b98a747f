//! Values along a line, smoothed by a given length.
//!
//! With the spacing of samples as weights, the spline's sum is an integral, and far from the ends the spline is
//! the values under the kernel e^(−|t|/λ) (cos(t/λ) + sin(|t|/λ)) / (2λ), where α = λ⁴/4 (Silverman, Spline
//! Smoothing: The Equivalent Variable Kernel Method, 1984). At a distance of λ the kernel is 0.51 of what it is
//! in its middle. A wave of length Λ keeps 1 / (1 + (2πλ/Λ)⁴ / 4) of its height.
//!
//! Samples that are much denser than λ share a knot: between knots that are 10,000 to a λ, or unequal
//! by as much, the equations of the spline are lost in rounding.

use std::ops::Range;

use super::spline::Spline;

/// Knots are at least this share of the smoothing length apart; sharing moves a circle of radius λ by less
/// than 10⁻⁵ of that.
const KNOTS_APART: f64 = 0.01;
/// A smoothing length of more than so many lengths of the line changes nothing: an arc keeps 5·10⁻⁴ of its
/// height.
const MAX_LINES: f64 = 3.0;
/// Samples nearer than this share of the line are in one place, however short the smoothing length.
const IN_ONE_PLACE: f64 = 1e-12;

/// Places of samples on a line, and the spline that smooths their values.
#[derive(Debug)]
pub(super) struct Line {
    /// Distance of each sample from the first.
    places: Vec<f64>,
    sharing: Sharing,
    /// Places of the knots.
    knots: Vec<f64>,
    spline: Spline,
}

/// Which samples share a knot.
#[derive(Debug)]
struct Sharing {
    /// Samples of each knot.
    samples: Vec<Range<usize>>,
    /// Length of the line that is nearer to a sample than to others.
    weights: Vec<f64>,
    /// Whether the first value is held; the last one always is.
    first_held: bool,
}

impl Line {
    /// For samples that are `steps` apart, smoothed by the `length` λ; none where all are in one place or
    /// too far apart for numbers. The last value is held, and the first if `first_held`.
    pub(super) fn new(steps: &[f64], length: f64, first_held: bool) -> Option<Self> {
        let places = sums(steps);
        let line = places
            .last()
            .copied()
            .filter(|&line| line > 0.0 && line.is_finite())?;
        let length = length.min(MAX_LINES * line);
        let sharing = Sharing {
            samples: near_one_another(&places, (KNOTS_APART * length).max(IN_ONE_PLACE * line)),
            weights: weights(steps),
            first_held,
        };
        let knots = sharing.means(&places);
        let between = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let spline = Spline::new(between, sharing.give(0.25 * length.powi(4)));
        Some(Self {
            places,
            sharing,
            knots,
            spline,
        })
    }

    /// Smooths values, one for each sample.
    pub(super) fn smooth(&self, values: &mut [f64]) {
        let fit = self.spline.fit(&self.sharing.means(values));
        let free = usize::from(self.sharing.first_held)..values.len() - 1;
        let mut left = 0;
        for i in free {
            let place = self.places[i];
            while left + 2 < self.knots.len() && self.knots[left + 1] < place {
                left += 1;
            }
            let [from, to] = [self.knots[left], self.knots[left + 1]];
            values[i] = fit.between(left, place - from, to - place);
        }
    }
}

impl Sharing {
    fn is_held(&self, knot: usize) -> bool {
        knot + 1 == self.samples.len() || (knot == 0 && self.first_held)
    }

    /// α/w of each knot.
    fn give(&self, alpha: f64) -> Vec<f64> {
        let give = |(knot, samples): (usize, &Range<usize>)| {
            if self.is_held(knot) {
                return 0.0;
            }
            let weight: f64 = self.weights[samples.clone()].iter().sum();
            alpha / weight
        };
        self.samples.iter().enumerate().map(give).collect()
    }

    /// Value of each knot: the one that is held, or the mean of its samples.
    fn means(&self, values: &[f64]) -> Vec<f64> {
        let mean = |(knot, samples): (usize, &Range<usize>)| {
            let own = &values[samples.clone()];
            if own.len() == 1 || self.is_held(knot) {
                return if knot == 0 {
                    own[0]
                } else {
                    own[own.len() - 1]
                };
            }
            let weights = &self.weights[samples.clone()];
            let sum: f64 = own
                .iter()
                .zip(weights)
                .map(|(value, weight)| value * weight)
                .sum();
            sum / weights.iter().sum::<f64>()
        };
        self.samples.iter().enumerate().map(mean).collect()
    }
}

/// From steps to distances from the first sample.
fn sums(steps: &[f64]) -> Vec<f64> {
    let mut place = 0.0;
    let places = steps.iter().map(|step| {
        place += step;
        place
    });
    std::iter::once(0.0).chain(places).collect()
}

/// Half the steps before and after each sample.
fn weights(steps: &[f64]) -> Vec<f64> {
    let before = std::iter::once(&0.0).chain(steps);
    let after = steps.iter().chain([&0.0]);
    before
        .zip(after)
        .map(|(before, after)| 0.5 * (before + after))
        .collect()
}

/// Samples that share a knot: those less than `apart` from the first of them, and at the end of the line those
/// less than that from its end.
fn near_one_another(places: &[f64], apart: f64) -> Vec<Range<usize>> {
    let end = places.len() - 1;
    let last = places[..end].partition_point(|place| places[end] - place >= apart);
    let mut samples = Vec::new();
    let mut first = 0;
    for i in 1..=last {
        if i == last || places[i] - places[first] >= apart {
            samples.push(first..i);
            first = i;
        }
    }
    samples.push(first..places.len());
    samples
}
