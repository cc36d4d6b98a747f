//! What became of a cell, as an object of the list that `neurotess mesh --json` prints.

use std::path::Path;

use neurotess_recipe::Spelling;
use serde::Serialize;

use crate::event::{BatchReport, Outcome};
use crate::report::CellReport;
use crate::targets::Job;

/// An object of the list.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Entry<'o> {
    /// It was meshed.
    Done(&'o CellReport),
    /// It was not.
    Failed {
        /// The tracing.
        file: String,
        /// Why.
        error: String,
    },
    /// Its file is there, and up to date.
    Skipped {
        /// The tracing.
        file: String,
        /// The mesh.
        out: String,
        /// That it is so.
        skipped: bool,
    },
}

impl<'o> Entry<'o> {
    /// What became of a cell; errors name options as whoever set them wrote them.
    pub fn new(outcome: &'o Outcome, spelling: Spelling) -> Self {
        match outcome {
            Outcome::Done(report) => Self::Done(report),
            Outcome::Failed(error) => Self::failed(error.file(), error.told(spelling)),
            Outcome::Kept { file, out } => Self::skipped(file, out),
        }
    }

    /// A file that stays.
    pub fn kept(job: &Job) -> Self {
        Self::skipped(&job.input, &job.out)
    }

    /// An input that failed.
    pub fn failed(file: &Path, error: String) -> Self {
        Self::Failed {
            file: file.display().to_string(),
            error,
        }
    }

    fn skipped(file: &Path, out: &Path) -> Self {
        Self::Skipped {
            file: file.display().to_string(),
            out: out.display().to_string(),
            skipped: true,
        }
    }
}

impl BatchReport {
    /// What became of each cell, in the order of the inputs.
    pub fn entries(&self, spelling: Spelling) -> Vec<Entry<'_>> {
        let outcomes = self.outcomes.iter();
        outcomes.map(|o| Entry::new(o, spelling)).collect()
    }
}
