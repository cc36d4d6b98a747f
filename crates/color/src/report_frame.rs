//! Values of neurons at one time.

use std::ops::Range;

use neurotess_circuit::{CircuitError, ReportPopulation};
use neurotess_picture::color::InstanceValues;

/// Values of one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportFrame {
    values: Vec<f32>,
    of_instance: Vec<Range<usize>>,
}

/// The instances that show neurons of a report's population, and their compartments.
#[derive(Debug, Default)]
pub(crate) struct PopulationMatch {
    /// Compartments of all instances, one after another.
    pub(crate) compartments: Vec<u64>,
    /// Instances, each with the range of its compartments in the list.
    pub(crate) spans: Vec<(usize, Range<usize>)>,
    /// Of each of these instances its place among the population's nodes.
    pub(crate) rows: Vec<usize>,
}

impl ReportFrame {
    pub(super) fn none(instances: usize) -> Self {
        Self {
            values: Vec::new(),
            of_instance: vec![0..0; instances],
        }
    }

    pub(super) fn put(&mut self, instance: usize, values: impl IntoIterator<Item = f32>) {
        let start = self.values.len();
        self.values.extend(values);
        self.of_instance[instance] = start..self.values.len();
    }

    pub(super) fn read(
        &mut self,
        population: &ReportPopulation,
        part: &PopulationMatch,
        frame: u64,
        shows: &dyn Fn(usize) -> bool,
    ) -> Result<(), CircuitError> {
        let shown = || part.spans.iter().filter(|(instance, _)| shows(*instance));
        // Read together, so that neighbors in the file are read at once.
        let mut compartments = Vec::new();
        for (_, span) in shown() {
            compartments.extend_from_slice(&part.compartments[span.clone()]);
        }
        let mut values = population.values(frame, &compartments)?.into_iter();
        for (instance, span) in shown() {
            self.put(*instance, values.by_ref().take(span.len()));
        }
        Ok(())
    }

    /// Least and greatest value; always different.
    pub fn range(&self) -> [f32; 2] {
        opened(self.bounds())
    }

    pub(super) fn bounds(&self) -> [f32; 2] {
        let finite = self.values.iter().filter(|v| v.is_finite());
        finite.fold(NO_BOUNDS, |[low, high], &v| [low.min(v), high.max(v)])
    }

    /// Values for the color table, in the order of the neurons.
    pub fn values(&self, [low, high]: [f32; 2]) -> InstanceValues {
        let mut values = InstanceValues::default();
        let mut shares = Vec::new();
        for range in &self.of_instance {
            let own = self.values[range.clone()].iter();
            shares.clear();
            shares.extend(own.map(|value| (value - low) / (high - low)));
            values.push(&shares);
        }
        values
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether no neuron has any.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Values of a neuron; empty if it does not show or has none.
    pub fn of(&self, instance: usize) -> &[f32] {
        let range = self.of_instance.get(instance).cloned().unwrap_or_default();
        &self.values[range]
    }
}

/// Bounds of no values.
pub(super) const NO_BOUNDS: [f32; 2] = [f32::MAX, f32::MIN];

pub(super) fn merged([a, b]: [f32; 2], [c, d]: [f32; 2]) -> [f32; 2] {
    [a.min(c), b.max(d)]
}

/// Bounds as a range that is never empty.
pub(super) fn opened([low, high]: [f32; 2]) -> [f32; 2] {
    match (low <= high, low < high) {
        (false, _) => [0.0, 1.0],
        (true, false) => [low, low + 1.0],
        (true, true) => [low, high],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_never_empty() {
        let mut frame_values = ReportFrame::none(3);
        assert_eq!(frame_values.range(), [0.0, 1.0]);
        frame_values.put(1, [2.0, f32::NAN]);
        assert_eq!(frame_values.range(), [2.0, 3.0]);
        frame_values.put(2, [-65.0, 20.0]);
        assert_eq!(frame_values.range(), [-65.0, 20.0]);
        assert_eq!(
            (frame_values.of(0), frame_values.of(2)),
            (&[][..], &[-65.0, 20.0][..])
        );
    }

    #[test]
    fn values_are_shares_of_the_range() {
        let mut frame_values = ReportFrame::none(2);
        frame_values.put(1, [0.0, 5.0, 20.0]);
        let mut expected = InstanceValues::default();
        expected.push(&[]);
        expected.push(&[0.0, 0.5, 2.0]);
        assert_eq!(frame_values.values([0.0, 10.0]), expected);
    }
}
