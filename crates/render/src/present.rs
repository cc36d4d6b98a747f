//! The pass that puts a picture into a texture, with outlines. Twin of the uniform in `present.wgsl`.

use bytemuck::{Pod, Zeroable};

use crate::colour::Rgb;
use crate::device::Gpu;
use crate::targets::Targets;

/// What windows show without converting: bytes of the screen.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Bit of a mask: selected.
pub const SELECTED: u8 = 1;
/// Bit of a mask: under the cursor.
pub const HOVERED: u8 = 2;

/// How outlines look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlines {
    /// Width (pixels); 0: none.
    pub width: u32,
    /// Colour of those round what is selected.
    pub selected: Rgb,
    /// Colour of those round what is under the cursor.
    pub hovered: Rgb,
}

impl Default for Outlines {
    fn default() -> Self {
        Self {
            width: 2,
            selected: [255, 140, 0],
            hovered: [0, 150, 255],
        }
    }
}

/// Twin of `Present` in `present.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Present {
    pub(crate) size: [u32; 2],
    pub(crate) width: u32,
    pub(crate) spare: u32,
    pub(crate) selected: [f32; 4],
    pub(crate) hovered: [f32; 4],
}

impl Present {
    pub(crate) fn new(size: [u32; 2], outlines: Option<&Outlines>) -> Self {
        let look = outlines.copied().unwrap_or_default();
        let colour = |[r, g, b]: Rgb| [r, g, b, 235].map(|c| f32::from(c) / 255.0);
        Self {
            size,
            width: outlines.map_or(0, |outlines| outlines.width),
            spare: 0,
            selected: colour(look.selected),
            hovered: colour(look.hovered),
        }
    }
}

/// What tells what has outlines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MaskKind {
    /// Bytes by pixel, from the host.
    Bytes,
    /// The normals that a draft of one sample has drawn: see `shade.wgsl`.
    Drawn,
}

/// The text for a kind of mask.
pub(crate) fn present_text(kind: MaskKind) -> String {
    let (texture, bits) = match kind {
        MaskKind::Bytes => ("texture_2d<u32>", "textureLoad(mask, p, 0).r"),
        MaskKind::Drawn => (
            "texture_2d<f32>",
            "u32(textureLoad(mask, p, 0).a * 255.0 + 0.5)",
        ),
    };
    let text = include_str!("present.wgsl");
    text.replace("MASK_TEXTURE", texture)
        .replace("MASK_BITS", bits)
}

/// The pass for a kind of mask.
struct Way {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

/// The pass, with the mask that it looks at.
pub(crate) struct Presenter {
    bytes: Way,
    drawn: Way,
    uniform: wgpu::Buffer,
    mask: wgpu::Texture,
    mask_size: Option<[u32; 2]>,
}

impl Presenter {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let uniform = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("present"),
            size: size_of::<Present>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            bytes: Way::new(gpu, MaskKind::Bytes),
            drawn: Way::new(gpu, MaskKind::Drawn),
            uniform,
            mask: mask_texture(gpu, [1, 1]),
            mask_size: None,
        }
    }

    /// A texture that the pass can write to.
    pub(crate) fn texture(gpu: &Gpu, size: [u32; 2]) -> wgpu::Texture {
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let shown = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        texture(gpu, size, FORMAT, drawn | shown)
    }

    /// Bytes of [`SELECTED`] and [`HOVERED`] by pixel, for pictures of this size; none: no outlines.
    pub(crate) fn set_mask(&mut self, gpu: &Gpu, mask: Option<([u32; 2], &[u8])>) {
        self.mask_size = mask.map(|(size, _)| size);
        let Some((size, bytes)) = mask else { return };
        if [self.mask.width(), self.mask.height()] != size {
            self.mask = mask_texture(gpu, size);
        }
        gpu.queue.write_texture(
            self.mask.as_image_copy(),
            bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(size[0]),
                rows_per_image: Some(size[1]),
            },
            self.mask.size(),
        );
    }

    /// Encodes the pass. `drawn`: the normals that were drawn are the mask.
    pub(crate) fn present(
        &self,
        gpu: &Gpu,
        targets: &Targets,
        to: &wgpu::Texture,
        (outlines, drawn): (&Outlines, bool),
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let size = [to.width(), to.height()];
        // Of another size, the mask belongs to another picture.
        let outlines = (drawn || self.mask_size == Some(size)).then_some(outlines);
        let words = Present::new(size, outlines);
        gpu.queue
            .write_buffer(&self.uniform, 0, bytemuck::bytes_of(&words));
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let bytes = self.mask.create_view(&Default::default());
        let (way, mask) = match drawn {
            true => (&self.drawn, &targets.normal),
            false => (&self.bytes, &bytes),
        };
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("present"),
            layout: &way.layout,
            entries: &[
                entry(0, self.uniform.as_entire_binding()),
                entry(1, targets.pixels.as_entire_binding()),
                entry(2, wgpu::BindingResource::TextureView(mask)),
            ],
        });
        let view = to.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("present"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(&way.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl Way {
    fn new(gpu: &Gpu, kind: MaskKind) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("present"),
            source: wgpu::ShaderSource::Wgsl(present_text(kind).into()),
        });
        let layout = layout(device, kind);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("present"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("present"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("show"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, layout }
    }
}

fn mask_texture(gpu: &Gpu, size: [u32; 2]) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    texture(gpu, size, wgpu::TextureFormat::R8Uint, usage)
}

/// A plain texture.
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

fn layout(device: &wgpu::Device, kind: MaskKind) -> wgpu::BindGroupLayout {
    let binding = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let buffer = |ty| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let mask = wgpu::BindingType::Texture {
        sample_type: match kind {
            MaskKind::Bytes => wgpu::TextureSampleType::Uint,
            MaskKind::Drawn => wgpu::TextureSampleType::Float { filterable: false },
        },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let pixels = wgpu::BufferBindingType::Storage { read_only: true };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("present"),
        entries: &[
            binding(0, buffer(wgpu::BufferBindingType::Uniform)),
            binding(1, buffer(pixels)),
            binding(2, mask),
        ],
    })
}
