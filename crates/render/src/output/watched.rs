//! Waits for the device, as long as a [`Watch`] lets it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use neurotess_picture::Watch;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// Time between checks whether the picture was stopped.
const CHECK_INTERVAL: Duration = Duration::from_millis(4);

/// Waits until the device has set `done`. False if the picture was stopped before.
pub(crate) fn wait(watch: &Watch, gpu: &Gpu, done: &AtomicBool) -> Result<bool, DeviceError> {
    while !done.load(Ordering::Acquire) {
        if watch.is_stopped() {
            return Ok(false);
        }
        let polled = gpu.device.poll(wgpu::PollType::Poll);
        gpu.check()?;
        polled.map_err(|e| DeviceError::Lost(e.to_string()))?;
        std::thread::sleep(CHECK_INTERVAL);
    }
    Ok(true)
}
