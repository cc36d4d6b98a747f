//! The pixels of a tile, from the device.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::output::watched::wait;
use neurotess_picture::Watch;

/// Waits for the device and copies the first bytes of a buffer; nothing if the watch has stopped
/// the picture.
pub(super) fn read_watched(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    bytes: u64,
    watch: Option<&Watch>,
) -> Result<Option<Vec<u8>>, DeviceError> {
    let slice = buffer.slice(..bytes);
    let mapped = Arc::new(AtomicBool::new(false));
    let done = Arc::clone(&mapped);
    slice.map_async(wgpu::MapMode::Read, move |_| {
        done.store(true, Ordering::Release);
    });
    match watch {
        Some(watch) if !wait(watch, gpu, &mapped)? => return Ok(None),
        Some(_) => {}
        None => gpu.wait()?,
    }
    let copied = slice
        .get_mapped_range()
        .map(|range| range.to_vec())
        .map_err(|e| DeviceError::Lost(e.to_string()))?;
    buffer.unmap();
    Ok(Some(copied))
}

/// Pixels with those that were not written, which are 0, as an empty picture has them. With a background none
/// that was written is 0; without one, so is the empty pixel.
pub(super) fn filled(mut pixels: Vec<u8>, empty: [u8; 4]) -> Vec<u8> {
    for pixel in pixels.chunks_exact_mut(4) {
        if pixel == [0; 4] {
            pixel.copy_from_slice(&empty);
        }
    }
    pixels
}
