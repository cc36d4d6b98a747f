//! Membranes of a circuit's cells, on which synapses lie.

use glam::DVec3;
use neurotess_morphology::{Membrane, MembranePlace, Morphology, Program, SectionNumbers};

use crate::model::Circuit;
use crate::sections::Compartment;
use crate::template::{TemplateId, soma_center};

/// The membrane of a morphology, with its sections as edges number them.
#[derive(Debug)]
pub struct CellMembrane<'c> {
    morphology: &'c Morphology,
    numbers: SectionNumbers,
    membrane: Membrane<'c>,
}

impl Circuit {
    /// The membrane of a template, which is read if it was not. None if it cannot be read: whoever reads it to show it
    /// tells why.
    pub fn membrane(&self, template: TemplateId) -> Option<CellMembrane<'_>> {
        let read = self.templates.get(template.index())?.read().ok()?;
        let morphology = &read.morphology;
        Some(CellMembrane {
            morphology,
            numbers: SectionNumbers::of(morphology, Program::Neuron),
            membrane: Membrane::of(morphology),
        })
    }
}

impl CellMembrane<'_> {
    /// The place of a share of a section; none if the cell has no such section.
    pub fn place(&self, share: Compartment) -> Option<MembranePlace> {
        share.on_membrane(&self.numbers, &self.membrane)
    }

    /// The place whose membrane is nearest to another place (µm, the cell's coordinates), within 5 µm.
    pub fn nearest(&self, place: DVec3) -> Option<MembranePlace> {
        self.membrane.nearest(place)
    }

    /// See [`soma_center`].
    pub fn soma_center(&self) -> DVec3 {
        soma_center(self.morphology)
    }
}
