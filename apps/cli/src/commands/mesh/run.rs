//! A run over many cells: which of them are skipped, claimed, recorded and logged.

use super::cell::Made;
use super::entry::{Entry, skipped};
use super::messages::tell_states;
use super::options::MeshOptions;
use crate::io::claims::{Claim, Claimed, claim};
use crate::io::morphologies::readable;
use crate::io::output::OutputError;
use crate::io::record::{OutputRecord, Stamp};
use crate::io::targets::Job;
use crate::report::{Failed, Failure, Log, Reporter, bug};

/// What all cells of a run have in common.
pub(super) struct MeshRun<'a> {
    pub(super) options: &'a MeshOptions,
    pub(super) reporter: &'a Reporter,
    pub(super) log: Option<Log>,
    pub(super) resume: bool,
    /// Whether it is recorded what files were made from.
    pub(super) records: bool,
}

impl MeshRun<'_> {
    fn log(&self, entry: &Entry) {
        if let Some(log) = &self.log
            && let Err(failure) = log.line(entry)
        {
            self.reporter.failure(&failure);
        }
    }

    /// Finds out which outputs are kept and which are to be made, and reports why.
    pub(super) fn sort_out<T>(
        &self,
        all: Vec<T>,
        record: &OutputRecord,
        job: impl Fn(&T) -> &Job,
    ) -> (Vec<T>, Vec<T>) {
        if !self.resume {
            return (Vec::new(), all);
        }
        let mut states = Vec::with_capacity(all.len());
        let (skipped, to_do) = all.into_iter().partition(|item| {
            let state = record.state_of(job(item));
            states.push(state);
            if state.stays() {
                self.left(job(item));
            }
            state.stays()
        });
        tell_states(&states, self.reporter);
        (skipped, to_do)
    }

    /// Handles an output that is kept: adds its line to the log if it is missing there.
    fn left(&self, job: &Job) {
        let known = |log: &Log| log.knows(&job.out.display().to_string());
        if self.log.as_ref().is_some_and(|log| !known(log)) {
            self.log(&skipped(job));
        }
    }

    /// Claims a cell's file, writes it, records what it was made from and gives it its name.
    pub(super) fn cell(
        &self,
        job: &Job,
        record: &OutputRecord,
        make: impl FnOnce(Claimed) -> Result<Made, Failure>,
    ) -> Entry {
        let file = job.input.display();
        let failed = |e: OutputError| Failure(format!("{file}: {e}"));
        let resume = self.resume.then_some(record);
        let inputs = Stamp::of_inputs(job);
        let claimed = readable(&job.input)
            .and_then(|()| claim(job, self.options.force, resume, self.reporter).map_err(failed));
        let result = match claimed {
            Ok(Claim::Done) => return skipped(job),
            Ok(Claim::Ours(claimed)) => make(claimed),
            Err(failure) => Err(failure),
        };
        let failure = match result {
            Ok(Made { report, files }) => {
                let cell = Box::new(report);
                if self.records
                    && let Err(e) = record.add(job, inputs.as_deref(), &files.meshes(&job.out))
                {
                    self.reporter
                        .warning(&format!("{e}; --resume will know less"));
                }
                let entry = Entry::Done(cell);
                self.log(&entry);
                match files.finish().map_err(failed) {
                    Ok(()) => return entry,
                    Err(failure) => failure,
                }
            }
            Err(failure) => failure,
        };
        self.failed(job, failure)
    }

    /// The entry of a cell that failed; also logs it.
    pub(super) fn failed(&self, job: &Job, failure: Failure) -> Entry {
        let entry = Entry::Failed(Failed {
            file: job.input.display().to_string(),
            error: failure.0,
        });
        self.log(&entry);
        entry
    }

    /// The entry of a cell at which the program panicked; also logs it.
    pub(super) fn panicked(&self, job: &Job, panic: &str) -> Entry {
        self.failed(job, bug(&job.input.display().to_string(), panic))
    }
}
