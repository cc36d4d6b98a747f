//! Buffers and textures: making them, binding them, reading them back.

use bytemuck::Pod;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// A buffer of at least 16 bytes.
pub(crate) fn make(gpu: &Gpu, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size.max(16),
        usage,
        mapped_at_creation: false,
    })
}

/// Alignment of dynamic offsets into a uniform buffer that every device supports.
pub(crate) const UNIFORM_STRIDE: u64 = 256;

/// A binding of a storage buffer.
pub(crate) fn storage(
    binding: u32,
    visibility: wgpu::ShaderStages,
    read_only: bool,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

/// A buffer that holds these values.
pub(crate) fn upload<T: Pod>(
    gpu: &Gpu,
    label: &str,
    usage: wgpu::BufferUsages,
    data: &[T],
) -> wgpu::Buffer {
    use wgpu::util::DeviceExt;
    gpu.device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: bytemuck::cast_slice(data),
            usage,
        })
}

/// The first elements of a buffer. Waits for the device.
pub(crate) fn read_back<T: Pod>(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    count: usize,
) -> Result<Vec<T>, DeviceError> {
    let bytes = (count * size_of::<T>()) as u64;
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
    gpu.queue.submit([encoder.finish()]);
    let slice = copy.slice(..);
    slice.map_async(wgpu::MapMode::Read, |_| ());
    gpu.wait()?;
    let lost = |e: &dyn std::fmt::Display| DeviceError::Lost(e.to_string());
    let view = slice.get_mapped_range().map_err(|e| lost(&e))?;
    Ok(bytemuck::pod_collect_to_vec(&view))
}

/// A texture without mip levels or multisampling.
pub(crate) fn texture(
    gpu: &Gpu,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("viewport"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Waits for the device and copies the front of a buffer that can be mapped.
pub(crate) fn read_mapped(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    bytes: u64,
) -> Result<Vec<u8>, DeviceError> {
    let slice = buffer.slice(..bytes);
    slice.map_async(wgpu::MapMode::Read, |_| ());
    gpu.wait()?;
    let range = slice.get_mapped_range();
    let copied = range
        .map(|range| range.to_vec())
        .map_err(|e| DeviceError::Lost(e.to_string()))?;
    buffer.unmap();
    Ok(copied)
}

/// Bind group of two storage buffers and, at 2, a uniform of this size whose offset is set when it is bound; then `more`
/// storage buffers.
pub(crate) fn group_with_frame(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    [first, second]: [&wgpu::Buffer; 2],
    (frames, size): (&wgpu::Buffer, usize),
    more: &[&wgpu::Buffer],
) -> wgpu::BindGroup {
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let frame = wgpu::BufferBinding {
        buffer: frames,
        offset: 0,
        size: wgpu::BufferSize::new(size as u64),
    };
    let mut entries = vec![
        entry(0, first.as_entire_binding()),
        entry(1, second.as_entire_binding()),
        entry(2, wgpu::BindingResource::Buffer(frame)),
    ];
    let more = (3..).zip(more);
    entries.extend(more.map(|(binding, buffer)| entry(binding, buffer.as_entire_binding())));
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// A binding of a uniform buffer.
pub(crate) fn uniform(
    binding: u32,
    visibility: wgpu::ShaderStages,
    has_dynamic_offset: bool,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset,
            min_binding_size: None,
        },
        count: None,
    }
}

/// A layout of bindings.
pub(crate) fn group_layout(
    device: &wgpu::Device,
    label: &str,
    entries: &[wgpu::BindGroupLayoutEntry],
) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries,
    })
}

/// Type of textures that shaders load from without filtering.
pub(crate) const UNFILTERED: wgpu::TextureSampleType =
    wgpu::TextureSampleType::Float { filterable: false };

/// A binding of a texture.
pub(crate) fn texture_binding(
    binding: u32,
    visibility: wgpu::ShaderStages,
    sample_type: wgpu::TextureSampleType,
    multisampled: bool,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled,
        },
        count: None,
    }
}
