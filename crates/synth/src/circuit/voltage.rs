//! Voltages that look like those of cells: rest, slow swings, action potentials that run outwards.
//!
//! **Theory.** No equation of the membrane is solved. An action potential is a fast rise and a slower
//! fall with an undershoot; at a distance d from the soma it comes d / 300 µm/ms later and is lower by
//! e^(−d / 400 µm). Rest is −65 mV, with swings of 3 mV that differ from cell to cell. Numbers by eye.

use neurotess_circuit::SpikePopulation;
use neurotess_morphology::shape::{path_lengths, section_lengths};
use neurotess_morphology::{Morphology, Program, SectionNumbers, SectionPlace};

/// Length of the simulation (ms).
pub const DURATION: f64 = 100.0;
/// Between two frames (ms).
pub const STEP: f64 = 0.5;

/// Resting potential (mV).
const REST: f64 = -65.0;
/// Height of an action potential in the soma (mV).
const HEIGHT: f64 = 95.0;
/// How fast it runs (µm/ms).
const SPEED: f64 = 300.0;
/// Where it has a third of its height (µm).
const REACH: f64 = 400.0;
/// Longest element (µm).
const ELEMENT: f64 = 100.0;

/// What a report has of one cell: numbers of the sections of its elements, and values, frame by frame.
pub struct Voltages {
    /// Number of the section of each element; 0 is the soma.
    pub sections: Vec<u32>,
    /// Values (mV): frames × elements.
    pub values: Vec<f32>,
}

/// The voltages of a cell that fires as these spikes say.
pub fn voltages(morphology: &Morphology, node: u64, spikes: &SpikePopulation) -> Voltages {
    let elements = elements(morphology);
    let fired = spikes.times.iter().zip(&spikes.nodes);
    let fired: Vec<f64> = fired
        .filter(|(_, n)| **n == node)
        .map(|(t, _)| *t)
        .collect();
    let frames = (DURATION / STEP).round() as u64;
    let phase = node as f64 * 0.618;
    let mut values = Vec::with_capacity(frames as usize * elements.len());
    for frame in 0..frames {
        let time = frame as f64 * STEP;
        for &(_, distance) in &elements {
            let swing = 3.0 * libm::sin(time / 11.0 + phase - distance / 500.0);
            let arrived = |fired: &f64| time - fired - distance / SPEED;
            let action: f64 = fired.iter().map(|f| action_potential(arrived(f))).sum();
            let lower = libm::exp(-distance / REACH);
            let voltage = REST + swing + (HEIGHT * lower * action).clamp(-15.0, HEIGHT);
            values.push(voltage as f32);
        }
    }
    Voltages {
        sections: elements.into_iter().map(|(section, _)| section).collect(),
        values,
    }
}

/// From 0 up to 1 within 0.3 ms, back in 1.5 ms, then a little below for some milliseconds.
fn action_potential(age: f64) -> f64 {
    match age {
        age if !(0.0..=30.0).contains(&age) => 0.0,
        age if age < 0.3 => age / 0.3,
        age => {
            let since = age - 0.3;
            1.15 * libm::exp(-since / 0.7) - 0.15 * libm::exp(-since / 5.0)
        }
    }
}

/// Elements in the order of reports: number of the section and distance from the soma (µm).
fn elements(morphology: &Morphology) -> Vec<(u32, f64)> {
    let numbers = SectionNumbers::of(morphology, Program::Neuron);
    let (lengths, ends) = (section_lengths(morphology), path_lengths(morphology));
    let mut elements = vec![(0, 0.0)];
    for number in numbers.numbers() {
        let count = (numbers.length(number).unwrap_or(0.0) / ELEMENT)
            .ceil()
            .max(1.0);
        for k in 0..count as u32 {
            let share = (f64::from(k) + 0.5) / count;
            if let Some(SectionPlace::Section(section, along)) = numbers.place(number, share as f32)
            {
                let (length, end) = (lengths[section.index()], ends[section.index()]);
                elements.push((number as u32, end - length * (1.0 - f64::from(along))));
            }
        }
    }
    elements
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Kind, Options, grow};

    #[test]
    fn voltages_are_those_of_a_cell_that_fires() {
        let cell = grow(&Options {
            points: Some(500),
            ..Options::new(Kind::Pyramidal, 1)
        });
        let spikes = SpikePopulation {
            name: "p".into(),
            times: vec![20.0, 20.0],
            nodes: vec![7, 8],
        };
        let made = voltages(&cell, 7, &spikes);
        let n = made.sections.len();
        assert_eq!(made.values.len(), 200 * n);
        assert!(made.values.iter().all(|v| (-85.0..=40.0).contains(v)));
        let soma = |time: f64| made.values[(time / STEP) as usize * n];
        assert!(soma(10.0) < -60.0 && soma(20.5) > 0.0, "{}", soma(20.5));
        // Elements follow the order of sections, and every section has one.
        assert!(made.sections.is_sorted());
        let distinct: std::collections::BTreeSet<_> = made.sections.iter().collect();
        assert_eq!(distinct.len(), cell.sections.len() + 1);
    }
}
