//! A way to stop from another thread.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::GenerateError;

/// Tells whether another thread asks to stop. Loops then end early, with whatever they have, and
/// [`check`](Self::check) after them is the error that keeps it from being used.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop<'a>(pub(crate) &'a AtomicBool);

#[cfg(test)]
impl Stop<'static> {
    /// Nobody asks.
    pub(crate) const NEVER: Self = {
        static NEVER: AtomicBool = AtomicBool::new(false);
        Self(&NEVER)
    };
}

impl Stop<'_> {
    /// Whether to stop.
    pub(crate) fn asked(self) -> bool {
        // Nothing else is read by it: a moment later is as good.
        self.0.load(Ordering::Relaxed)
    }

    /// The error of what was stopped.
    pub(crate) fn check(self) -> Result<(), GenerateError> {
        match self.asked() {
            true => Err(GenerateError::Stopped),
            false => Ok(()),
        }
    }
}
