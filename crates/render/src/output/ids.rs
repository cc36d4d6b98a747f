//! The pass that draws picking ids instead of colors, with ids.wgsl; and their way back to the
//! host.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use crate::gpu::buffers::texture;
use neurotess_refine::wgsl::{Shader, ShaderParts, WgslFile};

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::parallel::side_by_side;
use crate::gpu::shader;
use crate::output::tiles::TileRenderer;
use crate::shading::shade::{self, DEPTH_FORMAT, GUARD, PipelineKey, Shade};
use crate::sources::VertexSource;
use crate::sources::pick::{BATCH_SHIFT, FINE, POINT_BITS, PickId, PickIds};
use neurotess_picture::Frame;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;
/// Bytes of an id.
const BYTES: usize = size_of::<PickId>();

/// Pipelines and targets of the pass.
pub(crate) struct Identifier {
    key: PipelineKey,
    pipelines: Vec<wgpu::RenderPipeline>,
    canvas: Option<Canvas>,
}

struct Canvas {
    size: [u32; 2],
    ids: wgpu::Texture,
    depth: wgpu::Texture,
    read: wgpu::Buffer,
    /// Bytes of a row in the buffer.
    row: u32,
    state: Arc<AtomicU8>,
}

const NOTHING: u8 = 0;
const UNDER_WAY: u8 = 1;
const THERE: u8 = 2;
const FAILED: u8 = 3;

/// The shader for a source's vertices and its `surface_id`.
pub(crate) fn ids_shader(source: &ShaderParts, id: WgslFile) -> Shader {
    let mut parts = source.clone();
    parts.files.extend([id, shader::file("ids.wgsl")]);
    parts.constants.extend(&shade::constants(PipelineKey {
        samples: 1,
        ..PipelineKey::default()
    }));
    parts.constants.u32("BATCH_SHIFT", BATCH_SHIFT);
    parts.constants.u32("FINE", FINE);
    parts.constants.u32("POINT_BITS", POINT_BITS);
    shader::shader("ids", &parts)
}

impl Identifier {
    /// None if the source does not support picking.
    pub(crate) fn new(
        gpu: &Gpu,
        renderer: &TileRenderer,
        source: &dyn VertexSource,
    ) -> Option<Self> {
        let ids = (0..source.shaders()).map(|shader| source.id_shader(shader));
        let ids: Vec<WgslFile> = ids.collect::<Option<_>>()?;
        let device = &gpu.device;
        let layouts: Vec<_> = (0..ids.len()).map(|shader| source.layout(shader)).collect();
        let shaders = ids.iter().enumerate();
        let shaders: Vec<Shader> = shaders
            .map(|(shader, &id)| ids_shader(&source.shader(shader), id))
            .collect();
        let pipelines = side_by_side(gpu, shaders.len(), |shader| {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("ids"),
                bind_group_layouts: &[Some(layouts[shader]), Some(&renderer.shader.layout)],
                immediate_size: 0,
            });
            let module = gpu.shader_module(&shaders[shader]);
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("ids"),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vertex_id"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("fragment_id"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(FORMAT.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        });
        Some(Self {
            key: renderer.key().without_edges(),
            pipelines,
            canvas: None,
        })
    }

    pub(crate) fn fits(&self, renderer: &TileRenderer) -> bool {
        self.key == renderer.key().without_edges()
    }

    /// Draws the ids of a frame and starts to copy them to the host.
    pub(crate) fn draw(
        &mut self,
        gpu: &Gpu,
        renderer: &TileRenderer,
        source: &mut dyn VertexSource,
        frame: &Frame,
        mut shade: Shade,
        size: [u32; 2],
    ) -> Result<(), DeviceError> {
        let busy = |c: &Canvas| c.size != size || c.state.load(Ordering::Acquire) == UNDER_WAY;
        if self.canvas.as_ref().is_none_or(busy) {
            self.canvas = Some(Canvas::new(gpu, size));
            gpu.check()?;
        }
        let Some(canvas) = &self.canvas else {
            return Ok(());
        };
        canvas.unmap();
        let group = renderer.shade_group(gpu);
        let rounds = source.prepare(gpu, frame)?.max(1);
        for round in 0..rounds {
            shade.batch = round as u32;
            gpu.queue
                .write_buffer(&renderer.shade, 0, bytemuck::bytes_of(&shade));
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            source.select(round, &mut encoder, None);
            self.round(source, round, canvas, &group, &mut encoder);
            if round + 1 == rounds {
                canvas.copy(&mut encoder);
            }
            gpu.queue.submit([encoder.finish()]);
        }
        canvas.send();
        gpu.check()
    }

    fn round(
        &self,
        source: &dyn VertexSource,
        round: usize,
        canvas: &Canvas,
        group: &wgpu::BindGroup,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let (empty, far) = match round {
            0 => (
                wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                wgpu::LoadOp::Clear(0.0),
            ),
            _ => (wgpu::LoadOp::Load, wgpu::LoadOp::Load),
        };
        let [ids, depth] = [&canvas.ids, &canvas.depth].map(|t| t.create_view(&Default::default()));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ids"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &ids,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: empty,
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: far,
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(1, group, &[]);
        let [width, height] = canvas.size.map(|n| n as f32 + 2.0 * GUARD);
        pass.set_viewport(-GUARD, -GUARD, width, height, 0.0, 1.0);
        for (shader, pipeline) in self.pipelines.iter().enumerate() {
            pass.set_pipeline(pipeline);
            source.draw(round, shader, &mut pass);
        }
    }

    /// The ids of all pixels, by row, once they have arrived. The device must be polled.
    ///
    /// # Errors
    /// The device is lost.
    pub(crate) fn take(&mut self) -> Result<Option<PickIds>, DeviceError> {
        let Some(canvas) = &self.canvas else {
            return Ok(None);
        };
        match canvas.state.load(Ordering::Acquire) {
            THERE => {}
            FAILED => return Err(DeviceError::Lost("ids did not arrive".into())),
            _ => return Ok(None),
        }
        let range = canvas.read.slice(..).get_mapped_range();
        let range = range.map_err(|e| DeviceError::Lost(e.to_string()))?;
        let row_bytes = BYTES * canvas.size[0] as usize;
        let mut ids = Vec::with_capacity(canvas.size[0] as usize * canvas.size[1] as usize);
        for row in range.chunks(canvas.row as usize) {
            ids.extend(
                row[..row_bytes]
                    .chunks_exact(BYTES)
                    .map(bytemuck::pod_read_unaligned::<PickId>),
            );
        }
        drop(range);
        canvas.unmap();
        Ok(Some((canvas.size, ids)))
    }
}

impl Canvas {
    fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let row = (BYTES as u32 * size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        Self {
            size,
            ids: texture(gpu, size, FORMAT, drawn | wgpu::TextureUsages::COPY_SRC),
            depth: texture(gpu, size, DEPTH_FORMAT, drawn),
            read: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("ids"),
                size: u64::from(row) * u64::from(size[1]),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
            row,
            state: Arc::new(AtomicU8::new(NOTHING)),
        }
    }

    fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        let to = wgpu::TexelCopyBufferInfo {
            buffer: &self.read,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(self.row),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(self.ids.as_image_copy(), to, self.ids.size());
    }

    fn send(&self) {
        self.state.store(UNDER_WAY, Ordering::Release);
        let state = Arc::clone(&self.state);
        self.read
            .slice(..)
            .map_async(wgpu::MapMode::Read, move |mapped| {
                let now = if mapped.is_ok() { THERE } else { FAILED };
                state.store(now, Ordering::Release);
            });
    }

    fn unmap(&self) {
        if self.state.swap(NOTHING, Ordering::AcqRel) == THERE {
            self.read.unmap();
        }
    }
}
