//! The passes that find out which color keys show in which pixels, and with what weights.

use neurotess_picture::recolor::{Collected, Weighed};
use neurotess_refine::wgsl::{Shader, ShaderParts};

use crate::gpu::buffers::{group_layout, make, read_back, storage, texture_binding};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::shading::finish::BLUR;
use crate::shading::keyed::{KeyedShader, KeyedTargets};
use crate::shading::shade::PipelineKey;
use crate::sources::VertexSource;
use neurotess_picture::Frame;

/// Color keys of a pixel for which there is room at first, on average.
const EXPECTED: u64 = 3;

/// Pipelines and buffers for one kind of source.
pub(crate) struct Collector {
    key: PipelineKey,
    keyed: KeyedShader,
    targets: Option<KeyedTargets>,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    fixed: wgpu::Buffer,
    weighed: wgpu::Buffer,
    cursor: wgpu::Buffer,
}

/// The shader of the pass after the drawing.
pub(crate) fn collect_shader(samples: u32) -> Shader {
    let mut parts = ShaderParts::new(&[shader::file("collect.wgsl")]);
    if samples > 1 {
        parts.constants.flag("MULTISAMPLED");
    }
    parts.constants.i32("BLUR", BLUR as i32);
    parts.constants.u32("SAMPLES", samples);
    shader::shader("collect", &parts)
}

/// Group 1 of the pass; group 0 is that of the passes that finish a tile.
pub(crate) fn entries(multisampled: bool) -> Vec<wgpu::BindGroupLayoutEntry> {
    let compute = wgpu::ShaderStages::COMPUTE;
    let whole = wgpu::TextureSampleType::Uint;
    vec![
        texture_binding(0, compute, whole, multisampled),
        texture_binding(1, compute, whole, multisampled),
        texture_binding(2, compute, whole, multisampled),
        storage(3, compute, false),
        storage(4, compute, false),
        storage(5, compute, false),
    ]
}

/// What a [`Collector`] is made for.
pub(crate) struct Wanted<'a> {
    pub(crate) key: PipelineKey,
    /// Of the shading's group 1.
    pub(crate) shade_layout: &'a wgpu::BindGroupLayout,
    /// Of the group of the passes that finish a tile.
    pub(crate) finish_layout: &'a wgpu::BindGroupLayout,
}

/// What is drawn and collected at once.
pub(crate) struct Part<'a> {
    /// For which the source selects.
    pub(crate) frame: &'a Frame,
    /// Width and height (sub-pixels) of the targets.
    pub(crate) size: [u32; 2],
    /// Width and height (pixels) of what is collected.
    pub(crate) kept: [u32; 2],
}

impl Collector {
    /// None if the source has no color keys to look up.
    pub(crate) fn new(gpu: &Gpu, source: &dyn VertexSource, wanted: &Wanted<'_>) -> Option<Self> {
        let key = wanted.key.without_edges();
        let keyed = KeyedShader::new(gpu, source, key, wanted.shade_layout)?;
        let device = &gpu.device;
        let layout = group_layout(device, "collect", &entries(key.samples > 1));
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("collect"),
            bind_group_layouts: &[Some(wanted.finish_layout), Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("collect"),
            layout: Some(&pipeline_layout),
            module: &gpu.shader_module(&collect_shader(key.samples)),
            entry_point: Some("collect"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let written = |label, size| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            make(gpu, label, size, usage | wgpu::BufferUsages::COPY_DST)
        };
        Some(Self {
            key,
            keyed,
            targets: None,
            pipeline,
            layout,
            fixed: written("fixed", 16),
            weighed: written("weights", 16),
            cursor: written("cursor", 16),
        })
    }

    /// Whether its pipelines are those of this key.
    pub(crate) fn fits(&self, key: PipelineKey) -> bool {
        self.key == key.without_edges()
    }

    /// Draws a tile whose depths and occlusion are there, and collects `kept` pixels of it. `groups`:
    /// the shading's, and that of the passes that finish a tile.
    pub(crate) fn collect(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        frame: &Frame,
        groups: [&wgpu::BindGroup; 2],
        kept: [u32; 2],
    ) -> Result<Collected, DeviceError> {
        let size = [frame.tile.width, frame.tile.height];
        self.submit(gpu, source, &Part { frame, size, kept }, groups)?;
        self.read(gpu, groups[1], kept)
    }

    /// Draws and collects without waiting: [`Collector::read`] has the result.
    pub(crate) fn submit(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        part: &Part<'_>,
        groups: [&wgpu::BindGroup; 2],
    ) -> Result<(), DeviceError> {
        self.make_room(gpu, part.size, part.kept)?;
        let Some(targets) = &self.targets else {
            return Ok(());
        };
        let rounds = source.prepare_keyed(gpu, part.frame)?.max(1);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for round in 0..rounds {
            source.select(round, &mut encoder, None);
            self.keyed
                .draw(source, round, targets, groups[0], &mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
        self.dispatch(gpu, groups[1], part.kept);
        gpu.check()
    }

    /// What was collected last. Waits for the device. `finish_group`, `kept`: as submitted.
    pub(crate) fn read(
        &mut self,
        gpu: &Gpu,
        finish_group: &wgpu::BindGroup,
        kept: [u32; 2],
    ) -> Result<Collected, DeviceError> {
        let count = loop {
            let count: Vec<u32> = read_back(gpu, &self.cursor, 1)?;
            let needed = u64::from(count[0]) * size_of::<Weighed>() as u64;
            if needed <= self.weighed.size() {
                break count[0];
            }
            self.make_weighed(gpu, needed)?;
            self.dispatch(gpu, finish_group, kept);
        };
        let pixels = kept[0] as usize * kept[1] as usize;
        Ok(Collected {
            size: kept,
            fixed: read_back(gpu, &self.fixed, pixels)?,
            weighed: read_back(gpu, &self.weighed, count as usize)?,
        })
    }

    /// Gives its textures and buffers back, and keeps the pipelines.
    pub(crate) fn release(&mut self, gpu: &Gpu) {
        self.targets = None;
        for buffer in [&mut self.fixed, &mut self.weighed] {
            *buffer = make(gpu, "weights", 16, buffer.usage());
        }
    }

    /// Bytes of its textures and buffers.
    pub(crate) fn bytes(&self) -> u64 {
        let targets = self.targets.as_ref().map_or(0, |targets| targets.bytes);
        targets + self.fixed.size() + self.weighed.size()
    }

    fn dispatch(&self, gpu: &Gpu, finish_group: &wgpu::BindGroup, kept: [u32; 2]) {
        let Some(targets) = &self.targets else {
            return;
        };
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let view = wgpu::BindingResource::TextureView;
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("collect"),
            layout: &self.layout,
            entries: &[
                entry(0, view(&targets.weights)),
                entry(1, view(&targets.keys)),
                entry(2, view(&targets.owners)),
                entry(3, self.fixed.as_entire_binding()),
                entry(4, self.weighed.as_entire_binding()),
                entry(5, self.cursor.as_entire_binding()),
            ],
        });
        gpu.queue.write_buffer(&self.cursor, 0, &[0; 16]);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("collect"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, finish_group, &[]);
        pass.set_bind_group(1, &group, &[]);
        pass.dispatch_workgroups(kept[0].div_ceil(8), kept[1].div_ceil(8), 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }

    fn make_room(&mut self, gpu: &Gpu, size: [u32; 2], kept: [u32; 2]) -> Result<(), DeviceError> {
        let fits = |targets: &KeyedTargets| targets.size == size;
        if !self.targets.as_ref().is_some_and(fits) {
            self.targets = None;
            self.targets = Some(KeyedTargets::new(gpu, size, self.key.samples));
        }
        let pixels = u64::from(kept[0]) * u64::from(kept[1]);
        if self.fixed.size() < 8 * pixels {
            self.fixed = make(gpu, "fixed", 8 * pixels, self.fixed.usage());
        }
        let weighed = EXPECTED * pixels * size_of::<Weighed>() as u64;
        if self.weighed.size() < weighed {
            self.make_weighed(gpu, weighed)?;
        }
        gpu.check()
    }

    fn make_weighed(&mut self, gpu: &Gpu, bytes: u64) -> Result<(), DeviceError> {
        let most = gpu.largest_binding();
        if bytes > most {
            let what = "the color keys of a picture";
            return Err(DeviceError::TooLarge { what, bytes, most });
        }
        self.weighed = make(gpu, "weights", bytes, self.weighed.usage());
        gpu.check()
    }
}
