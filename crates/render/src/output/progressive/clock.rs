//! When submitted work is done, and how long it took.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use crate::gpu::device::Gpu;

/// Counts submitted and finished work.
#[derive(Debug, Default)]
pub(super) struct Clock {
    pub(super) submitted: AtomicU64,
    pub(super) done: AtomicU64,
    /// Microseconds that the last work took.
    pub(super) took: AtomicU64,
}

impl Clock {
    pub(super) fn start(self: &Arc<Self>, gpu: &Gpu) {
        let number = self.submitted.fetch_add(1, Ordering::AcqRel) + 1;
        let (clock, begun) = (Arc::clone(self), Instant::now());
        gpu.queue.on_submitted_work_done(move || {
            let took = begun.elapsed().as_micros() as u64;
            clock.took.store(took, Ordering::Release);
            clock.done.fetch_max(number, Ordering::AcqRel);
        });
    }
}
