//! What is told while a batch runs.

use std::path::PathBuf;

use neurotess_output::OutputError;
use neurotess_recipe::Progress;

use crate::error::CellError;
use crate::inputs::NotFound;
use crate::plan::Plan;
use crate::report::CellReport;
use crate::size::LargeFile;
use crate::targets::Job;

/// What happens while a batch runs.
#[non_exhaustive]
pub enum Event<'e> {
    /// It is known what is to be done, and what is left alone.
    Planned(&'e Plan),
    /// Another run is writing the file of a cell, which is waited for.
    Waiting(&'e Job),
    /// How far a cell is; told by any thread.
    Progress(&'e Job, Progress),
    /// A file will be large.
    Large(&'e LargeFile),
    /// A cell's files are written, and about to get their names.
    Written(&'e CellReport),
    /// It could not be recorded what a file was made of, so that a later run will make it again.
    Unrecorded(&'e OutputError),
    /// A cell is done, failed, or was left alone.
    Ended(&'e Outcome),
}

/// What became of a cell.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// It was meshed.
    Done(Box<CellReport>),
    /// It was not.
    Failed(CellError),
    /// Its file is there, and up to date.
    Kept {
        /// The tracing.
        file: PathBuf,
        /// The mesh.
        out: PathBuf,
    },
}

/// What became of a batch.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct BatchReport {
    /// Of each cell, in the order of the inputs.
    pub outcomes: Vec<Outcome>,
    /// Inputs without any file.
    pub not_found: Vec<NotFound>,
}

impl Outcome {
    pub(crate) fn kept(job: &Job) -> Self {
        Self::Kept {
            file: job.input.clone(),
            out: job.out.clone(),
        }
    }
}

impl BatchReport {
    /// Reports of the cells that were meshed.
    pub fn done(&self) -> impl Iterator<Item = &CellReport> {
        self.outcomes.iter().filter_map(|outcome| match outcome {
            Outcome::Done(report) => Some(&**report),
            _ => None,
        })
    }

    /// Why cells were not meshed.
    pub fn failed(&self) -> impl Iterator<Item = &CellError> {
        self.outcomes.iter().filter_map(|outcome| match outcome {
            Outcome::Failed(error) => Some(error),
            _ => None,
        })
    }

    /// Number of cells whose files were up to date.
    pub fn kept(&self) -> usize {
        let kept = |outcome: &&Outcome| matches!(outcome, Outcome::Kept { .. });
        self.outcomes.iter().filter(kept).count()
    }

    /// Whether all inputs were found, and no cell failed.
    pub fn is_complete(&self) -> bool {
        self.not_found.is_empty() && self.failed().next().is_none()
    }
}
