//! Compartments whose section no cell has.

use neurotess_circuit::Compartment;
use neurotess_morphology::{Program, SectionNumbers};

use crate::scheme::Cell;

/// Compartments of a report whose section no shown cell has: their values show nowhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownSections {
    /// How many compartments, of how many.
    pub count: u64,
    /// Compartments of the cells that are shown.
    pub of: u64,
    /// The first one's section.
    pub section: u64,
    /// The node that it is of.
    pub node: u64,
    /// Name of its cell, and how many sections that has.
    pub cell: (String, u64),
}

impl std::fmt::Display for UnknownSections {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            count,
            of,
            section,
            node,
            cell: (cell, sections),
        } = self;
        write!(
            f,
            "{count} of {of} compartments are of sections that their cells do not have, and show nowhere; the first is \
             section {section} of node {node}, whose cell {cell} has {sections}: is this the report of these morphologies, \
             and of compartments?"
        )
    }
}

/// Counts compartments of sections that cells do not have.
pub(super) struct Unknown<'c> {
    cells: &'c [Cell<'c>],
    numbers: Vec<Option<SectionNumbers>>,
    pub(super) found: Option<UnknownSections>,
    all: u64,
}

impl<'c> Unknown<'c> {
    pub(super) fn new(cells: &'c [Cell<'c>]) -> Self {
        Self {
            cells,
            numbers: vec![None; cells.len()],
            found: None,
            all: 0,
        }
    }

    pub(super) fn count(&mut self, cell: usize, node: u64, compartments: &[Compartment]) {
        let of = &self.cells[cell];
        let numbers = self.numbers[cell]
            .get_or_insert_with(|| SectionNumbers::of(of.morphology, Program::Neuron));
        let unknown = |compartment: &&Compartment| compartment.place(numbers).is_none();
        let mut lost = compartments.iter().filter(unknown);
        self.all += compartments.len() as u64;
        if let Some(first) = lost.next() {
            let found = self.found.get_or_insert_with(|| UnknownSections {
                count: 0,
                of: 0,
                section: first.section,
                node,
                cell: (of.morphology.name.clone(), numbers.len() as u64),
            });
            found.count += 1 + lost.count() as u64;
        }
        if let Some(found) = &mut self.found {
            found.of = self.all;
        }
    }
}
