//! Why cells, or a whole folder, were not written.

use std::path::PathBuf;
use std::sync::Arc;

use neurotess_batch::InputError;
use neurotess_batch::workers::ThreadError;
use neurotess_mesh::draco::DracoError;
use neurotess_output::OutputError;
use neurotess_recipe::{MeshError, Spelling};

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// It was not said where files go.
    #[error("it is not said where files go: give a folder")]
    NoFolder,
    /// No error of levels, or none of them.
    #[error("levels need an error above 0 and a number from 1 to 12")]
    Levels,
    /// No cell is there to be written.
    #[error("there is no cell to write")]
    Empty,
    /// Cells cannot be told apart.
    #[error(transparent)]
    Ids(#[from] IdError),
    /// The folder has files of other cells or options.
    #[error("{} was written from other cells, or with other options: give another folder, or let it be replaced", .0.display())]
    Other(PathBuf),
    /// The folder has been written.
    #[error("{} was written before: resume it, or let it be replaced", .0.display())]
    Exists(PathBuf),
    /// The folder has files, and none of them says that it was written here.
    #[error("{} has other files: give a new folder", .0.display())]
    Foreign(PathBuf),
    /// An input lies in the folder that is written.
    #[error("{} lies in the folder that is written: give another folder", .0.display())]
    Within(PathBuf),
    /// No tracing can be read; why the first cannot.
    #[error("{0}; no input can be read, so nothing was written")]
    Unreadable(InputError),
    /// A file that all cells share was not written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// No node has the attribute that is to color cells.
    #[error("no node has the attribute {name}: there are {}", there.join(", "))]
    NoAttribute {
        /// The attribute.
        name: String,
        /// Attributes that nodes have.
        there: Vec<String>,
    },
    /// Synapses without places.
    #[error("{0} has no places of synapses: leave it out")]
    NoPlaces(String),
    /// What a file of connections says.
    #[error(transparent)]
    Circuit(#[from] neurotess_circuit::CircuitError),
    /// There are no threads to be had.
    #[error(transparent)]
    Threads(#[from] ThreadError),
}

/// Cells that cannot be told apart by ids.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum IdError {
    /// Two have one id.
    #[error("{} and {} would both be segment {id}: give them ids of their own", cells[0], cells[1])]
    Twice {
        /// The cells.
        cells: [String; 2],
        /// The id.
        id: u64,
    },
    /// Ids of populations would run into each other.
    #[error("node {id} of {population}: ids of circuits must be below 10^12")]
    TooLarge {
        /// The node's id.
        id: u64,
        /// Its population.
        population: String,
    },
}

/// Why a tracing was not written; `FILE:LINE: what: what to do`.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The tracing.
    pub file: PathBuf,
    /// How many cells have it.
    pub cells: usize,
    pub(crate) fault: Arc<Fault>,
}

/// What went wrong with a tracing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// It was not read.
    #[error(transparent)]
    Input(#[from] InputError),
    /// There is no mesh of it.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// It was not encoded.
    #[error(transparent)]
    Draco(#[from] DracoError),
    /// Its files were not written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A fault of ours.
    #[error("{0}: a fault of neurotess, please report it")]
    Bug(String),
}

impl Failure {
    /// What went wrong.
    pub fn fault(&self) -> &Fault {
        &self.fault
    }

    /// What is wrong, and what to do, with options named as whoever set them wrote them.
    pub fn told(&self, spelling: Spelling) -> String {
        let file = self.file.display();
        let told = match &*self.fault {
            // The reader's errors begin with the file.
            Fault::Input(error) => error.to_string(),
            Fault::Mesh(error) => format!("{file}: {}", error.told(spelling)),
            other => format!("{file}: {other}"),
        };
        match self.cells {
            1 => told,
            cells => format!("{told} (in {cells} cells)"),
        }
    }
}
