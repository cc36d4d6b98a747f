//! Many inputs on all cores.

use neurotess::batch::workers::{self, NotedPanics};

/// [`workers::run`]; panics are told by whoever takes the results.
pub(crate) fn run<I: Sync, T: Send>(
    items: &[I],
    order: &[usize],
    threads: usize,
    work: impl Fn(&I) -> T + Sync,
) -> anyhow::Result<Vec<Result<T, String>>> {
    let _noted = NotedPanics::begin();
    Ok(workers::run(items, order, threads, work)?)
}
