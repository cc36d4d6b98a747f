//! How far a picture is, and whether it is still wanted, for a thread that waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// How often a picture that is watched is asked whether it is still wanted.
const ASKS: Duration = Duration::from_millis(4);

/// Shared by the thread that draws and the one that waits.
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

    /// Waits until what was given to the device is `done`; whether the picture is still wanted then.
    pub(crate) fn wait(&self, gpu: &Gpu, done: &AtomicBool) -> Result<bool, DeviceError> {
        while !done.load(Ordering::Acquire) {
            if self.is_stopped() {
                return Ok(false);
            }
            let polled = gpu.device.poll(wgpu::PollType::Poll);
            gpu.check()?;
            polled.map_err(|e| DeviceError::Lost(e.to_string()))?;
            std::thread::sleep(ASKS);
        }
        Ok(true)
    }
}
