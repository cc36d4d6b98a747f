//! The same work for every input, on all cores.

use std::sync::atomic::Ordering;

use itertools::Itertools;
use neurotess::batch::{Input, Inputs};

use super::{inputs, workers};
use crate::report::{Entry, Failed, Failure, Progress, Reporter, bug};

/// Does some work for all inputs in parallel, and reports failures. Results are in the inputs'
/// order.
pub(crate) fn each<T: Send>(
    found: &Inputs,
    reporter: &Reporter,
    work: impl Fn(&Input) -> Result<T, Failure> + Sync,
) -> anyhow::Result<Vec<Entry<T>>> {
    inputs::tell(found, reporter);
    let progress = Progress::new(reporter, found.files.len(), "files");
    let order: Vec<usize> = (0..found.files.len()).collect();
    let results = workers::run(&found.files, &order, reporter.threads(), |input| {
        let result = match reporter.stopped().load(Ordering::Relaxed) {
            true => Err(Failure("stopped".into())),
            false => work(input),
        };
        progress.done();
        result
    })?;
    drop(progress);
    let named = found.files.iter().zip_eq(results);
    let entries = named.map(|(input, result)| {
        let file = input.path.display().to_string();
        match result.unwrap_or_else(|panic| Err(bug(&file, &panic))) {
            Ok(done) => Entry::Done(done),
            Err(failure) => {
                reporter.failure(&failure);
                Entry::Failed(Failed {
                    file,
                    error: failure.0,
                })
            }
        }
    });
    Ok(entries.collect())
}
