//! Another program: its device, its depths, and two walls that it draws.

use glam::{DMat4, DVec3, Mat4};
use neurotess_render::adapter::select_adapter;
use neurotess_render::{Gpu, HostPass};

/// Width and height (pixels) of its target.
pub(crate) const SIZE: [u32; 2] = [192, 128];

/// The walls: x from and to, z; then color. Both reach far up and down.
const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec4<f32>,
}

@vertex
fn corner(@builtin(vertex_index) index: u32, @builtin(instance_index) wall: u32) -> Corner {
    let across = array(vec3(-200.0, 200.0, -15.0), vec3(-200.0, 0.0, 15.0))[wall];
    let x = select(across.x, across.y, (index & 1u) != 0u);
    let y = select(-200.0, 200.0, (index & 2u) != 0u);
    let color = array(vec4(0.0, 0.0, 1.0, 1.0), vec4(1.0, 0.0, 0.0, 1.0))[wall];
    return Corner(clip_from_world * vec4(x, y, across.z, 1.0), color);
}

@fragment
fn paint(in: Corner) -> @location(0) vec4<f32> {
    return in.color;
}
";

/// The adapter that tests draw with.
pub(crate) fn adapter() -> wgpu::Adapter {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    select_adapter(&adapters, None).expect("an adapter")
}

/// A device as another program opens it: with what is required, and handlers of its own.
pub(crate) fn open() -> Gpu {
    let adapter = adapter();
    let required = Gpu::requirements();
    let descriptor = wgpu::DeviceDescriptor {
        required_features: required.features,
        required_limits: required.least.clone(),
        ..Default::default()
    };
    let opened = pollster::block_on(adapter.request_device(&descriptor));
    let (device, queue) = opened.expect("a device");
    Gpu::of_host(&adapter, device, queue).expect("it has what is required")
}

/// The walls, and what they are drawn into.
pub(crate) struct Host {
    walls: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    color: wgpu::Texture,
    drawn: wgpu::Texture,
    depth: wgpu::Texture,
    reversed: bool,
}

impl Host {
    pub(crate) fn new(gpu: &Gpu, pass: HostPass, clip_from_world: DMat4, reversed: bool) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let walls = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: pass.depth,
                depth_write_enabled: Some(true),
                depth_compare: Some(match reversed {
                    true => wgpu::CompareFunction::Greater,
                    false => wgpu::CompareFunction::Less,
                }),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: pass.samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(pass.color.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let matrix: Mat4 = clip_from_world.as_mat4();
        gpu.queue
            .write_buffer(&uniform, 0, bytemuck::cast_slice(&matrix.to_cols_array()));
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &walls.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: uniform.as_entire_binding(),
            }],
        });
        let texture = |format, sample_count| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: SIZE[0],
                    height: SIZE[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: match sample_count {
                    1 => wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                    _ => wgpu::TextureUsages::RENDER_ATTACHMENT,
                },
                view_formats: &[],
            })
        };
        Self {
            walls,
            group,
            color: texture(pass.color, 1),
            drawn: texture(pass.color, pass.samples),
            depth: texture(pass.depth, pass.samples),
            reversed,
        }
    }

    /// What there is after a pass that draws the walls of the first range, then by `draw`, then the walls of the last.
    pub(crate) fn pass(
        &self,
        gpu: &Gpu,
        [first, last]: [std::ops::Range<u32>; 2],
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) -> &wgpu::Texture {
        let [color, drawn, depth] =
            [&self.color, &self.drawn, &self.depth].map(|t| t.create_view(&Default::default()));
        let many = self.drawn.sample_count() > 1;
        let view = if many { &drawn } else { &color };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: many.then_some(&color),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(if self.reversed { 0.0 } else { 1.0 }),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        let walls = |pass: &mut wgpu::RenderPass<'_>, range| {
            pass.set_pipeline(&self.walls);
            pass.set_bind_group(0, &self.group, &[]);
            pass.draw(0..4, range);
        };
        walls(&mut pass, first);
        draw(&mut pass);
        walls(&mut pass, last);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        &self.color
    }
}

/// The pixel that shows a point.
pub(crate) fn pixel_of(clip_from_world: DMat4, point: DVec3) -> [u32; 2] {
    let ndc = clip_from_world.project_point3(point);
    let [width, height] = SIZE.map(f64::from);
    let at = [(ndc.x + 1.0) / 2.0 * width, (1.0 - ndc.y) / 2.0 * height];
    at.map(|n| n as u32)
}
