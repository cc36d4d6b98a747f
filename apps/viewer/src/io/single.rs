//! Background work of which only one piece runs at a time: whoever asks again asks when it has ended.

use std::sync::Arc;

use crate::io::task::{Progress, Task};

/// One piece of background work, and what it is for.
pub(crate) struct Single<K, T> {
    running: Option<(K, Task<T>)>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl<K, T: Send + 'static> Single<K, T> {
    /// `wake` is called when work has ended.
    pub(crate) fn new(wake: &Arc<dyn Fn() + Send + Sync>) -> Self {
        Self {
            running: None,
            wake: Arc::clone(wake),
        }
    }

    /// Whether work is running.
    pub(crate) fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Whether work for this is running.
    pub(crate) fn is_of(&self, of: &K) -> bool
    where
        K: PartialEq,
    {
        self.running.as_ref().is_some_and(|(key, _)| key == of)
    }

    /// The progress of what is running.
    pub(crate) fn progress(&self) -> Option<Progress> {
        let running = self.running.as_ref();
        running.map(|(_, task)| task.progress().clone())
    }

    /// Starts work. What was running before is canceled, and its result dropped.
    pub(crate) fn start(
        &mut self,
        of: K,
        progress: Progress,
        work: impl FnOnce(&Progress) -> Result<T, String> + Send + 'static,
    ) {
        self.cancel();
        let wake = Arc::clone(&self.wake);
        self.running = Some((of, Task::start(progress, move || wake(), work)));
    }

    /// Cancels what is running: its result is dropped.
    pub(crate) fn cancel(&mut self) {
        if let Some((_, task)) = self.running.take() {
            task.progress().cancel();
        }
    }

    /// The result, when the work has ended.
    pub(crate) fn take(&mut self) -> Option<(K, Result<T, String>)> {
        let (_, task) = self.running.as_ref()?;
        let result = task.take()?;
        let (of, _) = self.running.take()?;
        Some((of, result))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn the_newest_work_has_a_result_and_what_it_replaced_is_canceled() {
        let (sender, receiver) = channel();
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(|| {});
        let mut single: Single<u32, u32> = Single::new(&wake);
        assert!(single.take().is_none() && !single.is_busy());
        single.start(1, Progress::new("counting", "steps", 1), move |progress| {
            while !progress.is_canceled() {
                std::thread::yield_now();
            }
            sender.send(()).map_err(|e| e.to_string())?;
            Ok(1)
        });
        single.start(2, Progress::new("counting", "steps", 1), |_| Ok(7));
        receiver.recv().expect("the first one was canceled");
        let ended = std::iter::repeat_with(|| single.take()).find_map(|taken| taken);
        assert_eq!(ended, Some((2, Ok(7))));
        assert!(!single.is_busy());
    }
}
