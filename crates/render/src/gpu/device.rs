//! The GPU without a window: its limits and its errors.
//!
//! Errors of wgpu arrive asynchronously and panic by default. Here they are kept until they are
//! taken: by [`Gpu::check`] after making resources, by [`Gpu::wait`] after submitting work.

use std::sync::{Arc, Mutex, PoisonError};

use neurotess_picture::PictureOptions;
use wgpu::{Adapter, Features, Limits};

use crate::gpu::adapter::{AdapterName, find_adapter, name};
use crate::gpu::error::DeviceError;
use crate::gpu::heap;

/// An open device with its queue.
#[derive(Debug)]
pub struct Gpu {
    /// The device, which makes resources.
    pub device: wgpu::Device,
    /// The queue, which takes work.
    pub queue: wgpu::Queue,
    /// The adapter's name.
    pub adapter: AdapterName,
    fault: Fault,
}

/// The first error since the last check. Once the device is lost, nothing else, however often it is taken:
/// all other errors follow from it, and of several threads that check each must hear of it.
#[derive(Clone, Debug, Default)]
struct Fault(Arc<Mutex<Option<DeviceError>>>);

impl Fault {
    fn keep(&self, error: DeviceError) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_lost = |error: &DeviceError| matches!(error, DeviceError::Lost(_));
        if kept
            .as_ref()
            .is_none_or(|kept| is_lost(&error) && !is_lost(kept))
        {
            *kept = Some(error);
        }
    }

    /// Rewrites the driver's message by `explain`.
    fn explain(&self, explain: impl Fn(&str) -> String) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(DeviceError::Driver(message)) = &mut *kept {
            *message = explain(message);
        }
    }

    fn take(&self) -> Option<DeviceError> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &*kept {
            Some(DeviceError::Lost(why)) => Some(DeviceError::Lost(why.clone())),
            _ => kept.take(),
        }
    }
}

impl Gpu {
    /// Number of sub-pixels along a pixel's side.
    pub fn sub_pixels(&self, options: &PictureOptions) -> u32 {
        options.sub_pixels(samples_in_sub_pixel(self, options.samples_taken()))
    }

    /// Opens the best adapter, or the best of those whose backend is `wanted` or whose name contains it (in
    /// upper or lower case). Without `wanted`, [`ADAPTER_VARIABLE`](crate::adapter::ADAPTER_VARIABLE)
    /// decides, if it is set.
    ///
    /// The device has the adapter's own limits, and those of [`optional_features`] that it
    /// supports.
    ///
    /// # Errors
    /// There is no such adapter, or its driver reports an error.
    pub fn open(wanted: Option<&str>) -> Result<Self, DeviceError> {
        let adapter = &find_adapter(wanted)?;
        let named = name(adapter);
        let refused = |reason: String| DeviceError::Refused {
            adapter: named.name.clone(),
            reason,
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&device_descriptor(adapter)))
                .map_err(|e| refused(e.to_string()))?;
        Ok(Self::share(adapter, device, queue))
    }

    /// Shares a device that was opened elsewhere by [`device_descriptor`]. From now on
    /// [`Gpu::check`] returns its errors.
    pub fn share(adapter: &Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let fault = Fault::default();
        let (of_work, of_device) = (fault.clone(), fault.clone());
        device.on_uncaptured_error(Arc::new(move |error| of_work.keep(complaint(error))));
        // Called also when the device is destroyed; then nothing checks for errors any more.
        device.set_device_lost_callback(move |_, message| {
            of_device.keep(DeviceError::Lost(one_line(&message)));
        });
        let adapter = name(adapter);
        if adapter.software {
            heap::keep_freed_memory();
        }
        Self {
            device,
            queue,
            adapter,
            fault,
        }
    }

    /// Whether the device has reported an error since the last call, or is lost.
    ///
    /// # Errors
    /// The first error, or that the device is lost.
    pub fn check(&self) -> Result<(), DeviceError> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// Rewrites the message of the driver's error that is still to be taken, if there is one.
    pub(crate) fn explain_fault(&self, explain: impl Fn(&str) -> String) {
        self.fault.explain(explain);
    }

    /// Waits until all submitted work is done.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn wait(&self) -> Result<(), DeviceError> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        waited
            .map(|_| ())
            .map_err(|e| DeviceError::Lost(one_line(&e.to_string())))
    }

    /// Most bytes of a buffer that can be bound as a whole.
    pub fn largest_binding(&self) -> u64 {
        let limits = self.device.limits();
        limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
    }

    /// Greatest width and height (pixels) of a texture.
    pub fn largest_texture(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }
}

/// Features that are used where an adapter supports them.
pub fn optional_features() -> Features {
    Features::TIMESTAMP_QUERY
}

/// The adapter's own limits: wgpu's defaults are a fraction of them.
fn limits(adapter: &Adapter) -> Limits {
    adapter.limits()
}

/// How devices are opened: with all that the adapter allows.
pub fn device_descriptor(adapter: &Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("neurotess"),
        required_features: adapter.features() & optional_features(),
        required_limits: limits(adapter),
        ..Default::default()
    }
}

fn complaint(error: wgpu::Error) -> DeviceError {
    match error {
        wgpu::Error::OutOfMemory { .. } => DeviceError::OutOfMemory,
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
            DeviceError::Driver(one_line(&description))
        }
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Number of samples of a sub-pixel: four; or one if a pixel has only one sample, and on OpenGL,
/// for which naga 30 translates sample masks wrongly.
pub(crate) fn samples_in_sub_pixel(gpu: &Gpu, samples: u32) -> u32 {
    if samples == 1 || gpu.adapter.backend == "gl" {
        1
    } else {
        4
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_device_explains_all_its_errors() {
        let fault = Fault::default();
        let [first, second] = ["first", "second"].map(|text| DeviceError::Driver(text.into()));
        fault.keep(first.clone());
        fault.keep(second.clone());
        assert_eq!(fault.take(), Some(first.clone()));
        assert_eq!(fault.take(), None);
        fault.keep(first);
        fault.keep(DeviceError::Lost("gone".into()));
        fault.keep(second);
        for _ in 0..2 {
            assert_eq!(fault.take(), Some(DeviceError::Lost("gone".into())));
        }
    }

    #[test]
    fn an_unknown_adapter_is_an_error_that_lists_those_there() {
        let error = Gpu::open(Some("no such adapter")).expect_err("unknown");
        assert!(matches!(
            error,
            DeviceError::UnknownAdapter { .. } | DeviceError::NoAdapter
        ));
    }
}
