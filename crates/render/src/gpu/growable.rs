//! Buffers that grow and keep what they hold.

use bytemuck::Pod;
use wgpu::BufferUsages;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// A buffer on the device that grows as elements are appended.
#[derive(Debug)]
pub(crate) struct GrowableBuffer {
    what: &'static str,
    pub(crate) buffer: wgpu::Buffer,
    /// Bytes in use.
    used: u64,
}

impl GrowableBuffer {
    /// An empty buffer with room for this many bytes.
    pub(crate) fn new(gpu: &Gpu, what: &'static str, bytes: u64) -> Self {
        Self {
            what,
            buffer: make(gpu, what, bytes),
            used: 0,
        }
    }

    /// Bytes in use.
    pub(crate) fn used(&self) -> u64 {
        self.used
    }

    /// Appends elements. True if the buffer was replaced by a larger one.
    ///
    /// # Errors
    /// The buffer would be larger than the device can bind, or the device reports another error.
    pub(crate) fn append<T: Pod>(&mut self, gpu: &Gpu, data: &[T]) -> Result<bool, DeviceError> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let grown = self.reserve(gpu, self.used + bytes.len() as u64)?;
        if !bytes.is_empty() {
            gpu.queue.write_buffer(&self.buffer, self.used, bytes);
        }
        self.used += bytes.len() as u64;
        Ok(grown)
    }

    /// Replaces all elements. True if the buffer was replaced by a larger one.
    ///
    /// # Errors
    /// As [`GrowableBuffer::append`].
    pub(crate) fn replace<T: Pod>(&mut self, gpu: &Gpu, data: &[T]) -> Result<bool, DeviceError> {
        self.used = 0;
        self.append(gpu, data)
    }

    /// Overwrites elements from this index on.
    pub(crate) fn write<T: Pod>(&self, gpu: &Gpu, first: usize, data: &[T]) {
        let at = (first * size_of::<T>()) as u64;
        gpu.queue
            .write_buffer(&self.buffer, at, bytemuck::cast_slice(data));
    }

    /// Makes room for this many bytes in all, or a fourth more, so that not every addition to a growing scene copies
    /// everything. True if the buffer was replaced by a larger one.
    ///
    /// # Errors
    /// As [`GrowableBuffer::append`].
    pub(crate) fn reserve(&mut self, gpu: &Gpu, bytes: u64) -> Result<bool, DeviceError> {
        if bytes <= self.buffer.size() {
            return Ok(false);
        }
        let most = gpu.largest_binding();
        self.reserve_exactly(gpu, bytes.max((bytes + bytes / 4).min(most / 4 * 4)))
    }

    /// Makes room for this many bytes in all. True if the buffer was replaced by a larger one.
    ///
    /// # Errors
    /// As [`GrowableBuffer::append`].
    pub(crate) fn reserve_exactly(&mut self, gpu: &Gpu, bytes: u64) -> Result<bool, DeviceError> {
        if bytes <= self.buffer.size() {
            return Ok(false);
        }
        let (what, most) = (self.what, gpu.largest_binding());
        if bytes > most {
            return Err(DeviceError::TooLarge { what, bytes, most });
        }
        let larger = make(gpu, what, bytes);
        if self.used > 0 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(&self.buffer, 0, &larger, 0, self.used);
            gpu.queue.submit([encoder.finish()]);
        }
        self.buffer = larger;
        gpu.check()?;
        Ok(true)
    }

    /// Counts bytes as used that were reserved.
    pub(crate) fn take(&mut self, bytes: u64) {
        self.used += bytes;
        debug_assert!(self.used <= self.buffer.size(), "reserved before");
    }
}

fn make(gpu: &Gpu, label: &str, bytes: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.max(256).next_multiple_of(4),
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}
