//! Threads beside the window, kept: a driver takes itself down when the program ends, and a thread that
//! still draws then would crash it. So whoever ends the program joins them.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use rayon::ThreadPoolBuilder;

/// Time between looks at whether threads have ended.
const CHECK_INTERVAL: Duration = Duration::from_millis(5);

static THREADS: Mutex<Vec<JoinHandle<()>>> = Mutex::new(Vec::new());

fn threads() -> MutexGuard<'static, Vec<JoinHandle<()>>> {
    THREADS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs `work` on a thread of its own.
pub(crate) fn spawn(work: impl FnOnce() + Send + 'static) {
    join_ended();
    threads().push(std::thread::spawn(work));
}

/// Runs `work` and its parallel parts on threads apart from those that the window's own parallel parts would wait for.
pub(crate) fn apart<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match ThreadPoolBuilder::new().build() {
        Ok(pool) => pool.install(work),
        // There are no more threads to be had.
        Err(_) => work(),
    }
}

/// Waits until no thread runs that the window has started, `limit` at most. Returns whether none does.
pub fn wait_for_background(limit: Duration) -> bool {
    let end = Instant::now() + limit;
    while join_ended() > 0 {
        if Instant::now() >= end {
            return false;
        }
        sleep(CHECK_INTERVAL);
    }
    true
}

/// Joins threads whose work is done, and returns how many are left. Only then is what a driver keeps for a thread
/// gone, too: that is freed after the work.
fn join_ended() -> usize {
    let mut kept = threads();
    let ended: Vec<_> = kept.extract_if(.., |thread| thread.is_finished()).collect();
    let left = kept.len();
    drop(kept);
    for thread in ended {
        // One that panicked has said so.
        let _ = thread.join();
    }
    left
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn threads_are_waited_for() {
        let (go_on, told) = channel::<()>();
        spawn(move || {
            let _ = told.recv();
        });
        assert!(!wait_for_background(Duration::from_millis(10)));
        spawn(|| std::panic::resume_unwind(Box::new("over")));
        drop(go_on);
        assert!(wait_for_background(Duration::from_secs(60)));
    }
}
