//! Compartments of reports, and shares of sections that edges name.
//!
//! **Theory.** A section that is reported in `n` compartments has them at (k + ½) / n of its length; `element_pos` says it
//! otherwise. What the number of a section means is [`SectionNumbers`]' to say.

use neurotess_morphology::{Membrane, MembranePlace, SectionNumbers, SectionPlace};

/// A compartment: a piece of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compartment {
    /// The section's number in the report; 0 is the soma.
    pub section: u64,
    /// Its middle along the section, from 0 to 1.
    pub along: f32,
}

impl Compartment {
    /// Where it is on a cell; none if the cell has no such section. `numbers`: NEURON's.
    pub fn place(&self, numbers: &SectionNumbers) -> Option<SectionPlace> {
        numbers.place(self.section, self.along)
    }

    /// Where it is on a cell's membrane; none if the cell has no such section. `numbers`: NEURON's.
    pub fn on_membrane(
        &self,
        numbers: &SectionNumbers,
        membrane: &Membrane<'_>,
    ) -> Option<MembranePlace> {
        match self.place(numbers)? {
            SectionPlace::Soma => membrane.in_soma(),
            SectionPlace::Section(section, along) => membrane.on_section(section, along.into()),
        }
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
    use neurotess_morphology::{Program, SectionId};

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

    #[test]
    fn sections_are_numbered_by_kind() {
        let text = b"1 1 0 0 0 5 -1\n2 4 0 6 0 1 1\n3 4 0 9 0 1 2\n4 2 0 -6 0 1 1\n5 3 6 0 0 1 1\n";
        let read = neurotess_formats::swc::read_bytes(text, "c.swc", &Default::default());
        let cell = read.expect("a cell").morphology;
        let numbers = SectionNumbers::of(&cell, Program::Neuron);
        let at = |section, along| Compartment { section, along };
        assert_eq!(at(0, 0.5).place(&numbers), Some(SectionPlace::Soma));
        // The axon is the second tree of the file and the first of reports.
        let ids = [1, 2, 3].map(|section| at(section, 0.5).place(&numbers));
        let expected = [1, 2, 0].map(|id| Some(SectionPlace::Section(SectionId(id), 0.5)));
        assert_eq!(ids, expected);
        assert_eq!(at(4, 0.5).place(&numbers), None);
        let membrane = Membrane::of(&cell);
        let center = |compartment: Compartment| {
            let place = compartment.on_membrane(&numbers, &membrane);
            place.map(|place| place.center)
        };
        // The first section of the file has 3 µm along y from 6 to 9.
        assert_eq!(center(at(0, 0.3)), Some(DVec3::ZERO));
        assert_eq!(center(at(3, 0.5)), Some(DVec3::new(0.0, 7.5, 0.0)));
        assert_eq!(center(at(3, 1.0)), Some(DVec3::new(0.0, 9.0, 0.0)));
        assert_eq!((center(at(4, 0.5)), center(at(3, f32::NAN))), (None, None));
    }
}
