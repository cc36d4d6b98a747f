//! Sums of the morphometrics of several neurons.

use std::collections::BTreeSet;

use neurotess::morphology::Measures;

use crate::model::sources::{Source, Sources};

/// Sums over neurons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Totals {
    /// Length (µm).
    pub(crate) length: f64,
    /// Area (µm²).
    pub(crate) area: f64,
    /// Volume (µm³).
    pub(crate) volume: f64,
    pub(crate) neurites: usize,
    pub(crate) sections: usize,
    pub(crate) ends: usize,
    pub(crate) points: usize,
}

impl Totals {
    pub(crate) fn of<'a>(measures: impl Iterator<Item = &'a Measures>) -> Self {
        measures.fold(Self::default(), |sum, m| Self {
            length: sum.length + m.length,
            area: sum.area + m.area,
            volume: sum.volume + m.volume,
            neurites: sum.neurites + m.n_neurites,
            sections: sum.sections + m.n_sections,
            ends: sum.ends + m.n_ends,
            points: sum.points + m.n_points,
        })
    }
}

/// Kinds of sections of all open tracings, as numbers of SWC.
pub(crate) fn kinds(sources: &Sources) -> BTreeSet<i32> {
    let kinds = |source: &'_ Source| -> BTreeSet<i32> {
        source
            .morphology
            .sections
            .iter()
            .map(|s| s.kind.0)
            .collect()
    };
    sources
        .iter()
        .flat_map(|(_, source)| kinds(source))
        .collect()
}
