//! Area of each section's surface beside what shows of its traced cones.

use std::collections::BTreeMap;

use neurotess::mesh::{SurfaceMesh, WriteError, areas_by};
use neurotess::morphology::{Morphology, SectionEnds, SectionPart, exposed_areas};

/// How the areas of a cell's sections differ from what shows of their cones.
pub(crate) struct Sections {
    /// As a share of it: the median of all sections, and the 95th percentile.
    pub(crate) off: [f64; 2],
    /// The 95th percentile of the same for each section with all that hangs on it.
    pub(crate) subtrees: f64,
    /// How many show, and have no triangle.
    pub(crate) vanished: usize,
}

impl Sections {
    /// Caps, and what a neurite has before its first traced point, are no part of their sections.
    ///
    /// # Errors
    /// The surface is not finite.
    pub(crate) fn new(surface: &SurfaceMesh, morphology: &Morphology) -> Result<Self, WriteError> {
        let ends = SectionEnds::new(morphology);
        let areas: BTreeMap<Option<usize>, f64> = areas_by(surface, |label, center| {
            let section = usize::try_from(label.section - 1).ok();
            section.filter(|&section| ends.part(section, label.point, center) == SectionPart::Side)
        })?;
        let mut meshed: Vec<f64> = (0..morphology.sections.len())
            .map(|section| areas.get(&Some(section)).copied().unwrap_or(0.0))
            .collect();
        let mut exposed = exposed_areas(morphology);
        let all = meshed.iter().zip(&exposed);
        let vanished = all.filter(|(meshed, exposed)| **meshed == 0.0 && **exposed > 0.0);
        let vanished = vanished.count();
        let off = off(&meshed, &exposed);
        for (section, of) in morphology.sections.iter().enumerate().rev() {
            if let Some(parent) = of.parent() {
                meshed[parent.index()] += meshed[section];
                exposed[parent.index()] += exposed[section];
            }
        }
        Ok(Self {
            off: [0.5, 0.95].map(|share| quantile(&off, share)),
            subtrees: quantile(&self::off(&meshed, &exposed), 0.95),
            vanished,
        })
    }
}

/// Differences as shares of what should be, the least first.
fn off(meshed: &[f64], exposed: &[f64]) -> Vec<f64> {
    let both = meshed.iter().zip(exposed);
    let shown = both.filter(|(_, exposed)| **exposed > 0.0);
    let mut off: Vec<f64> = shown
        .map(|(meshed, exposed)| (meshed / exposed - 1.0).abs())
        .collect();
    off.sort_by(f64::total_cmp);
    off
}

fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * sorted.len().saturating_sub(1) as f64;
    sorted.get(place.round() as usize).copied().unwrap_or(0.0)
}
