//! Parts of neurons that are under the cursor or were clicked.

/// A part of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CellPart {
    /// The soma, of which a cell may have several.
    Soma,
    /// A neurite, from 0.
    Neurite(u32),
    /// A section, as in the morphology.
    Section(u32),
}

/// The part of a neuron that is under the cursor or was clicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Picked {
    /// Index among the neurons.
    pub neuron: usize,
    /// The part of it.
    pub part: CellPart,
}
