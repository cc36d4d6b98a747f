//! Threads beside the window, counted: a driver takes itself down when the program ends, and a thread that
//! still draws then would crash it. So whoever ends the program waits for them.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

static RUNNING: Mutex<usize> = Mutex::new(0);
static ENDED: Condvar = Condvar::new();

fn running() -> MutexGuard<'static, usize> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Counts a thread while it lives, also if it panics.
struct Counted;

impl Drop for Counted {
    fn drop(&mut self) {
        *running() -= 1;
        ENDED.notify_all();
    }
}

/// Runs `work` on a thread of its own.
pub(crate) fn spawn(work: impl FnOnce() + Send + 'static) {
    *running() += 1;
    let counted = Counted;
    std::thread::spawn(move || {
        // Dropped after the work, with all that it holds.
        let _counted = counted;
        work();
    });
}

/// Waits until no thread runs that the window has started, `limit` at most. Returns whether none does.
pub fn wait_for_background(limit: Duration) -> bool {
    let waited = ENDED.wait_timeout_while(running(), limit, |running| *running > 0);
    let (running, _) = waited.unwrap_or_else(PoisonError::into_inner);
    *running == 0
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
