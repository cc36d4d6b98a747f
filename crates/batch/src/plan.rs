//! What is to be done: the cells of a batch, each with its file, and which of them are up to date.

use glam::DAffine3;
use neurotess_morphology::Morphology;

use crate::inputs::NotFound;
use crate::options::CellOptions;
use crate::record::{OutputRecord, OutputState};
use crate::report::NodeName;
use crate::targets::Job;

/// From a cell's coordinates (µm) to those of its circuit.
pub(crate) type Place = Box<dyn Fn(&Morphology) -> DAffine3 + Send + Sync>;

/// A cell to write.
pub(crate) struct Cell {
    pub(crate) job: Job,
    /// Cells of one template have one tracing, which is meshed once.
    pub(crate) template: usize,
    /// Its node, if it is of a circuit.
    pub(crate) node: Option<NodeName>,
    /// Where it is in the circuit.
    pub(crate) place: Option<Place>,
}

/// The cells of a batch, each with its file, and which of them are up to date.
pub struct Plan {
    pub(crate) options: CellOptions,
    pub(crate) cells: Vec<Cell>,
    /// Of each cell; none unless the batch resumes.
    pub(crate) states: Option<Vec<OutputState>>,
    pub(crate) record: OutputRecord,
    /// Whether it is recorded what files were made from.
    pub(crate) records: bool,
    pub(crate) threads: usize,
    pub(crate) not_found: Vec<NotFound>,
}

impl Plan {
    /// Finds out which files are up to date, if the batch `resumes`.
    pub(crate) fn new(
        options: CellOptions,
        mut cells: Vec<Cell>,
        record: OutputRecord,
        resumes: bool,
    ) -> Self {
        for cell in &mut cells {
            let job = &mut cell.job;
            job.beside = options.files.materials_of(&job.out);
            job.further = options.mesh.soma_mesh.iter().cloned().collect();
            job.parts = options.files.parts;
        }
        let state = |cell: &Cell| record.state_of(&cell.job);
        Self {
            states: resumes.then(|| cells.iter().map(state).collect()),
            options,
            cells,
            record,
            records: true,
            threads: 1,
            not_found: Vec::new(),
        }
    }

    /// Each cell's files, and what is known of them where the batch resumes.
    pub fn jobs(&self) -> impl Iterator<Item = (&Job, Option<OutputState>)> {
        self.cells
            .iter()
            .enumerate()
            .map(|(n, cell)| (&cell.job, self.state(n)))
    }

    /// Number of cells that are to be meshed; the others are up to date.
    pub fn to_do(&self) -> usize {
        (0..self.cells.len()).filter(|&n| !self.stays(n)).count()
    }

    /// Inputs without any file.
    pub fn not_found(&self) -> &[NotFound] {
        &self.not_found
    }

    fn state(&self, cell: usize) -> Option<OutputState> {
        self.states.as_ref().map(|states| states[cell])
    }

    /// Whether a cell need not be made.
    pub(crate) fn stays(&self, cell: usize) -> bool {
        self.state(cell).is_some_and(OutputState::stays)
    }
}
