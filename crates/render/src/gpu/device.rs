//! The GPU without a window: its limits and its errors.
//!
//! Errors of wgpu arrive asynchronously and panic by default. Here they are kept until they are
//! taken: by [`Gpu::check`] after making resources, by [`Gpu::wait`] after submitting work. On a device of another
//! program, whose handlers stay as they are, they are kept by scopes: [`Gpu::scoped`].

use std::sync::{Arc, Mutex, PoisonError};

use neurotess_picture::PictureOptions;
use wgpu::{Adapter, Limits};

use crate::gpu::adapter::{AdapterName, find_adapter, name};
use crate::gpu::error::DeviceError;
use crate::gpu::heap;
use crate::gpu::requirements::{Requirements, optional_features};
use crate::gpu::scopes::Scopes;

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
    handlers: Handlers,
    /// Whether shaders can run for each sample of a pixel.
    pub(crate) shades_samples: bool,
}

/// Whose functions the device calls when something goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Handlers {
    Ours,
    Hosts,
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
    /// The device has the adapter's own limits, and those of
    /// [`optional_features`](crate::adapter::optional_features) that it supports.
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

    /// What a device must have, for programs that open their own: see [`Gpu::of_host`].
    pub fn requirements() -> Requirements {
        Requirements::new()
    }

    /// Takes over a device that was opened elsewhere by [`device_descriptor`]: sets its handlers, so that from now on
    /// [`Gpu::check`] returns its errors. For a program that only draws with this crate.
    pub fn share(adapter: &Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let gpu = Self::new(adapter, device, queue, Handlers::Ours);
        let (of_work, of_device) = (gpu.fault.clone(), gpu.fault.clone());
        gpu.device
            .on_uncaptured_error(Arc::new(move |error| of_work.keep(complaint(error))));
        // Called also when the device is destroyed; then nothing checks for errors any more.
        gpu.device.set_device_lost_callback(move |_, message| {
            of_device.keep(DeviceError::Lost(one_line(&message)));
        });
        gpu
    }

    /// Draws with a device that another program has opened, with what [`Gpu::requirements`] asks for. Its handlers of
    /// errors and of its loss stay that program's.
    ///
    /// [`Composite`](crate::Composite) returns the errors of what it does. Whatever else takes this value belongs into
    /// [`Gpu::scoped`]; outside of it errors come to the program's handler. That the device is lost only the program
    /// hears.
    ///
    /// # Errors
    /// The adapter cannot draw, or the device was opened with less than is needed.
    pub fn of_host(
        adapter: &Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Result<Self, DeviceError> {
        Self::requirements().check(adapter, &device)?;
        Ok(Self::new(adapter, device, queue, Handlers::Hosts))
    }

    fn new(
        adapter: &Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
        handlers: Handlers,
    ) -> Self {
        let able = adapter.get_downlevel_capabilities().flags;
        let shades_samples = able.contains(wgpu::DownlevelFlags::MULTISAMPLED_SHADING);
        let adapter = name(adapter);
        if adapter.software {
            heap::keep_freed_memory();
        }
        Self {
            device,
            queue,
            adapter,
            fault: Fault::default(),
            handlers,
            shades_samples,
        }
    }

    /// Does some work and returns its errors, on a device of another program too: instead of coming to that program's
    /// handler they are returned here. On a device of ours it is the work and a check.
    ///
    /// # Errors
    /// The first error of the device, or else that of the work.
    pub fn scoped<T, E: From<DeviceError>>(
        &self,
        work: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        let done = self.caught(work);
        // Within scopes checks find nothing, so an error of the work may be what follows from the device's.
        self.check()?;
        done
    }

    /// Does some work of this thread, whose errors are kept until they are taken.
    pub(crate) fn caught<T>(&self, work: impl FnOnce() -> T) -> T {
        match self.handlers {
            Handlers::Ours => work(),
            Handlers::Hosts => {
                let scopes = Scopes::open(&self.device);
                let done = work();
                scopes
                    .close()
                    .for_each(|error| self.fault.keep(complaint(error)));
                done
            }
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
