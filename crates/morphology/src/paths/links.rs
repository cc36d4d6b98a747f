//! What a point hangs on.

use crate::{Attachment, Morphology, SectionId};

/// The section of a point.
pub(super) fn section_of(morphology: &Morphology, point: u32) -> SectionId {
    let sections = &morphology.sections;
    SectionId(sections.partition_point(|section| section.end <= point) as u32)
}

/// The point that a point hangs on; none for the first one of a neurite.
pub(super) fn point_before(morphology: &Morphology, point: u32) -> Option<u32> {
    let section = &morphology.sections[section_of(morphology, point).index()];
    if point > section.first {
        return Some(point - 1);
    }
    let parent = section.parent()?;
    Some(morphology.sections[parent.index()].end - 1)
}

/// The soma that the first point of a neurite is attached to.
pub(super) fn soma_of(morphology: &Morphology, first: u32) -> Option<u32> {
    let section = section_of(morphology, first);
    match morphology.sections[section.index()].attachment {
        Attachment::Soma { soma, .. } => Some(soma),
        Attachment::Section(_) | Attachment::Free => None,
    }
}
