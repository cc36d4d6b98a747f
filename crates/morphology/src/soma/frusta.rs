//! Measures of somata that were traced as frusta along linked samples.

use std::f64::consts::PI;

use crate::SomaSample;
use crate::frustum::{frustum_area, frustum_volume};

/// A chain is short, and stands for a ball, where it is no longer than so many of its radii: that of NEURON's, LFPy's and
/// NeuroML's usual soma has two, and files are rounded.
const SHORT: f64 = 2.1;
/// Least radius of such a chain, as a share of its greatest: cones are no balls.
const EVEN: f64 = 0.5;

/// Side and volume of the frusta.
pub(super) fn area_volume(samples: &[SomaSample]) -> (f64, f64) {
    let sum = |of: fn(f32, f32, f64) -> f64| -> f64 {
        links(samples)
            .map(|(a, b)| of(a.radius, b.radius, length(a, b)))
            .sum()
    };
    (sum(frustum_area), sum(frustum_volume))
}

/// Radius of the sphere that stands for frusta: that with the area of their sides and of the ends' faces, but of a short
/// chain no more than its own; where they have no area, the thickest sample's.
pub(super) fn radius(samples: &[SomaSample]) -> f64 {
    let (side, _) = area_volume(samples);
    if side > 0.0 {
        let links = link_counts(samples);
        let ends = samples.iter().zip(links).filter(|(_, links)| *links == 1);
        let faces: f64 = ends
            .map(|(end, _)| PI * f64::from(end.radius.max(0.0)).powi(2))
            .sum();
        let whole = ((side + faces) / 4.0 / PI).sqrt();
        return short_chain(samples).map_or(whole, |own| own.min(whole));
    }
    let radii = samples.iter().map(|sample| f64::from(sample.radius));
    radii.fold(0.0, f64::max)
}

/// Whether no sample has more than two others linked to it.
pub(super) fn is_chain(samples: &[SomaSample]) -> bool {
    link_counts(samples).into_iter().all(|links| links < 3)
}

/// The mean radius of a chain that is so short that it stands for a ball.
pub(super) fn short_chain(samples: &[SomaSample]) -> Option<f64> {
    if samples.len() < 2 || !is_chain(samples) {
        return None;
    }
    let all: f64 = links(samples).map(|(a, b)| length(a, b)).sum();
    let weighed = |(a, b)| length(a, b) * f64::midpoint(f64::from(a.radius), f64::from(b.radius));
    let mean = links(samples)
        .map(|(a, b): (&SomaSample, &SomaSample)| weighed((a, b)))
        .sum::<f64>()
        / all;
    let radii = || samples.iter().map(|sample| f64::from(sample.radius));
    let (least, most) = (
        radii().fold(f64::INFINITY, f64::min),
        radii().fold(0.0, f64::max),
    );
    (all > 0.0 && all <= SHORT * mean && least >= EVEN * most).then_some(mean)
}

fn link_counts(samples: &[SomaSample]) -> Vec<u32> {
    let mut counts = vec![0; samples.len()];
    for (index, parent) in samples
        .iter()
        .enumerate()
        .filter_map(|(i, s)| Some((i, s.parent?)))
    {
        counts[index] += 1;
        counts[parent as usize] += 1;
    }
    counts
}

fn links(samples: &[SomaSample]) -> impl Iterator<Item = (&SomaSample, &SomaSample)> {
    samples
        .iter()
        .filter_map(|s| Some((&samples[s.parent? as usize], s)))
}

fn length(a: &SomaSample, b: &SomaSample) -> f64 {
    a.position.as_dvec3().distance(b.position.as_dvec3())
}
