//! What an adapter is able to do, for reports of figures that were measured with it.

use wgpu::{DeviceType, Features};

use crate::gpu::adapter::{find_adapter, name};
use crate::gpu::error::DeviceError;
use crate::gpu::requirements::optional_features;

/// What an adapter is able to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Name and driver, as in `llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 22.3.6`.
    pub name: String,
    /// `vulkan`, `metal`, `dx12` or `gl`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// Most bytes of a buffer.
    pub largest_buffer: u64,
    /// Most bytes of a buffer that a shader reads as a whole.
    pub largest_binding: u64,
    /// Greatest width and height (pixels) of a texture.
    pub largest_texture: u32,
    /// Most threads of a workgroup.
    pub workgroup_threads: u32,
    /// Most bytes that a workgroup shares.
    pub workgroup_bytes: u32,
    /// Most workgroups in one dimension of a dispatch.
    pub dispatched_workgroups: u32,
    /// Whether the device tells what its passes take.
    pub has_timestamps: bool,
    /// Whether the driver has mesh shaders.
    pub has_mesh_shaders: bool,
}

impl Capabilities {
    /// Those of the adapter that [`Gpu::open`](crate::Gpu::open) opens for `wanted`.
    ///
    /// # Errors
    /// There is no such adapter.
    pub fn of(wanted: Option<&str>) -> Result<Self, DeviceError> {
        let adapter = find_adapter(wanted)?;
        let (named, limits, features) = (name(&adapter), adapter.limits(), adapter.features());
        let kind = match adapter.get_info().device_type {
            DeviceType::DiscreteGpu => "discrete",
            DeviceType::IntegratedGpu => "integrated",
            DeviceType::VirtualGpu => "virtual",
            DeviceType::Cpu => "software",
            DeviceType::Other => "other",
        };
        Ok(Self {
            name: named.name,
            backend: named.backend,
            kind,
            largest_buffer: limits.max_buffer_size,
            largest_binding: limits.max_storage_buffer_binding_size,
            largest_texture: limits.max_texture_dimension_2d,
            workgroup_threads: limits.max_compute_invocations_per_workgroup,
            workgroup_bytes: limits.max_compute_workgroup_storage_size,
            dispatched_workgroups: limits.max_compute_workgroups_per_dimension,
            has_timestamps: features.contains(optional_features()),
            has_mesh_shaders: features.contains(Features::EXPERIMENTAL_MESH_SHADER),
        })
    }
}
