//! Background tasks: a thread that reports its progress, can be canceled, and returns a result. A
//! panic is an error with its text.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};

use crate::io::background::spawn;

/// Progress of a task.
#[derive(Clone, Debug)]
pub(crate) struct Progress {
    /// What it does.
    pub(crate) what: String,
    /// The name of its steps, as in `tiles`.
    pub(crate) steps: &'static str,
    /// Number of steps done.
    pub(crate) done: Arc<AtomicUsize>,
    /// Number of all steps; 0 if that is not known yet.
    pub(crate) all: Arc<AtomicUsize>,
    /// What it does just now, where that changes.
    doing: Arc<Mutex<&'static str>>,
    /// Set to cancel it.
    pub(crate) canceled: Arc<AtomicBool>,
}

impl Progress {
    pub(crate) fn new(what: &str, steps: &'static str, all: usize) -> Self {
        Self {
            what: what.to_owned(),
            steps,
            done: Arc::default(),
            all: Arc::new(AtomicUsize::new(all)),
            doing: Arc::default(),
            canceled: Arc::default(),
        }
    }

    /// Notes what it does just now.
    pub(crate) fn note(&self, doing: &'static str) {
        *self.doing.lock().unwrap_or_else(PoisonError::into_inner) = doing;
    }

    /// Cancels the task.
    pub(crate) fn cancel(&self) {
        self.canceled.store(true, Ordering::Relaxed);
    }

    /// Whether it was canceled.
    pub(crate) fn is_canceled(&self) -> bool {
        self.canceled.load(Ordering::Relaxed)
    }

    /// What it does and its progress, as text.
    pub(crate) fn text(&self) -> String {
        let (what, steps) = (&self.what, self.steps);
        let counted = match [&self.done, &self.all].map(|n| n.load(Ordering::Relaxed)) {
            [_, 0 | 1] => what.clone(),
            [done, all] => format!("{what}: {done} of {all} {steps}"),
        };
        match *self.doing.lock().unwrap_or_else(PoisonError::into_inner) {
            "" => counted,
            doing => format!("{counted} ({doing})"),
        }
    }

    /// The share that is done, 0 to 1.
    pub(crate) fn share(&self) -> f32 {
        let all = self.all.load(Ordering::Relaxed).max(1);
        self.done.load(Ordering::Relaxed) as f32 / all as f32
    }
}

/// A background task.
pub(crate) struct Task<T> {
    progress: Progress,
    result: Receiver<Result<T, String>>,
}

impl<T: Send + 'static> Task<T> {
    /// Starts `work`; `wake` is called when it has ended, also by a panic.
    pub(crate) fn start(
        progress: Progress,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Progress) -> Result<T, String> + Send + 'static,
    ) -> Self {
        let (sender, result) = channel();
        let own = progress.clone();
        spawn(move || {
            // If the window is closed, nothing receives it.
            let _ = sender.send(caught(|| work(&own)));
            wake();
        });
        Self { progress, result }
    }

    /// The result, when the task has ended; returned only once.
    pub(crate) fn take(&self) -> Option<Result<T, String>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("its thread ended without a word".into())),
        }
    }

    pub(crate) fn progress(&self) -> &Progress {
        &self.progress
    }
}

impl<T> Drop for Task<T> {
    /// Nobody waits for the result any more.
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

/// The result of `work`; a panic becomes an error with its text, so that a bug that one cell
/// triggers fails that cell only.
pub(crate) fn caught<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic_text(&*panic);
        Err(format!(
            "a bug in neurotess ({text}): please report it with the file"
        ))
    })
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let literal = panic.downcast_ref::<&str>().copied();
    let formatted = panic.downcast_ref::<String>().map(String::as_str);
    literal.or(formatted).unwrap_or("it said nothing")
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    fn result_of(
        work: impl FnOnce(&Progress) -> Result<u32, String> + Send + 'static,
    ) -> Result<u32, String> {
        let (woken, wakes) = channel();
        let wake = move || woken.send(()).unwrap_or_default();
        let task = Task::start(Progress::new("counting", "steps", 3), wake, work);
        wakes.recv().expect("woken, however it ends");
        task.take().expect("ended")
    }

    #[test]
    fn a_panic_is_a_result_with_its_text() {
        let why = result_of(|_| panic!("ring {} is open", 3)).expect_err("a panic");
        assert!(
            why.contains("ring 3 is open") && why.contains("report it"),
            "{why}"
        );
        let why = result_of(|_| panic!("no ring")).expect_err("a panic");
        assert!(why.contains("no ring"), "{why}");
        assert_eq!(result_of(|_| Err("no file".into())), Err("no file".into()));
        assert_eq!(result_of(|_| Ok(7)), Ok(7));
    }

    #[test]
    fn a_task_says_how_far_it_is_and_can_be_canceled() {
        let progress = Progress::new("counting", "steps", 4);
        progress.done.store(1, Ordering::Relaxed);
        assert_eq!(
            (progress.text().as_str(), progress.share()),
            ("counting: 1 of 4 steps", 0.25)
        );
        progress.note("by hand");
        assert_eq!(progress.text(), "counting: 1 of 4 steps (by hand)");
        let task = Task::start(
            progress,
            || {},
            |progress| {
                while !progress.is_canceled() {
                    std::thread::yield_now();
                }
                Ok(())
            },
        );
        assert!(task.take().is_none());
        task.progress().cancel();
        let ended = std::iter::repeat_with(|| task.take()).find_map(|result| result);
        assert_eq!(ended, Some(Ok(())));
    }
}
