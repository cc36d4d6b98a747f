//! Progress of a picture, and a way to stop it, for another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// Time between checks whether the picture was stopped.
const CHECK_INTERVAL: Duration = Duration::from_millis(4);

/// Shared by the thread that draws and another one.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// Tiles that are done.
    pub tiles: Arc<AtomicUsize>,
    /// Set to end the picture at once, in the middle of a tile.
    pub stopped: Arc<AtomicBool>,
}

impl Watch {
    pub(crate) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    pub(crate) fn note_tile(&self) {
        self.tiles.fetch_add(1, Ordering::Relaxed);
    }

    /// Waits until the device has set `done`. False if the picture was stopped before.
    pub(crate) fn wait(&self, gpu: &Gpu, done: &AtomicBool) -> Result<bool, DeviceError> {
        while !done.load(Ordering::Acquire) {
            if self.is_stopped() {
                return Ok(false);
            }
            let polled = gpu.device.poll(wgpu::PollType::Poll);
            gpu.check()?;
            polled.map_err(|e| DeviceError::Lost(e.to_string()))?;
            std::thread::sleep(CHECK_INTERVAL);
        }
        Ok(true)
    }
}
