//! Many inputs on all cores, never more in flight than there are threads.
//!
//! **Why not** rayon's own iterators over the inputs: a thread that waits for the inner loop of one
//! cell would begin another cell meanwhile, and memory would hold more cells than threads. Here a
//! worker has a pool of its own: one thread if there are inputs for all, more if there are few.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Stack (bytes) of all threads: large, for debug builds.
const STACK: usize = 8 << 20;

thread_local! {
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// There are no threads to be had.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ThreadError {
    /// For the work on one item.
    #[error(transparent)]
    Pool(#[from] rayon::ThreadPoolBuildError),
    /// For a worker.
    #[error(transparent)]
    Worker(#[from] std::io::Error),
}

type Hook = dyn Fn(&panic::PanicHookInfo<'_>) + Send + Sync;

/// While it is there, panics of all threads are noted with their places, instead of being printed.
#[must_use = "panics are printed again once it is dropped"]
pub struct NotedPanics(Option<Box<Hook>>);

impl NotedPanics {
    /// For a program that tells of panics itself. There is one hook in a process: no library should call it.
    pub fn begin() -> Self {
        let before = panic::take_hook();
        panic::set_hook(Box::new(|info| {
            PANIC.with_borrow_mut(|text| *text = info.to_string().replace('\n', " "));
        }));
        Self(Some(before))
    }
}

impl Drop for NotedPanics {
    fn drop(&mut self) {
        if let Some(before) = self.0.take().filter(|_| !std::thread::panicking()) {
            panic::set_hook(before);
        }
    }
}

/// Runs `work` for every item, those at the front of `order` first, and returns the results in the
/// order of the items. A panic is a result too: the text says what happened, and where if [`NotedPanics`] are.
///
/// # Errors
/// The system gives no threads.
pub fn run<I: Sync, T: Send>(
    items: &[I],
    order: &[usize],
    threads: usize,
    work: impl Fn(&I) -> T + Sync,
) -> Result<Vec<Result<T, String>>, ThreadError> {
    let workers = threads.min(items.len()).max(1);
    let inner = threads.div_ceil(workers);
    let next = AtomicUsize::new(0);
    let results: Vec<_> = items.iter().map(|_| Mutex::new(None)).collect();
    let work_off = || {
        while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
            let done = guarded(|| work(&items[index]));
            *results[index]
                .lock()
                .unwrap_or_else(PoisonError::into_inner) = Some(done);
        }
    };
    std::thread::scope(|scope| {
        let spawn = |_| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(inner)
                .stack_size(STACK)
                .build()?;
            std::thread::Builder::new().spawn_scoped(scope, move || pool.install(work_off))?;
            Ok::<(), ThreadError>(())
        };
        (0..workers).try_for_each(spawn)
    })?;
    let taken = results.into_iter().map(|slot| {
        let slot = slot.into_inner().unwrap_or_else(PoisonError::into_inner);
        slot.unwrap_or_else(|| Err("not done".into()))
    });
    Ok(taken.collect())
}

/// What work gives, or what its panic says.
///
/// # Errors
/// The panic's text; with its place if [`NotedPanics`] are.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    let caught = panic::catch_unwind(AssertUnwindSafe(work));
    caught.map_err(|payload: Box<dyn Any + Send>| {
        // A panic in another thread of the pool comes without its location.
        let place = PANIC.take();
        let text = payload
            .downcast_ref::<String>()
            .cloned()
            .or_else(|| payload.downcast_ref::<&str>().map(|&s| s.to_owned()));
        if place.is_empty() {
            text.unwrap_or_default()
        } else {
            place
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_and_panics_stay_with_their_item() {
        let items: Vec<u32> = (0..20).collect();
        let order: Vec<usize> = (0..20).rev().collect();
        let work = |&i: &u32| if i == 7 { panic!("seven") } else { 2 * i };
        let results = run(&items, &order, 3, work).expect("threads");
        for (i, result) in items.iter().zip(results) {
            match result {
                Ok(double) => assert_eq!(double, 2 * i),
                Err(text) => assert!(*i == 7 && text.contains("seven"), "{text}"),
            }
        }
    }
}
