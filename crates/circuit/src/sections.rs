//! Sections as reports and edges number them, and where on a neuron a compartment is.
//!
//! **Theory.** Reports number sections as NEURON does: 0 is the soma, then all sections of the axon,
//! of the basal dendrites, of the apical ones, and of the rest, each kind in depth-first order (SONATA
//! developer guide, "Section numbering"). A morphology may have its trees in another order; so the
//! numbers are counted anew here. A section that is reported in `n` compartments has them at
//! (k + ½) / n of its length; `element_pos` says it otherwise.

use neurotess_morphology::{Membrane, MembranePlace, Morphology, NeuriteKind, SectionId};

/// A compartment: a piece of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compartment {
    /// The section's number in the report; 0 is the soma.
    pub section: u64,
    /// Its middle along the section, from 0 to 1.
    pub along: f32,
}

/// A place on a morphology.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Location {
    /// The soma.
    Soma,
    /// Along a section, from 0 at its start to 1 at its end.
    Section(SectionId, f32),
}

/// Sections of a morphology in the order of reports.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionOrder(Vec<SectionId>);

impl SectionOrder {
    /// Axon, basal, apical, the rest; each in depth-first order.
    pub fn of(morphology: &Morphology) -> Self {
        let rank = |kind: NeuriteKind| match kind {
            NeuriteKind::AXON => (0, 0),
            NeuriteKind::BASAL_DENDRITE => (1, 0),
            NeuriteKind::APICAL_DENDRITE => (2, 0),
            NeuriteKind(other) => (3, other),
        };
        let mut order: Vec<SectionId> = (0..morphology.sections.len() as u32)
            .map(SectionId)
            .collect();
        order.sort_by_key(|id| rank(morphology.sections[id.index()].kind));
        Self(order)
    }

    /// The place of a compartment; `None` if the morphology has no such section.
    pub fn place(&self, compartment: Compartment) -> Option<Location> {
        let Some(index) = compartment.section.checked_sub(1) else {
            return Some(Location::Soma);
        };
        let section = self.0.get(usize::try_from(index).ok()?)?;
        Some(Location::Section(*section, compartment.along))
    }

    /// The place of a compartment on a cell's membrane; `None` if the cell has no such section.
    pub fn on_membrane(
        &self,
        membrane: &Membrane<'_>,
        compartment: Compartment,
    ) -> Option<MembranePlace> {
        match self.place(compartment)? {
            Location::Soma => membrane.in_soma(),
            Location::Section(section, along) => membrane.on_section(section, along.into()),
        }
    }

    /// The sections in this order: the first has number 1.
    pub fn sections(&self) -> &[SectionId] {
        &self.0
    }
}

/// Elements that follow one another with the same number share its section.
pub(crate) fn compartments(sections: &[u64], positions: Option<&[f64]>) -> Vec<Compartment> {
    let mut compartments = Vec::with_capacity(sections.len());
    for run in sections.chunk_by(|a, b| a == b) {
        for k in 0..run.len() {
            let given = positions.and_then(|p| p.get(compartments.len()).copied());
            let middle = (k as f64 + 0.5) / run.len() as f64;
            let along = given.filter(|p| (0.0..=1.0).contains(p)).unwrap_or(middle);
            compartments.push(Compartment {
                section: run[0],
                along: along as f32,
            });
        }
    }
    compartments
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn compartments_of_a_section_share_its_length() {
        let along = |sections: &[u64], positions: Option<&[f64]>| -> Vec<f32> {
            let all = compartments(sections, positions);
            all.iter().map(|c| c.along).collect()
        };
        assert_eq!(along(&[0, 1, 1, 2], None), [0.5, 0.25, 0.75, 0.5]);
        assert_eq!(along(&[0, 1], Some(&[0.1, f64::NAN])), [0.1, 0.5]);
    }

    fn read_cell() -> Morphology {
        let text = b"1 1 0 0 0 5 -1\n2 4 0 6 0 1 1\n3 4 0 9 0 1 2\n4 2 0 -6 0 1 1\n5 3 6 0 0 1 1\n";
        let read = neurotess_formats::swc::read_bytes(text, "c.swc", &Default::default());
        read.expect("a cell").morphology
    }

    #[test]
    fn sections_are_numbered_by_kind() {
        let order = SectionOrder::of(&read_cell());
        let place = |section| {
            let along = 0.5;
            order.place(Compartment { section, along })
        };
        assert_eq!(place(0), Some(Location::Soma));
        // The axon is the second tree of the file and the first of reports.
        let ids = [1, 2, 3].map(place);
        let expected = [1, 2, 0].map(|id| Some(Location::Section(SectionId(id), 0.5)));
        assert_eq!(ids, expected);
        assert_eq!(place(4), None);
        let cell = read_cell();
        let order = SectionOrder::of(&cell);
        let membrane = Membrane::of(&cell);
        let at = |section, along| {
            let place = order.on_membrane(&membrane, Compartment { section, along });
            place.map(|place| place.center)
        };
        // The second section of the file has 3 µm along y from 6 to 9.
        assert_eq!(at(0, 0.3), Some(DVec3::ZERO));
        assert_eq!(at(3, 0.5), Some(DVec3::new(0.0, 7.5, 0.0)));
        assert_eq!(at(3, 1.0), Some(DVec3::new(0.0, 9.0, 0.0)));
        assert_eq!((at(4, 0.5), at(3, f32::NAN)), (None, None));
        assert_eq!(order.sections()[2], SectionId(0));
    }
}
