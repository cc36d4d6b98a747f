//! The program: its device, its depth buffer, its boxes and its pass. It knows of the cells only what they draw.

use std::error::Error;

use neurotess::render::adapter::select_adapter;
use neurotess::render::glam::dcamera::rh::proj::directx::perspective;
use neurotess::render::glam::dcamera::rh::view::look_at_mat4;
use neurotess::render::glam::{DMat4, DVec3};
use neurotess::render::{Gpu, HostPass, HostView, wgpu};

use crate::cells::Cells;

/// Number of boxes.
const BOXES: u32 = 4;

/// A device that the program opens as it likes, with what neurotess needs besides.
pub(crate) fn open(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<(wgpu::Adapter, Gpu), Box<dyn Error>> {
    let backends = wgpu::Backends::all();
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.retain(|adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface)));
    let adapter = select_adapter(&adapters, None)?;
    let needed = Gpu::requirements();
    let descriptor = wgpu::DeviceDescriptor {
        required_features: needed.features,
        required_limits: needed.limits(&adapter),
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
    let gpu = Gpu::of_host(&adapter, device, queue)?;
    Ok((adapter, gpu))
}

/// What the program draws, and with what.
pub(crate) struct Host {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pass: HostPass,
    boxes: wgpu::RenderPipeline,
    scene: wgpu::Buffer,
    group: wgpu::BindGroup,
    /// Samples and depths, for targets of one size.
    targets: Option<[wgpu::Texture; 2]>,
}

impl Host {
    /// For targets of this format.
    pub(crate) fn new(gpu: &Gpu, color: wgpu::TextureFormat) -> Self {
        let (device, queue) = (gpu.device.clone(), gpu.queue.clone());
        let pass = HostPass {
            color,
            depth: wgpu::TextureFormat::Depth32Float,
            samples: 4,
        };
        let module = device.create_shader_module(wgpu::include_wgsl!("host.wgsl"));
        let boxes = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("boxes"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: pass.depth,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
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
                targets: &[Some(color.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let scene = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("scene"),
            size: 80,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene"),
            layout: &boxes.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: scene.as_entire_binding(),
            }],
        });
        Self {
            device,
            queue,
            pass,
            boxes,
            scene,
            group,
            targets: None,
        }
    }

    /// What its pass draws into.
    pub(crate) fn pass(&self) -> HostPass {
        self.pass
    }

    /// Draws a frame, seen from an angle (radians) around the cells.
    pub(crate) fn draw(
        &mut self,
        target: &wgpu::Texture,
        cells: &mut Cells,
        angle: f64,
    ) -> Result<(), Box<dyn Error>> {
        let size = [target.width(), target.height()];
        let (center, reach) = (cells.center, cells.reach);
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let away = DVec3::new(angle.sin(), 0.35, angle.cos()) * 2.9 * reach;
        let view = HostView {
            view: look_at_mat4(center + away, center, DVec3::Y),
            projection: perspective(0.7, aspect, 0.1 * reach, 20.0 * reach),
            origin: [0, 0],
            size,
        };
        self.write_scene(view.projection * view.view, center, reach);
        // The cells' own work is submitted before that of the program.
        cells.prepare(&view)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.encode(target, cells, &mut encoder);
        self.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// The program's one pass: its boxes, then the cells, with the same depths.
    fn encode(
        &mut self,
        target: &wgpu::Texture,
        cells: &Cells,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let [samples, depth] = self.targets_like(target);
        let resolved = target.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("the program's"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &samples,
                depth_slice: None,
                resolve_target: Some(&resolved),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color {
                        r: 0.9,
                        g: 0.92,
                        b: 0.95,
                        a: 1.0,
                    }),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.boxes);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..36, 0..BOXES);
        cells.draw(&mut pass);
    }

    fn write_scene(&self, clip_from_world: DMat4, center: DVec3, reach: f64) {
        let matrix = clip_from_world.as_mat4().to_cols_array();
        let place = center.extend(reach).as_vec4().to_array();
        let numbers = matrix.iter().chain(&place);
        let bytes: Vec<u8> = numbers.flat_map(|number| number.to_ne_bytes()).collect();
        self.queue.write_buffer(&self.scene, 0, &bytes);
    }

    /// Samples and depths of the size of a target.
    fn targets_like(&mut self, target: &wgpu::Texture) -> [wgpu::TextureView; 2] {
        let size = target.size();
        let texture = |format| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("target"),
                size,
                mip_level_count: 1,
                sample_count: self.pass.samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let targets = match self.targets.take() {
            Some(targets) if targets[0].size() == size => targets,
            _ => [self.pass.color, self.pass.depth].map(texture),
        };
        let views = [&targets[0], &targets[1]].map(|t| t.create_view(&Default::default()));
        self.targets = Some(targets);
        views
    }
}
