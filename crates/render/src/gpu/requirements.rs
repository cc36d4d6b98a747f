//! What a device must have for this crate to draw with it: for programs that open their own.

use wgpu::{Adapter, Device, Features, Limits};

use crate::gpu::adapter::{lacks, name};
use crate::gpu::error::DeviceError;

/// What a device must have for this crate to draw with it, so that a program can ask for it when it opens one.
///
/// ```no_run
/// # fn open(adapter: &wgpu::Adapter, own: &wgpu::Limits) {
/// let ours = neurotess_render::Gpu::requirements();
/// let descriptor = wgpu::DeviceDescriptor {
///     required_features: adapter.features() & ours.optional_features,
///     required_limits: ours.limits(adapter).or_better_values_from(own),
///     ..Default::default()
/// };
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Requirements {
    /// Features that the device must have: none.
    pub features: Features,
    /// Features that are used where the device has them: it then tells what its passes take.
    pub optional_features: Features,
    /// The least limits, those of WebGPU: they do for a few cells.
    pub least: Limits,
}

impl Requirements {
    pub(crate) fn new() -> Self {
        Self {
            features: Features::empty(),
            optional_features: optional_features(),
            least: Limits::defaults(),
        }
    }

    /// The limits to ask an adapter for: the least ones, with buffers as large as it allows, since scenes are as large
    /// as these.
    pub fn limits(&self, adapter: &Adapter) -> Limits {
        let able = adapter.limits();
        let least = &self.least;
        Limits {
            max_buffer_size: able.max_buffer_size.max(least.max_buffer_size),
            max_storage_buffer_binding_size: able
                .max_storage_buffer_binding_size
                .max(least.max_storage_buffer_binding_size),
            ..least.clone()
        }
    }

    /// Whether an adapter can draw, and a device of it has what is needed.
    pub(crate) fn check(&self, adapter: &Adapter, device: &Device) -> Result<(), DeviceError> {
        let lacks = lacks(adapter);
        let adapter = name(adapter).name;
        if !lacks.is_empty() {
            return Err(DeviceError::Unable { adapter, lacks });
        }
        let mut short = Vec::new();
        self.least
            .check_limits_with_fail_fn(&device.limits(), false, |limit, needed, there| {
                short.push(format!("{limit} is {there} instead of {needed}"));
            });
        match short.is_empty() {
            true => Ok(()),
            false => Err(DeviceError::Limited { adapter, short }),
        }
    }
}

/// Features that are used where an adapter supports them.
pub fn optional_features() -> Features {
    Features::TIMESTAMP_QUERY
}
