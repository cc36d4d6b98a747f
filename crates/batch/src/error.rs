//! What keeps a cell from being meshed, or a whole batch from being begun.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use neurotess_mesh::Format;
use neurotess_output::OutputError;
use neurotess_recipe::memory::TooLittleMemory;
use neurotess_recipe::{MeshError, MeshOption, OptionsError, SaveError, Spelling};

use crate::report::NodeName;
use crate::size::gigabytes;
use crate::standard::is_standard;
use crate::targets::TargetError;
use crate::tracing::InputError;
use crate::workers::ThreadError;

/// Why a batch was not begun.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// It was not said where meshes go.
    #[error("it is not said where meshes go: give a folder")]
    NoFolder,
    /// Options that are wrong, or do not fit together.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// Inputs cannot become the files that are asked for.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// There are no threads to be had.
    #[error(transparent)]
    Threads(#[from] ThreadError),
}

/// Why a cell was not meshed: `FILE:LINE: what: what to do`. Options are displayed with the names of fields;
/// [`told`](CellError::told) has others.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{}", self.told(Spelling::Field))]
pub struct CellError {
    file: PathBuf,
    /// Which of the cells that have this tracing.
    node: Option<NodeName>,
    fault: Arc<CellFault>,
}

/// What went wrong with a cell.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CellFault {
    /// It was not read.
    #[error(transparent)]
    Input(#[from] InputError),
    /// There is no mesh of it.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Its files were not written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// A file is in the way, or cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The format cannot hold coordinates as large as these.
    #[error(
        "at {at:.3e} µm, {format} rounds by {by:.3e} µm, more than the radius of {radius:.3e} µm: correct its place, or \
         move it towards the origin"
    )]
    Rounded {
        /// The largest coordinate (µm).
        at: f64,
        /// By how much it moves points (µm).
        by: f64,
        /// The median radius (µm).
        radius: f64,
        /// The format.
        format: Format,
    },
    /// There is too little memory for what the format needs.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// There is too little room on the disk.
    #[error(
        "{} would have about {}, but only {} are free in {}",
        out.display(), gigabytes(*bytes), gigabytes(*free), folder.display()
    )]
    NoRoom {
        /// The file.
        out: PathBuf,
        /// What it would have, about.
        bytes: u64,
        /// What is free.
        free: u64,
        /// Where.
        folder: PathBuf,
    },
    /// A fault of ours.
    #[error("a bug of neurotess ({0}): please report it with the file")]
    Bug(String),
    /// Another thread stopped it.
    #[error("stopped")]
    Stopped,
}

impl CellError {
    pub(crate) fn new(file: &Path, fault: impl Into<Arc<CellFault>>) -> Self {
        Self {
            file: file.to_path_buf(),
            node: None,
            fault: fault.into(),
        }
    }

    /// The same, which names one of the cells that have this tracing.
    pub(crate) fn of_node(self, node: Option<NodeName>) -> Self {
        Self { node, ..self }
    }

    /// The tracing.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What went wrong.
    pub fn fault(&self) -> &CellFault {
        &self.fault
    }

    /// Whether another thread stopped it.
    pub fn is_stopped(&self) -> bool {
        matches!(
            *self.fault,
            CellFault::Stopped
                | CellFault::Mesh(MeshError::Stopped)
                | CellFault::Save(SaveError::Stopped)
        )
    }

    /// What is wrong, and what to do, with options named as whoever set them wrote them.
    pub fn told(&self, spelling: Spelling) -> String {
        let file = self.file.display();
        let what = match &*self.fault {
            // It names the file, and the line.
            CellFault::Input(error) => error.to_string(),
            other => format!("{file}: {}", other.told(spelling)),
        };
        match &self.node {
            Some(node) => format!("{what} (cell {} of {})", node.node_id, node.population),
            None => what,
        }
    }
}

impl CellFault {
    fn told(&self, spelling: Spelling) -> String {
        let level = MeshOption::Level.spelled(spelling);
        match self {
            Self::Mesh(error) => error.told(spelling),
            Self::Save(SaveError::Options(error)) => error.told(spelling),
            Self::Memory(error) => format!("{error}: choose a lower {level}, or write ply"),
            Self::NoRoom { out, .. } => {
                let remedy = match is_standard(out) {
                    true => "set TMPDIR to a folder with more room",
                    false => "another disk",
                };
                format!("{self}: choose a lower {level}, or {remedy}")
            }
            other => other.to_string(),
        }
    }
}
