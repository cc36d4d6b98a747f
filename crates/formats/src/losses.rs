//! What a format cannot say of a morphology.

#[cfg(any(feature = "asc", feature = "h5"))]
use neurotess_morphology::{Attachment, Soma, SomaKind};
use neurotess_morphology::{Measures, Morphology, Program, SectionNumbers};

use crate::Warning;

/// By what share a length or a radius may change unsaid: outlines of spheres have corners, and numbers are rounded.
const MAX_CHANGED: f64 = 1e-3;

/// Losses in writing, one per kind.
#[derive(Default)]
pub(crate) struct Losses(Vec<Warning>);

impl Losses {
    /// What every format loses that traces somata as outlines and hangs all neurites on them.
    #[cfg(any(feature = "asc", feature = "h5"))]
    pub(crate) fn of(morphology: &Morphology) -> Self {
        let mut losses = Self::default();
        let count = |holds: &dyn Fn(&Soma) -> bool| {
            morphology.somata.iter().filter(|s| holds(s)).count() as u64
        };
        losses.add(
            "soma_as_outline",
            "a soma is written as the outline of its sphere",
            count(&|s| s.kind != SomaKind::Contour),
        );
        losses.add(
            "somata_merged",
            "somata are written as slices of one",
            (morphology.somata.len() as u64).saturating_sub(1),
        );
        let free = |s: &&neurotess_morphology::Section| s.attachment == Attachment::Free;
        if !morphology.somata.is_empty() {
            losses.add(
                "free_neurites_attached",
                "a free neurite is written as one of the soma's",
                morphology.sections.iter().filter(free).count() as u64,
            );
        }
        let before = morphology
            .somata
            .iter()
            .map(|s| s.samples.len())
            .sum::<usize>() as i64;
        let in_order = (before + 1..).zip(&morphology.sample_ids);
        losses.add(
            "renumbered",
            "a sample's number is not kept",
            in_order.filter(|(own, id)| own != *id).count() as u64,
        );
        losses.spines(morphology);
        losses
    }

    #[cfg(feature = "h5")]
    pub(crate) fn header(&mut self, morphology: &Morphology) {
        let lines = morphology.header.len() as u64;
        self.add("header_lost", "a header's line is not kept", lines);
    }

    /// What the measures of a copy have otherwise than those of what was written.
    pub(crate) fn between(&mut self, before: &Measures, after: &Measures) {
        let forks = |measures: &Measures| measures.n_bifurcations + measures.n_multifurcations;
        for (code, what, [before, after]) in [
            (
                "points_changed",
                "points of neurites",
                [before.n_points, after.n_points],
            ),
            ("forks_changed", "forks", [forks(before), forks(after)]),
        ] {
            if before != after {
                self.add(
                    code,
                    &format!("the copy has {after} {what} instead of {before}"),
                    1,
                );
            }
        }
        for (code, what, [before, after]) in [
            (
                "length_changed",
                "the neurites' length",
                [before.length, after.length],
            ),
            (
                "soma_changed",
                "the soma's radius",
                [before.soma.radius, after.soma.radius],
            ),
        ] {
            if (before - after).abs() > MAX_CHANGED * before.abs().max(after.abs()) {
                let message = format!("{what} is {after:.4} µm in the copy instead of {before:.4}");
                self.add(code, &message, 1);
            }
        }
    }

    /// Sections that NEURON and SONATA number otherwise in a copy.
    pub(crate) fn sections(&mut self, before: &Morphology, after: &Morphology) {
        if before.points.len() != after.points.len() {
            // The points are told.
            return;
        }
        // After an edit that took sections away, other numbers are what was asked for.
        let known = before.known_file_sections();
        let mut there = vec![false; known.sections.len()];
        known
            .of_points
            .iter()
            .for_each(|&of| there[of as usize] = true);
        let mut all = known.sections.iter().zip(there);
        if all.any(|(section, there)| !there && !section.empty) {
            return;
        }
        let numbers = |of: &Morphology| SectionNumbers::of(of, Program::Neuron).of_points(of);
        let (before, after) = (numbers(before), numbers(after));
        let mut pairs: Vec<(u64, u64)> = before.into_iter().zip(after).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let others = pairs.iter().filter(|(before, after)| before != after);
        let count = others.clone().map(|(before, _)| before);
        let mut count: Vec<u64> = count.copied().collect();
        count.dedup();
        if let Some((before, after)) = others.clone().next() {
            let message = format!(
                "sections have other numbers in the copy, by which reports and synapses of the original do not fit it: \
                 NEURON's section {before} is {after} there"
            );
            self.add("sections_renumbered", &message, count.len() as u64);
        }
    }

    /// Of spines that are not in the tree.
    pub(crate) fn spines(&mut self, morphology: &Morphology) {
        let spines = morphology.spines.len() as u64;
        self.add("spines_lost", "the place of a spine is not kept", spines);
    }

    pub(crate) fn add(&mut self, code: &'static str, message: &str, count: u64) {
        if count > 0 {
            self.0.push(Warning {
                line: None,
                code,
                message: match count {
                    1 => message.into(),
                    _ => format!("{message}, {count} times"),
                },
                count,
            });
        }
    }

    pub(crate) fn into_warnings(self) -> Vec<Warning> {
        self.0
    }
}
