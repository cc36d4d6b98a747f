//! How work is watched.

use std::sync::atomic::{AtomicBool, Ordering};

/// A way to stop work, and a clock that says what it took. The default never stops, and has no clock.
#[derive(Clone, Copy, Default)]
pub struct Watch<'w> {
    stopped: Option<&'w AtomicBool>,
    clock: Option<&'w dyn Fn() -> f64>,
}

static RUNNING: AtomicBool = AtomicBool::new(false);

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
    pub fn with_clock(self, clock: &'w dyn Fn() -> f64) -> Self {
        Self {
            clock: Some(clock),
            ..self
        }
    }

    pub(crate) fn flag(&self) -> &AtomicBool {
        self.stopped.unwrap_or(&RUNNING)
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.flag().load(Ordering::Relaxed)
    }

    /// Seconds since any moment; 0 without a clock.
    pub(crate) fn seconds(&self) -> f64 {
        self.clock.map_or(0.0, |clock| clock())
    }
}
