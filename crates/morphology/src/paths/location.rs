//! Locations on a tracing.

use glam::DVec3;

use super::links::{point_before, section_of};
use crate::{Morphology, SectionId, Soma};

/// A location on a tracing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Location {
    /// The center of a soma, by its index in [`Morphology::somata`].
    Soma(u32),
    /// A location on the link that leads to a point.
    Neurite {
        /// Index of the point in [`Morphology::points`].
        point: u32,
        /// Share of the link, in [0, 1], from the point before: 1 is the point itself. It does not
        /// matter for the first point of a neurite, which no link leads to.
        fraction: f64,
    },
}

impl Location {
    /// The location of a point.
    pub fn of_point(point: u32) -> Self {
        Self::Neurite {
            point,
            fraction: 1.0,
        }
    }

    /// The location of a sample of the file: a point, or for a sample of a soma its center. The
    /// first one, if several samples have this number.
    pub fn of_sample(morphology: &Morphology, id: i64) -> Option<Self> {
        let point = morphology.sample_ids.iter().position(|&known| known == id);
        if let Some(point) = point {
            return Some(Self::of_point(point as u32));
        }
        let has = |soma: &Soma| soma.samples.iter().any(|sample| sample.id == id);
        let soma = morphology.somata.iter().position(has)?;
        Some(Self::Soma(soma as u32))
    }

    /// Whether it is on this tracing. The other functions take such locations only.
    pub fn is_on(self, morphology: &Morphology) -> bool {
        match self {
            Self::Soma(soma) => (soma as usize) < morphology.somata.len(),
            Self::Neurite { point, fraction } => {
                (point as usize) < morphology.points.len() && (0.0..=1.0).contains(&fraction)
            }
        }
    }

    /// Its position (µm) in the file's coordinates.
    ///
    /// # Panics
    /// If it is not on the tracing.
    pub fn position(self, morphology: &Morphology) -> DVec3 {
        morphology.origin + self.center(morphology)
    }

    /// The radius (µm) there, interpolated along the link; a negative one counts as 0. Of a soma,
    /// that of the sphere that stands for it.
    ///
    /// # Panics
    /// If it is not on the tracing.
    pub fn radius(self, morphology: &Morphology) -> f64 {
        let of = |point: u32| f64::from(morphology.points[point as usize].radius).max(0.0);
        match self {
            Self::Soma(soma) => f64::from(morphology.somata[soma as usize].radius),
            Self::Neurite { point, fraction } => match point_before(morphology, point) {
                Some(before) => of(before) + fraction * (of(point) - of(before)),
                None => of(point),
            },
        }
    }

    /// The section that it is on: that of the point which its link leads to.
    ///
    /// # Panics
    /// If it is not on the tracing.
    pub fn section(self, morphology: &Morphology) -> Option<SectionId> {
        match self {
            Self::Soma(_) => None,
            Self::Neurite { point, .. } => Some(section_of(morphology, point)),
        }
    }

    /// Position relative to the morphology's origin.
    pub(crate) fn center(self, morphology: &Morphology) -> DVec3 {
        let of = |point: u32| morphology.points[point as usize].position.as_dvec3();
        match self {
            Self::Soma(soma) => morphology.somata[soma as usize].center.as_dvec3(),
            Self::Neurite { point, fraction } => match point_before(morphology, point) {
                Some(before) => of(before).lerp(of(point), fraction),
                None => of(point),
            },
        }
    }

    /// The same location, at a point wherever it can be.
    pub(super) fn at_point(self, morphology: &Morphology) -> Self {
        match self {
            Self::Soma(_) => self,
            Self::Neurite { point, fraction } => match point_before(morphology, point) {
                None => Self::of_point(point),
                Some(before) if fraction <= 0.0 => Self::of_point(before),
                Some(_) => self,
            },
        }
    }
}
