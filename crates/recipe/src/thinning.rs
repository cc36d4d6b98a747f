//! Tubes that turn back through themselves by as much as they are thick, or crowd around a small soma: merged,
//! they close a loop, or are cut off. They are made thinner there, step by step, until they pass each other.

use std::collections::{BTreeMap, BTreeSet};

use neurotess_morphology::{Attachment, Morphology};

/// What is left of a radius after each step.
const STEP: f64 = 0.7;

/// Points before and after a place that become thinner with it.
const AROUND: usize = 2;

/// A tracing whose tubes become thinner.
pub(crate) struct Thinning<'m> {
    traced: &'m Morphology,
    /// Indices of points by their samples.
    points: BTreeMap<i32, usize>,
    /// How often points were made thinner.
    steps: BTreeMap<usize, i32>,
}

impl<'m> Thinning<'m> {
    pub(crate) fn new(traced: &'m Morphology) -> Self {
        Self {
            traced,
            points: BTreeMap::new(),
            steps: BTreeMap::new(),
        }
    }

    /// Makes tubes one step thinner around places, told by the samples that cross there. Tells whether there is
    /// anything to make thinner.
    pub(crate) fn thin(&mut self, places: &[[i32; 2]]) -> bool {
        if self.points.is_empty() {
            let labels = self.traced.sample_labels();
            let points = 0..self.traced.points.len();
            self.points = points
                .map(|point| (labels.of_point(point), point))
                .collect();
        }
        let samples = places.iter().flatten();
        let found = samples.filter_map(|&sample| self.points.get(&sample));
        let around: BTreeSet<usize> = found.flat_map(|&point| self.around(point)).collect();
        for &point in &around {
            *self.steps.entry(point).or_default() += 1;
        }
        !around.is_empty()
    }

    /// The tracing as it is now.
    pub(crate) fn morphology(&self) -> Morphology {
        let mut thinned = self.traced.clone();
        for (&point, &steps) in &self.steps {
            let radius = &mut thinned.points[point].radius;
            *radius = (f64::from(*radius) * STEP.powi(steps)) as f32;
        }
        thinned
    }

    /// Samples that are thinner than traced.
    pub(crate) fn samples(&self) -> Vec<i64> {
        let points = self.steps.keys();
        points.map(|&point| self.traced.sample_ids[point]).collect()
    }

    /// Points of the section of a point near it, and of its parent where it begins.
    fn around(&self, point: usize) -> Vec<usize> {
        let sections = &self.traced.sections;
        let after = sections.partition_point(|section| section.first as usize <= point);
        let Some(section) = after.checked_sub(1).and_then(|n| sections.get(n)) else {
            return Vec::new();
        };
        let range = section.range();
        let first = point.saturating_sub(AROUND);
        let own = first.max(range.start)..(point + AROUND + 1).min(range.end);
        let missing = range.start.saturating_sub(first);
        let parent = match section.attachment {
            Attachment::Section(parent) => sections[parent.index()].range(),
            Attachment::Soma { .. } | Attachment::Free => 0..0,
        };
        own.chain(parent.rev().take(missing)).collect()
    }
}

#[cfg(test)]
mod tests {
    use neurotess_formats::{ReadOptions, swc};

    use super::*;

    const FORK: &[u8] = b"1 3 0 0 0 1 -1\n2 3 1 0 0 1 1\n3 3 2 0 0 1 2\n4 3 3 0 0 1 3\n5 3 4 0 0 1 4\n\
                          6 3 5 1 0 1 5\n7 3 6 2 0 1 6\n8 3 7 3 0 1 7\n9 3 8 4 0 1 8\n10 3 5 -1 0 1 5\n";

    #[test]
    fn tubes_become_thinner_around_a_place_and_into_the_parent() {
        let read = swc::read_bytes(FORK, "fork", &ReadOptions::default()).expect("a tracing");
        let mut thinning = Thinning::new(&read.morphology);
        assert!(!thinning.thin(&[]) && !thinning.thin(&[[99, -1]]));
        assert!(thinning.thin(&[[6, 6], [6, 7]]));
        assert_eq!(thinning.samples(), [4, 5, 6, 7, 8, 9]);
        assert!(thinning.thin(&[[8, 8]]));
        let thinned = thinning.morphology();
        let radius = |sample: i64| {
            let at = thinned.sample_ids.iter().position(|&id| id == sample);
            thinned.points[at.expect("a sample")].radius
        };
        assert_eq!([1, 3, 10].map(radius), [1.0; 3]);
        assert_eq!([4, 5].map(radius), [0.7; 2]);
        assert_eq!([6, 9].map(radius), [0.49; 2]);
    }
}
