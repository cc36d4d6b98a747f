//! Draws a scene with the least shading there is: front faces in one color, back faces in another.

use neurotess_render::testing::Refiner;
use neurotess_render::{AdaptiveSettings, Camera, CullView, Gpu, Scene};

pub(crate) const FRONT: [u8; 4] = [0, 255, 0, 255];
pub(crate) const BACK: [u8; 4] = [255, 0, 0, 255];
pub(crate) const BACKGROUND: [u8; 4] = [255, 0, 255, 255];

const SHADE: &str = "
struct Varying {
    @builtin(position) @invariant position: vec4<f32>,
    @location(0) normal: vec3<f32>,
}
@group(1) @binding(0) var<uniform> clip_from_relative: mat4x4<f32>;
@vertex
fn vertex(
    @builtin(vertex_index) vertex_index: u32,
    @builtin(instance_index) instance_index: u32,
) -> Varying {
    let v = surface_vertex(vertex_index, instance_index);
    return Varying(snapped(clip_from_relative * vec4<f32>(v.position, 1.0)), v.normal);
}
// Off the samples' rows and columns: software rasterisers disagree with themselves about samples
// that lie on a vertex's row at a silhouette (lavapipe: 5 of 4,352,725 pixels, all there).
fn snapped(clip: vec4<f32>) -> vec4<f32> {
    let pixel = (clip.xy / clip.w * 0.5 + 0.5) * SIZE;
    let there = floor(pixel * 128.0) / 128.0 + 1.0 / 256.0;
    return vec4<f32>((there / SIZE * 2.0 - 1.0) * clip.w, clip.zw);
}
// A thousandth farther away: at a silhouette a front and a back face meet, and their depths may be
// equal up to rounding.
@vertex
fn vertex_back(
    @builtin(vertex_index) vertex_index: u32,
    @builtin(instance_index) instance_index: u32,
) -> Varying {
    let v = surface_vertex(vertex_index, instance_index);
    var out = Varying(snapped(clip_from_relative * vec4<f32>(v.position, 1.0)), v.normal);
    out.position.z *= 0.999;
    return out;
}
@fragment
fn sides(@builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return select(vec4<f32>(1.0, 0.0, 0.0, 1.0), vec4<f32>(0.0, 1.0, 0.0, 1.0), front);
}
@fragment
fn normals(in: Varying) -> @location(0) vec4<f32> {
    return vec4<f32>(normalize(in.normal) * 0.5 + 0.5, 1.0);
}
";

/// A pipeline with its target.
pub(crate) struct Drawer {
    /// By shader: of front faces and of back faces.
    pipelines: [[wgpu::RenderPipeline; 2]; Refiner::SHADERS],
    clip: wgpu::Buffer,
    group: wgpu::BindGroup,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    read: wgpu::Buffer,
    size: [u32; 2],
}

impl Drawer {
    /// `source`: what makes vertices, by shader; `entry`: `sides` or `normals`.
    pub(crate) fn new(
        gpu: &Gpu,
        refiner: &Refiner,
        source: &dyn Fn(usize) -> String,
        entry: &str,
        size: [u32; 2],
    ) -> Self {
        let device = &gpu.device;
        let [width, height] = size;
        let size_text = format!("const SIZE = vec2<f32>({width}.0, {height}.0);");
        let module = |shader| {
            let text = [&source(shader), &size_text, SHADE].concat();
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(text.into()),
            })
        };
        let modules = [0, 1, 2].map(module);
        let own = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(refiner.layout()), Some(&own)],
            immediate_size: 0,
        });
        let pipeline = |module, vertex, cull_mode| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some(vertex),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some(entry),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::TextureFormat::Rgba8Unorm.into())],
                }),
                primitive: wgpu::PrimitiveState {
                    cull_mode: Some(cull_mode),
                    ..Default::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: wgpu::TextureFormat::Depth32Float,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                multiview_mask: None,
                cache: None,
            })
        };
        let both = |module| {
            let front = pipeline(module, "vertex", wgpu::Face::Back);
            [front, pipeline(module, "vertex_back", wgpu::Face::Front)]
        };
        let pipelines = [both(&modules[0]), both(&modules[1]), both(&modules[2])];
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let copied = wgpu::TextureUsages::COPY_SRC;
        let color = texture(wgpu::TextureFormat::Rgba8Unorm, copied);
        let depth = texture(wgpu::TextureFormat::Depth32Float, copied);
        let buffer = |bytes: u64, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let clip = buffer(64, wgpu::BufferUsages::UNIFORM);
        let row = u64::from(size[0] * 4).next_multiple_of(256);
        let read = buffer(row * u64::from(size[1]), wgpu::BufferUsages::MAP_READ);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &own,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: clip.as_entire_binding(),
            }],
        });
        Self {
            pipelines,
            clip,
            group,
            color,
            depth,
            read,
            size,
        }
    }

    /// Pixels, row by row from the top.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        refiner: &mut Refiner,
        scene: &Scene,
        camera: &Camera,
        near: f64,
        settings: &AdaptiveSettings,
    ) -> Vec<[u8; 4]> {
        let [width, height] = self.size;
        let cull_view = CullView::new(camera, width, height, near);
        let clip = camera.clip_from_relative(f64::from(width) / f64::from(height), near);
        gpu.queue
            .write_buffer(&self.clip, 0, bytemuck::cast_slice(&clip.to_cols_array()));
        let plan = refiner
            .prepare(gpu, scene, &cull_view, settings)
            .expect("prepared");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let (color, depth) = (
            self.color.create_view(&Default::default()),
            self.depth.create_view(&Default::default()),
        );
        let clear = wgpu::Color {
            r: 1.0,
            g: 0.0,
            b: 1.0,
            a: 1.0,
        };
        for round in 0..plan.batches.len().max(1) {
            let batch = plan.batches.get(round);
            if let Some(batch) = batch {
                refiner.select(scene, &mut encoder, Some(batch), None);
            }
            let first = round == 0;
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: None,
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &color,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: if first {
                            wgpu::LoadOp::Clear(clear)
                        } else {
                            wgpu::LoadOp::Load
                        },
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &depth,
                    depth_ops: Some(wgpu::Operations {
                        load: if first {
                            wgpu::LoadOp::Clear(0.0)
                        } else {
                            wgpu::LoadOp::Load
                        },
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            // Front faces of all, then back faces.
            for face in 0..2 {
                for (shader, pipelines) in self.pipelines.iter().enumerate() {
                    pass.set_pipeline(&pipelines[face]);
                    pass.set_bind_group(1, &self.group, &[]);
                    if let Some(batch) = batch {
                        refiner.draw(&mut pass, batch, shader);
                    }
                }
            }
        }
        let row = (width * 4).next_multiple_of(256);
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.read,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
        );
        gpu.queue.submit([encoder.finish()]);
        let slice = self.read.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| ());
        gpu.wait().expect("drawn");
        let view = slice.get_mapped_range().expect("mapped");
        let mut pixels = Vec::new();
        for line in view.chunks(row as usize) {
            let line = line[..4 * width as usize].chunks_exact(4);
            pixels.extend(line.map(|p| [p[0], p[1], p[2], p[3]]));
        }
        drop(view);
        self.read.unmap();
        pixels
    }
}
