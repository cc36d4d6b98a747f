//! How work is watched.

use std::sync::atomic::{AtomicBool, Ordering};

/// A way to stop work, a clock that says what it took, and someone who is told how far it is. The default never stops,
/// has no clock, and tells nobody.
#[derive(Clone, Copy, Default)]
pub struct Watch<'w> {
    stopped: Option<&'w AtomicBool>,
    clock: Option<&'w (dyn Fn() -> f64 + Sync)>,
    progress: Option<&'w (dyn Fn(Progress) + Sync)>,
}

/// How far work is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Steps that are done.
    pub done: usize,
    /// Steps in all, about; never 0.
    pub all: usize,
}

/// What is being done about a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stage {
    /// Its coarse mesh.
    Mesh,
    /// What crosses becomes one surface.
    Merge,
    /// Its files, block by block.
    Write,
}

/// Another thread stopped the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped")]
pub struct Stopped;

impl<'w> Watch<'w> {
    /// Work that ends soon after another thread sets `stopped`.
    pub fn stopped_by(stopped: &'w AtomicBool) -> Self {
        Self {
            stopped: Some(stopped),
            ..Self::default()
        }
    }

    /// With a clock, which tells the seconds since any moment. Nothing but seconds in reports depends on it.
    #[must_use]
    pub fn with_clock(self, clock: &'w (dyn Fn() -> f64 + Sync)) -> Self {
        Self {
            clock: Some(clock),
            ..self
        }
    }

    /// With someone who is told how far it is, by any thread.
    #[must_use]
    pub fn with_progress(self, progress: &'w (dyn Fn(Progress) + Sync)) -> Self {
        Self {
            progress: Some(progress),
            ..self
        }
    }

    /// Whether to stop. Loops then end early, with whatever they have, and [`check`](Self::check) after them is the error that
    /// keeps it from being used.
    pub fn is_stopped(&self) -> bool {
        // Nothing else is read by it: a moment later is as good.
        (self.stopped).is_some_and(|stopped| stopped.load(Ordering::Relaxed))
    }

    /// An error once the work is stopped.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn check(&self) -> Result<(), Stopped> {
        match self.is_stopped() {
            true => Err(Stopped),
            false => Ok(()),
        }
    }

    /// Seconds since any moment; 0 without a clock.
    pub fn seconds(&self) -> f64 {
        self.clock.map_or(0.0, |clock| clock())
    }

    /// Tells how far it is.
    pub fn tell(&self, stage: Stage, done: usize, all: usize) {
        if let Some(progress) = self.progress {
            progress(Progress { stage, done, all });
        }
    }
}
