//! The GPU without a window: its adapter, its limits and its errors.
//!
//! Errors of wgpu arrive asynchronously and panic by default. Here they are kept until they are
//! taken: by [`Gpu::check`] after making resources, by [`Gpu::wait`] after submitting work.

use std::sync::{Arc, Mutex, PoisonError};

use wgpu::{Adapter, Backends, DeviceType, Features, Limits};

use crate::gpu::error::DeviceError;
use crate::gpu::heap;

/// Environment variable that names the adapter if nothing else does.
pub const ADAPTER_VARIABLE: &str = "NEUROTESS_ADAPTER";

/// Names of backends.
const BACKENDS: [&str; 4] = ["vulkan", "metal", "dx12", "gl"];

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

/// Name of an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterName {
    /// Name and driver, as in `llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 22.3.6`.
    pub name: String,
    /// `vulkan`, `metal`, `dx12` or `gl`.
    pub backend: String,
    /// Whether it draws on the CPU.
    pub software: bool,
}

/// The first error since the last check.
#[derive(Clone, Debug, Default)]
struct Fault(Arc<Mutex<Option<DeviceError>>>);

impl Fault {
    fn keep(&self, error: DeviceError) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get_or_insert(error);
    }

    /// Rewrites the driver's message by `explain`.
    fn explain(&self, explain: impl Fn(&str) -> String) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(DeviceError::Driver(message)) = &mut *kept {
            *message = explain(message);
        }
    }

    fn take(&self) -> Option<DeviceError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Names of all adapters, the best first.
pub fn adapters() -> Vec<AdapterName> {
    let mut adapters = found(Backends::PRIMARY);
    adapters.extend(found(Backends::SECONDARY));
    adapters.iter().map(name).collect()
}

impl Gpu {
    /// Opens the best adapter, or the best of those whose backend is `wanted` or whose name contains it (in
    /// upper or lower case). Without `wanted`, [`ADAPTER_VARIABLE`] decides, if it is set.
    ///
    /// The device has the adapter's own limits, and those of [`optional_features`] that it
    /// supports.
    ///
    /// # Errors
    /// There is no such adapter, or its driver reports an error.
    pub fn open(wanted: Option<&str>) -> Result<Self, DeviceError> {
        let variable = std::env::var(ADAPTER_VARIABLE).ok();
        let wanted = wanted.or(variable.as_deref()).filter(|w| !w.is_empty());
        // OpenGL last and only if needed, since without a display it prints messages when it
        // starts.
        let mut adapters = found(Backends::PRIMARY);
        if choose(&adapters, wanted).is_err() {
            adapters.extend(found(Backends::SECONDARY));
        }
        let adapter = choose(&adapters, wanted)?;
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

    /// Whether the device has reported an error since the last call.
    ///
    /// # Errors
    /// The first error.
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

/// The best of these adapters that can do what we need, or the best whose backend is `wanted` or whose
/// name contains it; without `wanted`, [`ADAPTER_VARIABLE`] decides, if it is set.
///
/// # Errors
/// No such adapter.
pub fn select_adapter(adapters: &[Adapter], wanted: Option<&str>) -> Result<Adapter, DeviceError> {
    let variable = std::env::var(ADAPTER_VARIABLE).ok();
    let wanted = wanted.or(variable.as_deref()).filter(|w| !w.is_empty());
    let mut able: Vec<Adapter> = adapters.iter().filter(|a| is_able(a)).cloned().collect();
    able.sort_by_key(rank);
    choose(&able, wanted).cloned()
}

fn is_able(adapter: &Adapter) -> bool {
    let able = wgpu::DownlevelFlags::COMPUTE_SHADERS
        | wgpu::DownlevelFlags::VERTEX_STORAGE
        | wgpu::DownlevelFlags::INDIRECT_EXECUTION;
    adapter.get_downlevel_capabilities().flags.contains(able)
}

/// Adapters that can do what we need, the best first.
fn found(backends: Backends) -> Vec<Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.retain(is_able);
    adapters.sort_by_key(rank);
    adapters
}

/// Real GPUs first.
fn rank(adapter: &Adapter) -> u8 {
    match adapter.get_info().device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

fn choose<'a>(adapters: &'a [Adapter], wanted: Option<&str>) -> Result<&'a Adapter, DeviceError> {
    let best = adapters.first().ok_or(DeviceError::NoAdapter)?;
    let Some(wanted) = wanted else {
        return Ok(best);
    };
    let names: Vec<AdapterName> = adapters.iter().map(name).collect();
    match names.iter().position(|name| name.answers_to(wanted)) {
        Some(place) => Ok(&adapters[place]),
        None => Err(DeviceError::UnknownAdapter {
            wanted: wanted.to_owned(),
            there: names.iter().map(ToString::to_string).collect(),
        }),
    }
}

fn name(adapter: &Adapter) -> AdapterName {
    let info = adapter.get_info();
    let driver = [info.driver, info.driver_info].join(" ");
    let name = match driver.trim() {
        "" => info.name,
        driver => format!("{}, {driver}", info.name),
    };
    AdapterName {
        name,
        backend: info.backend.to_str().to_owned(),
        software: info.device_type == DeviceType::Cpu,
    }
}

impl AdapterName {
    /// Whether it is what a backend or a part of a name means. A backend means no names: "gl" is in those of
    /// Google's Vulkan drivers.
    fn answers_to(&self, wanted: &str) -> bool {
        let wanted = wanted.to_lowercase();
        match BACKENDS.contains(&wanted.as_str()) {
            true => self.backend == wanted,
            false => self.to_string().to_lowercase().contains(&wanted),
        }
    }
}

impl std::fmt::Display for AdapterName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} [{}]", self.name, self.backend)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adapters_answer_to_parts_of_their_name_and_backend() {
        let lavapipe = AdapterName {
            name: "llvmpipe (LLVM 15), Mesa".into(),
            backend: "vulkan".into(),
            software: true,
        };
        for yes in ["LLVMpipe", "vulkan", "mesa"] {
            assert!(lavapipe.answers_to(yes), "{yes}");
        }
        assert!(!lavapipe.answers_to("metal"));
        let google = AdapterName {
            name: "SwiftShader Device (Subzero), Google".into(),
            ..lavapipe.clone()
        };
        assert!(google.answers_to("google") && google.answers_to("Vulkan"));
        assert!(!google.answers_to("gl"), "it is no OpenGL");
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
