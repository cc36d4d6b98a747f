//! What is said and logged of a batch while it runs.

use std::time::Instant;

use neurotess::Batch;
use neurotess::batch::workers::NotedPanics;
use neurotess::batch::{BatchError, Entry, Event, OutputState, Plan};
use neurotess::recipe::{Progress as Told, Spelling};

use super::args::MeshArgs;
use super::messages::{summarize, tell, tell_states};
use crate::report::{Log, Progress, Reporter, Usage};

/// What is to be done.
///
/// # Errors
/// Wrong usage.
pub(super) fn plan_of(batch: Batch) -> anyhow::Result<Plan> {
    batch.plan().map_err(|e| match e {
        BatchError::Options(error) => Usage(error.told(Spelling::Flag)).into(),
        BatchError::Target(error) => Usage(error.to_string()).into(),
        other => other.into(),
    })
}

/// Does what is to be done, and reports it. `alone`: whether a single cell is told of in detail.
pub(super) fn follow(
    plan: Plan,
    args: &MeshArgs,
    alone: bool,
    clock: Instant,
    reporter: &Reporter,
) -> anyhow::Result<()> {
    let log = Lines {
        log: args.log.as_deref().map(Log::open).transpose()?,
        reporter,
    };
    log.kept(&plan);
    let states: Vec<OutputState> = plan.jobs().filter_map(|(_, state)| state).collect();
    tell_states(&states, reporter);
    let to_do = plan.to_do();
    let skipped = plan.jobs().count() - to_do;
    let one = alone && to_do == 1;
    let (total, unit) = if one { (0, "steps") } else { (to_do, "cells") };
    let progress = Progress::new(reporter, total, unit);
    let told = |event: Event<'_>| match event {
        Event::Waiting(job) => {
            let out = job.out.display();
            reporter.note(&format!("{out} is being written by another run: waiting"));
        }
        Event::Progress(_, Told { done, all, .. }) if one => progress.at(done, all),
        Event::Large(large) => reporter.warning(&large.told(Spelling::Flag)),
        Event::Unrecorded(error) => {
            reporter.warning(&format!("{error}; --resume will know less"));
        }
        Event::Written(report) => log.line(&Entry::Done(report)),
        Event::Ended(outcome) => {
            let entry = Entry::new(outcome, Spelling::Flag);
            if let Entry::Failed { .. } = &entry {
                log.line(&entry);
            }
            tell(&entry, one, reporter);
            if !one {
                progress.done();
            }
        }
        _ => {}
    };
    let noted = NotedPanics::begin();
    let report = plan.run(told)?;
    drop((noted, progress));
    let entries = report.entries(Spelling::Flag);
    summarize(&entries, skipped, clock, reporter);
    reporter.document(&entries)
}

/// The log, if there is one.
struct Lines<'r> {
    log: Option<Log>,
    reporter: &'r Reporter,
}

impl Lines<'_> {
    fn line(&self, entry: &Entry<'_>) {
        if let Some(log) = &self.log
            && let Err(failure) = log.line(entry)
        {
            self.reporter.failure(&failure);
        }
    }

    /// Adds lines of outputs that are kept where they are missing.
    fn kept(&self, plan: &Plan) {
        let Some(log) = &self.log else {
            return;
        };
        for (job, state) in plan.jobs() {
            let stays = state.is_some_and(OutputState::stays);
            if stays && !log.knows(&job.out.display().to_string()) {
                self.line(&Entry::kept(job));
            }
        }
    }
}
