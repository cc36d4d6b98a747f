//! What a format cannot say of a morphology, and the outlines that somata become in formats which
//! know no others.

use glam::Vec3;
use neurotess_morphology::{Attachment, Morphology, Soma, SomaKind};

use crate::Warning;

/// Corners of the outline that stands for a sphere.
const CORNERS: usize = 32;

/// Losses in writing, one per kind.
#[derive(Default)]
pub(crate) struct Losses(Vec<Warning>);

impl Losses {
    /// What every format loses that traces somata as outlines and hangs all neurites on them.
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
        losses
    }

    #[cfg(feature = "h5")]
    pub(crate) fn header(&mut self, morphology: &Morphology) {
        let lines = morphology.header.len() as u64;
        self.add("header_lost", "a header's line is not kept", lines);
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

/// Positions (relative to the origin) and radii of all somata's outlines.
pub(crate) fn outlines(morphology: &Morphology) -> Vec<Vec<(Vec3, f32)>> {
    morphology.somata.iter().flat_map(soma_outlines).collect()
}

fn soma_outlines(soma: &Soma) -> Vec<Vec<(Vec3, f32)>> {
    if soma.kind != SomaKind::Contour {
        return vec![circle(soma)];
    }
    let mut outlines: Vec<Vec<(Vec3, f32)>> = Vec::new();
    for (i, sample) in (0_u32..).zip(&soma.samples) {
        let follows = i > 0 && sample.parent == Some(i - 1);
        if !follows {
            outlines.push(Vec::new());
        }
        if let Some(outline) = outlines.last_mut() {
            outline.push((sample.position, sample.radius));
        }
    }
    // Samples of no thickness that hang together in another way are one outline.
    if outlines.iter().all(|outline| outline.len() < 3) {
        return vec![outlines.concat()];
    }
    outlines
}

/// A polygon in the xy-plane of the same area as the sphere's great circle.
fn circle(soma: &Soma) -> Vec<(Vec3, f32)> {
    use std::f64::consts::TAU;
    let corners = CORNERS as f64;
    let stretch = (TAU / (corners * (TAU / corners).sin())).sqrt();
    let reach = f64::from(soma.radius.max(0.0)) * stretch;
    (0..CORNERS)
        .map(|i| {
            let (sin, cos) = (i as f64 * TAU / corners).sin_cos();
            let corner = glam::DVec3::new(cos, sin, 0.0) * reach;
            (soma.center + corner.as_vec3(), 0.0)
        })
        .collect()
}
