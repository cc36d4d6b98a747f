//! Work without the interpreter's lock, which Ctrl-C does not have to wait for, and stops.

use std::any::Any;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use pyo3::prelude::*;

use crate::errors::bug;

/// Time between two looks at whether Ctrl-C was pressed.
const LOOK: Duration = Duration::from_millis(50);

/// Stack (bytes) of threads: large, for debug builds.
const STACK: usize = 8 << 20;

/// The process that imported the package.
static HOME: OnceLock<u32> = OnceLock::new();

/// Notes that this is the process that imports the package.
pub(crate) fn note_process() {
    HOME.get_or_init(std::process::id);
}

/// Whether this process was forked from the one that imported the package. The threads that were there do not exist in
/// it: neither those of the common pool, which would be waited for for ever, nor those of a graphics driver.
pub(crate) fn is_forked() -> bool {
    HOME.get().is_some_and(|&home| home != std::process::id())
}

/// A pool of threads for one piece of work.
fn pool(threads: usize) -> PyResult<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.stack_size(STACK).build().map_err(bug)
}

/// Does some work on this thread without the interpreter's lock; in a forked process with threads of its own.
///
/// # Errors
/// `RuntimeError` if there are no threads.
pub(crate) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    match is_forked() {
        true => {
            let pool = pool(0)?;
            Ok(py.detach(|| pool.install(work)))
        }
        false => Ok(py.detach(work)),
    }
}

/// Asks work to stop: `set` by any thread, for all the work that it was given to.
#[pyclass(frozen, module = "neurotess._neurotess")]
#[derive(Clone, Default)]
pub(crate) struct Stop(pub(crate) Arc<AtomicBool>);

#[pymethods]
impl Stop {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Asks to stop. What is stopped ends soon, with an error.
    fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Stop {
    /// The one that was given, or a new one.
    pub(crate) fn of(given: Option<&Self>) -> Self {
        given.cloned().unwrap_or_default()
    }
}

/// Does some short work on another thread, or on as many threads as given, without the interpreter's lock.
///
/// # Errors
/// `KeyboardInterrupt` where Ctrl-C was pressed: the work is left to itself then, and what it gives is
/// dropped. `RuntimeError` if it panics.
pub(crate) fn released<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<usize>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    stoppable(py, threads, &Stop::default(), |_| work())
}

/// The same for long work, which ends soon after `stop` is set: by Ctrl-C, or by whoever else has it.
///
/// # Errors
/// As [`released`].
pub(crate) fn stoppable<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<usize>,
    stop: &Stop,
    work: impl FnOnce(&Arc<AtomicBool>) -> T + Send + 'static,
) -> PyResult<T> {
    let stopped = Arc::clone(&stop.0);
    let work = move || work(&stopped);
    let (sender, receiver) = mpsc::sync_channel(1);
    let guarded = move || {
        let done = panic::catch_unwind(AssertUnwindSafe(work));
        // Nobody listens any more if there was an interrupt.
        drop(sender.send(done));
    };
    // Of 0 threads: as many as there are cores.
    let own = threads
        .map(|threads| threads.max(1))
        .or(is_forked().then_some(0));
    match own {
        // Threads of its own, so that many cells at a time do not wait for one another.
        Some(threads) => pool(threads)?.spawn(guarded),
        None => {
            let thread = std::thread::Builder::new().stack_size(STACK);
            thread.spawn(guarded).map_err(bug)?;
        }
    }
    let receiver = Mutex::new(receiver);
    loop {
        let waited = py.detach(|| match receiver.lock() {
            Ok(receiver) => receiver.recv_timeout(LOOK),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        });
        match waited {
            Ok(done) => return done.map_err(|payload| bug(text(&*payload))),
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| stop.set())?,
            Err(RecvTimeoutError::Disconnected) => return Err(bug("a thread is gone")),
        }
    }
}

/// What a panic says.
fn text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().cloned();
    let text = text.or_else(|| payload.downcast_ref::<&str>().map(|&text| text.to_owned()));
    text.unwrap_or_else(|| "a panic".to_owned())
}
