//! What a mesh has of a section before its first and beyond its last traced point, told by where it is.

use glam::{DVec3, Vec3};

use crate::{Attachment, Morphology, Section};

/// A cap ends this near (radii) to the point that it closes: beyond the plane there, a branch that turns back is farther.
const CAP: f64 = 1.5;

/// What of a section a place on its membrane is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SectionPart {
    /// Beside its traced path.
    Side,
    /// Between the soma and its first traced point, which is no part of any frustum.
    Stem,
    /// Around an end without a branch.
    Cap,
}

/// The ends of all sections.
#[derive(Clone, Debug)]
pub struct SectionEnds(Vec<[Option<End>; 2]>);

/// A plane across an end.
#[derive(Clone, Copy, Debug)]
struct End {
    place: DVec3,
    /// Away from the section.
    outwards: DVec3,
    part: SectionPart,
    /// The label of the sample that a stem's faces have.
    sample: i32,
    /// How far a cap reaches (µm).
    reach: f64,
}

impl SectionEnds {
    /// The ends of a morphology's sections.
    pub fn new(morphology: &Morphology) -> Self {
        let children = crate::shape::child_counts(morphology);
        let sections = morphology.sections.iter().zip(children);
        Self(
            sections
                .map(|(section, children)| {
                    let tip = (children == 0).then(|| cap(morphology, section, true));
                    let start = match section.attachment {
                        Attachment::Section(_) => None,
                        Attachment::Soma { soma, .. } => stem(morphology, section, soma),
                        Attachment::Free => cap(morphology, section, false),
                    };
                    [start, tip.flatten()]
                })
                .collect(),
        )
    }

    /// What a place (µm, in the tracing's own coordinates) is of a section, whose first one is 0, and a face there has
    /// the label of a [sample](crate::SampleLabels).
    pub fn part(&self, section: usize, sample: i32, place: DVec3) -> SectionPart {
        let ends = self.0.get(section).into_iter().flatten().flatten();
        let mut beyond = ends.filter(|end| {
            let from = place - end.place;
            let is_near = match end.part {
                SectionPart::Stem => sample == end.sample,
                _ => from.length() < end.reach,
            };
            is_near && from.dot(end.outwards) > 0.0
        });
        beyond.next().map_or(SectionPart::Side, |end| end.part)
    }
}

/// Half-way between the ways from the soma and to the second point.
fn stem(morphology: &Morphology, section: &Section, soma: u32) -> Option<End> {
    let first = section.range().start;
    let [place, center] = [
        morphology.points.get(first)?.position,
        morphology.somata.get(soma as usize)?.center,
    ]
    .map(Vec3::as_dvec3);
    let onwards = (section.range().len() > 1)
        .then(|| (morphology.points[first + 1].position.as_dvec3() - place).normalize_or_zero());
    Some(End {
        place: place + morphology.origin,
        outwards: -(place - center).normalize_or_zero() - onwards.unwrap_or_default(),
        part: SectionPart::Stem,
        sample: morphology.sample_labels().of_point(first),
        reach: 0.0,
    })
}

/// Across the last link, or the first one.
fn cap(morphology: &Morphology, section: &Section, is_last: bool) -> Option<End> {
    let branches_from = section
        .parent()
        .map(|parent| morphology.sections[parent.index()].end as usize - 1);
    let mut points: Vec<usize> = branches_from.into_iter().chain(section.range()).collect();
    if is_last {
        points.reverse();
    }
    let end = morphology.points.get(*points.first()?)?;
    let inner = points.iter().find_map(|&inner| {
        let inner = morphology.points[inner].position;
        (inner != end.position).then_some(inner)
    })?;
    Some(End {
        place: end.position.as_dvec3() + morphology.origin,
        outwards: (end.position - inner).as_dvec3(),
        part: SectionPart::Cap,
        sample: 0,
        reach: CAP * f64::from(end.radius),
    })
}
