//! The pass that writes a picture into a texture, with outlines: present.wgsl.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::wgsl::{Shader, ShaderParts};

use crate::gpu::buffers::{UNFILTERED, group_layout, storage, texture, texture_binding, uniform};
use crate::gpu::device::Gpu;
use crate::gpu::shader;
use neurotess_picture::color::Rgb;

/// The format that windows show without conversion: the screen's bytes.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Bit of a mask: selected.
pub const SELECTED: u8 = 1;
/// Bit of a mask: under the cursor.
pub const HOVERED: u8 = 2;
/// Bit of a mask: the part that was clicked.
pub const PICKED: u8 = 4;

/// How outlines look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlines {
    /// Width (pixels); 0: none.
    pub width: u32,
    /// Color of outlines around what is selected.
    pub selected: Rgb,
    /// Opacity, 0 to 1, of outlines around whole instances that are selected, not around a part of one.
    pub opacity: f32,
    /// Color of outlines around what is under the cursor.
    pub hovered: Rgb,
}

impl Default for Outlines {
    fn default() -> Self {
        Self {
            width: 2,
            selected: [255, 140, 0],
            opacity: OPACITY,
            hovered: [0, 190, 170],
        }
    }
}

/// Opacity of outlines.
const OPACITY: f32 = 0.92;

/// Twin of `Present` in `present.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Present {
    pub(crate) size: [u32; 2],
    pub(crate) width: u32,
    pub(crate) opacity: f32,
    pub(crate) selected: [f32; 4],
    pub(crate) hovered: [f32; 4],
}

impl Present {
    pub(crate) fn new(size: [u32; 2], outlines: Option<&Outlines>) -> Self {
        let look = outlines.copied().unwrap_or_default();
        let color = |[r, g, b]: Rgb| {
            let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
            [r, g, b, OPACITY]
        };
        Self {
            size,
            width: outlines.map_or(0, |outlines| outlines.width),
            opacity: look.opacity.clamp(0.0, OPACITY),
            selected: color(look.selected),
            hovered: color(look.hovered),
        }
    }
}

/// The shader that computes the mask of a draft with this number of samples.
pub(crate) fn mask_shader(samples: u32) -> Shader {
    let mut parts = ShaderParts::new(&[shader::file("mask.wgsl")]);
    parts.constants.i32("SAMPLES", samples as i32);
    if samples > 1 {
        parts.constants.flag("MULTISAMPLED");
    }
    shader::shader("mask", &parts)
}

/// The shader that shows a picture.
pub(crate) fn present_shader() -> Shader {
    let parts = ShaderParts::new(&[shader::file("present.wgsl")]);
    shader::shader("present", &parts)
}

/// A pass over all pixels.
struct FullScreenPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

/// The texture that a picture is shown in.
pub(crate) struct Screen {
    pub(crate) texture: wgpu::Texture,
    /// A draft's own mask, computed on the device. Other pictures have the mask that the host
    /// uploads.
    drawn: Option<wgpu::Texture>,
}

impl Screen {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], draft: bool) -> Self {
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let shown = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        Self {
            texture: texture(gpu, size, FORMAT, drawn | shown),
            drawn: draft.then(|| mask_texture(gpu, size)),
        }
    }
}

/// The pass, and the mask that the host uploads.
pub(crate) struct Presenter {
    show: FullScreenPass,
    gather: FullScreenPass,
    uniform: wgpu::Buffer,
    mask: wgpu::Texture,
    mask_size: Option<[u32; 2]>,
}

impl Presenter {
    /// `samples`: number of samples of a draft's pixels.
    pub(crate) fn new(gpu: &Gpu, samples: u32) -> Self {
        let uniform = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("present"),
            size: size_of::<Present>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            show: FullScreenPass::new(gpu, &present_shader(), "show", FORMAT, &show_entries()),
            gather: FullScreenPass::new(
                gpu,
                &mask_shader(samples),
                "gather",
                MASK_FORMAT,
                &gather_entries(samples),
            ),
            uniform,
            mask: mask_texture(gpu, [1, 1]),
            mask_size: None,
        }
    }

    /// Bytes of [`SELECTED`] and [`HOVERED`] by pixel, for pictures of this size; none: no
    /// outlines.
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

    /// Encodes the pass. `pixels`: bytes of the picture; `normals`: the texture in which a draft has
    /// what is outlined.
    pub(crate) fn present(
        &self,
        gpu: &Gpu,
        (pixels, normals): (&wgpu::Buffer, &wgpu::TextureView),
        to: &Screen,
        outlines: &Outlines,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let size = [to.texture.width(), to.texture.height()];
        // A mask of another size belongs to another picture.
        let fits = to.drawn.is_some() || self.mask_size == Some(size);
        let outlines = Some(outlines).filter(|outlines| fits && outlines.width > 0);
        let uniform = Present::new(size, outlines);
        gpu.queue
            .write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        if let (Some(drawn), Some(_)) = (&to.drawn, outlines) {
            let normals = wgpu::BindingResource::TextureView(normals);
            self.gather.run(gpu, &[normals], drawn, encoder);
        }
        let mask = to.drawn.as_ref().unwrap_or(&self.mask);
        let mask = mask.create_view(&Default::default());
        let resources = [
            self.uniform.as_entire_binding(),
            pixels.as_entire_binding(),
            wgpu::BindingResource::TextureView(&mask),
        ];
        self.show.run(gpu, &resources, &to.texture, encoder);
    }
}

impl FullScreenPass {
    fn new(
        gpu: &Gpu,
        shader: &Shader,
        fragment: &str,
        format: wgpu::TextureFormat,
        entries: &[wgpu::BindGroupLayoutEntry],
    ) -> Self {
        let device = &gpu.device;
        let module = gpu.shader_module(shader);
        let layout = group_layout(device, fragment, entries);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(fragment),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
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
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, layout }
    }

    /// Encodes the pass.
    fn run(
        &self,
        gpu: &Gpu,
        resources: &[wgpu::BindingResource<'_>],
        to: &wgpu::Texture,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding,
                resource: resource.clone(),
            })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &entries,
        });
        let view = to.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Format of masks: bits of a pixel.
const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Uint;

fn mask_texture(gpu: &Gpu, size: [u32; 2]) -> wgpu::Texture {
    let written = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::RENDER_ATTACHMENT;
    texture(
        gpu,
        size,
        MASK_FORMAT,
        wgpu::TextureUsages::TEXTURE_BINDING | written,
    )
}

/// Bindings of the pass that shows a picture.
pub(crate) fn show_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let fragment = wgpu::ShaderStages::FRAGMENT;
    vec![
        uniform(0, fragment, false),
        storage(1, fragment, true),
        texture_binding(2, fragment, wgpu::TextureSampleType::Uint, false),
    ]
}

/// Bindings of the pass that computes the mask of a draft with this number of samples.
pub(crate) fn gather_entries(samples: u32) -> Vec<wgpu::BindGroupLayoutEntry> {
    let fragment = wgpu::ShaderStages::FRAGMENT;
    vec![texture_binding(0, fragment, UNFILTERED, samples > 1)]
}
