//! Textures and buffers that a tile is drawn into and finished in.

use crate::gpu::buffers::make;
use crate::gpu::device::Gpu;
use crate::shading::shade::{COLOR_FORMAT, DEPTH_FORMAT, DISTANCE_FORMAT, NORMAL_FORMAT};

/// Bytes of the dispatches: four numbers of 32 bits for each list of blocks.
const DISPATCH_BYTES: u64 = 3 * 16;

/// Textures and buffers for tiles of one size.
pub(crate) struct Targets {
    pub(crate) color: wgpu::TextureView,
    pub(crate) resolved: Option<wgpu::TextureView>,
    pub(crate) normal: wgpu::TextureView,
    pub(crate) distance: wgpu::TextureView,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) raw: wgpu::Buffer,
    pub(crate) blurred: wgpu::Buffer,
    pub(crate) pixels: wgpu::Buffer,
    /// Blocks in which anything shows, and dispatches for them.
    pub(crate) blocks: wgpu::Buffer,
    pub(crate) dispatches: wgpu::Buffer,
    pub(crate) read: wgpu::Buffer,
    pub(crate) size: [u32; 2],
    pub(crate) bytes: u64,
}

impl Targets {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], samples: u32) -> Self {
        let mut bytes = 0;
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let mut texture = |format: wgpu::TextureFormat, samples: u32| {
            let (view, more) = target(gpu, size, samples, format);
            bytes += more;
            view
        };
        let color = texture(COLOR_FORMAT, samples);
        let resolved = (samples > 1).then(|| texture(COLOR_FORMAT, 1));
        let normal = texture(NORMAL_FORMAT, samples);
        let distance = texture(DISTANCE_FORMAT, samples);
        let depth = texture(DEPTH_FORMAT, samples);
        let storage = wgpu::BufferUsages::STORAGE;
        let cleared = storage | wgpu::BufferUsages::COPY_DST;
        let blocks: u64 = size.map(|n| u64::from(n.div_ceil(8))).iter().product();
        let read = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        Self {
            color,
            resolved,
            normal,
            distance,
            depth,
            raw: make(gpu, "occlusion", 8 * pixels, cleared),
            blurred: make(gpu, "occlusion", 4 * pixels, storage),
            pixels: make(
                gpu,
                "pixels",
                4 * pixels,
                cleared | wgpu::BufferUsages::COPY_SRC,
            ),
            blocks: make(gpu, "blocks", 16 * blocks, cleared),
            dispatches: make(
                gpu,
                "dispatches",
                DISPATCH_BYTES,
                cleared | wgpu::BufferUsages::INDIRECT,
            ),
            read: make(gpu, "read back", 4 * pixels, read),
            size,
            bytes: bytes + 20 * pixels + 16 * blocks,
        }
    }
}

/// A texture that is drawn into and then read, and its bytes.
pub(crate) fn target(
    gpu: &Gpu,
    size: [u32; 2],
    samples: u32,
    format: wgpu::TextureFormat,
) -> (wgpu::TextureView, u64) {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let pixel = samples * format.block_copy_size(None).unwrap_or(4);
    let bytes = u64::from(size[0]) * u64::from(size[1]) * u64::from(pixel);
    (texture.create_view(&Default::default()), bytes)
}
