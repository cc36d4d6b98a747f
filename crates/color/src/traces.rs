//! Values of single compartments over time.

use std::ops::Range;

use itertools::Itertools;
use neurotess_circuit::{Compartment, ReportPopulation, TimeAxis};
use neurotess_morphology::{Morphology, Program, SectionId, SectionNumbers, SectionPlace};

use crate::recording::{Recording, RecordingError, Source};

/// A compartment of a neuron in a report.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedCompartment {
    /// Its section; none: the soma.
    pub section: Option<SectionId>,
    /// Its middle along the section, from 0 to 1.
    pub along: f32,
    /// Its number in the section, from 0.
    pub number: usize,
    /// The middles of all compartments of the section.
    pub all: Vec<f32>,
    /// Index of the population in the report, and of the compartment there.
    population: usize,
    column: u64,
}

impl Recording {
    /// The compartment of a neuron that is nearest to a place along one of its sections (none: the soma); none if the report
    /// has none there. If the report has a single compartment of the neuron, it is that one. `morphology`: the neuron's
    /// tracing. Reads where the neuron's compartments are.
    ///
    /// # Errors
    /// The file is invalid.
    pub fn compartment(
        &self,
        instance: usize,
        morphology: &Morphology,
        section: Option<SectionId>,
        along: f32,
    ) -> Result<Option<TracedCompartment>, RecordingError> {
        let Source::Report(report, parts) = &self.source else {
            return Ok(None);
        };
        for (place, (population, part)) in report.populations.iter().zip_eq(parts).enumerate() {
            // Instances are in ascending order.
            let found = part.spans.binary_search_by_key(&instance, |(of, _)| *of);
            let Ok(found) = found else { continue };
            let row = part.rows[found];
            let own = population.compartments(row)?;
            let first = population.compartment_range(row).start;
            let numbers = SectionNumbers::of(morphology, Program::Neuron);
            let nearest = nearest(&own, &numbers, section, along);
            return Ok(nearest.map(|(index, section)| {
                let of_section = own.iter().filter(|c| c.section == own[index].section);
                let before = own[..index].iter();
                let ours = |compartment: &Compartment| match compartment.place(&numbers) {
                    Some(SectionPlace::Section(_, along)) => along,
                    _ => compartment.along,
                };
                TracedCompartment {
                    section,
                    along: ours(&own[index]),
                    number: before.filter(|c| c.section == own[index].section).count(),
                    all: of_section.map(ours).collect(),
                    population: place,
                    column: first + index as u64,
                }
            }));
        }
        Ok(None)
    }

    fn population(&self, of: &TracedCompartment) -> Option<&ReportPopulation> {
        match &self.source {
            Source::Report(report, _) => report.populations.get(of.population),
            Source::Spikes(..) | Source::Memory(_) => None,
        }
    }

    /// Times of the values of a compartment, and how many are stored together: blocks of as many, from a multiple of it on,
    /// are read at once.
    pub fn trace_axis(&self, of: &TracedCompartment) -> Option<(TimeAxis, u64)> {
        let population = self.population(of)?;
        Some((population.time, population.frames_together()))
    }

    /// Values of a compartment in these frames of its own time axis.
    ///
    /// # Errors
    /// The file is invalid, or ends before the frames.
    pub fn trace(
        &self,
        of: &TracedCompartment,
        frames: Range<u64>,
    ) -> Result<Vec<f32>, RecordingError> {
        match self.population(of) {
            Some(population) => Ok(population.series(frames, &[of.column])?),
            None => Ok(Vec::new()),
        }
    }

    /// The value of a compartment at a time (ms); none if there is none at that time.
    ///
    /// # Errors
    /// The file is invalid.
    pub fn value_of(
        &self,
        of: &TracedCompartment,
        time: f64,
    ) -> Result<Option<f32>, RecordingError> {
        let population = self.population(of);
        let frame = population.and_then(|p| Some((p, p.time.frame_at(time)?)));
        let Some((population, frame)) = frame else {
            return Ok(None);
        };
        Ok(population.values(frame, &[of.column])?.first().copied())
    }

    /// Times (ms) at which a neuron fires, ascending; none if this is a report.
    pub fn spikes_of(&self, instance: usize) -> Option<Vec<f64>> {
        let Source::Spikes(spikes, firing) = &self.source else {
            return None;
        };
        let mut times = Vec::new();
        for (population, instances) in spikes.populations.iter().zip_eq(firing) {
            let own = |(_, shown): &(&u64, &Vec<usize>)| shown.contains(&instance);
            let Some((&id, _)) = instances.iter().find(own) else {
                continue;
            };
            let all = population.times.iter().zip_eq(&population.nodes);
            times.extend(all.filter(|(_, node)| **node == id).map(|(time, _)| *time));
        }
        times.sort_by(f64::total_cmp);
        Some(times)
    }

    /// Whether a neuron has values.
    pub fn has_values_of(&self, instance: usize) -> bool {
        self.has_values.get(instance).copied().unwrap_or(false)
    }
}

/// The index of the nearest compartment of a section, and its section.
fn nearest(
    own: &[Compartment],
    numbers: &SectionNumbers,
    section: Option<SectionId>,
    along: f32,
) -> Option<(usize, Option<SectionId>)> {
    let place = |compartment: &Compartment| match compartment.place(numbers)? {
        SectionPlace::Soma => Some((None, compartment.along)),
        SectionPlace::Section(section, along) => Some((Some(section), along)),
    };
    if let [only] = own {
        return Some((0, place(only)?.0));
    }
    let all = own.iter().enumerate();
    let there = all.filter_map(|(index, compartment)| {
        let (of, there) = place(compartment)?;
        (of == section).then_some((index, (there - along).abs()))
    });
    let nearest = there.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map(|(index, _)| (index, section))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_of_the_nearest_compartment_of_its_section() {
        let text =
            b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 99 0 1 2\n4 2 0 -9 0 1 1\n5 2 0 -50 0 1 4\n";
        let read = neurotess_formats::swc::read_bytes(text, "cell", &Default::default());
        let cell = read.expect("a cell").morphology;
        let numbers = SectionNumbers::of(&cell, Program::Neuron);
        let at = |section, along| Compartment { section, along };
        // The axon, second in the file, is the first section of the report.
        let own = [at(0, 0.5), at(1, 0.5), at(2, 0.25), at(2, 0.75)];
        let of = |section: Option<u32>, along| {
            let section = section.map(SectionId);
            nearest(&own, &numbers, section, along).map(|(index, _)| index)
        };
        assert_eq!(of(None, 0.0), Some(0));
        assert_eq!(of(Some(1), 0.9), Some(1));
        assert_eq!(
            [0.1, 0.45, 0.6].map(|along| of(Some(0), along)),
            [2, 2, 3].map(Some)
        );
        assert_eq!(of(Some(7), 0.5), None);
        // A report of somata has one for the whole cell.
        let soma = nearest(&own[..1], &numbers, Some(SectionId(0)), 0.5);
        assert_eq!(soma, Some((0, None)));
    }
}
