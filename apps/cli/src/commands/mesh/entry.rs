//! The JSON list's entry for a cell.

use serde::Serialize;

use super::cell::CellReport;
use crate::io::targets::Job;
use crate::report::Failed;

#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Entry {
    Done(Box<CellReport>),
    Failed(Failed),
    /// Its output exists and is newer.
    Skipped {
        file: String,
        out: String,
        skipped: bool,
    },
}

pub(super) fn skipped(job: &Job) -> Entry {
    Entry::Skipped {
        file: job.input.display().to_string(),
        out: job.out.display().to_string(),
        skipped: true,
    }
}

/// Entries in the order of the inputs, with those that were skipped.
pub(super) fn in_order(jobs: &[Job], entries: Vec<Entry>, skipped: &[Job]) -> Vec<Entry> {
    let mut entries = entries.into_iter();
    let mut skipped = skipped.iter().peekable();
    let next = |job| match skipped.next_if(|&next| next == job) {
        Some(job) => Some(self::skipped(job)),
        None => entries.next(),
    };
    jobs.iter().filter_map(next).collect()
}
