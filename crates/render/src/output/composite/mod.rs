//! Cells in a render pass of another program, which share its depths with what the program draws itself.
//!
//! A frame is first drawn into targets of ours, as drafts for a window are: color, and the depth of each sample (µm).
//! Then a triangle over the viewport writes both into the program's pass, where the program's own depth test decides
//! what hides what.
//!
//! ```text
//! prepare: source ─▶ draw ─▶ colors, depths (µm)      draw: composite.wgsl ─▶ the program's color and depth
//! ```

mod view;

use bytemuck::{Pod, Zeroable};
use thiserror::Error;

use neurotess_picture::color::ColorTable;
use neurotess_picture::{Frame, Look};
use neurotess_refine::wgsl::{Shader, ShaderParts};

use crate::gpu::buffers::{UNFILTERED, group_layout, make, texture_binding, uniform};
use crate::gpu::device::{Gpu, samples_in_sub_pixel};
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::output::tiles::{TilePass, TileRenderer};
use crate::shading::shade::{PipelineKey, Shade};
use crate::shading::targets::Targets;
use crate::sources::VertexSource;

use view::Depths;

pub use view::{HostView, HostViewError};

/// What another program's pass draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostPass {
    /// Format of its one color attachment. Formats in sRGB and floating-point ones get linear light, all others the
    /// bytes that screens show.
    pub color: wgpu::TextureFormat,
    /// Format of its depth.
    pub depth: wgpu::TextureFormat,
    /// Its number of samples. With 4, edges are as smooth as in pictures of ours, and hide each other sample by sample.
    pub samples: u32,
}

/// Why cells cannot be drawn for another program's pass.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CompositeError {
    /// The view is none that we draw.
    #[error(transparent)]
    View(#[from] HostViewError),
    /// The device reports an error.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

/// Twin of `Composite` in `composite.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Uniform {
    pub(crate) z: [f32; 2],
    pub(crate) w: [f32; 2],
    pub(crate) origin: [u32; 2],
    pub(crate) encode: u32,
    pub(crate) pad: u32,
}

/// Draws cells into a pass of another program.
///
/// Each frame has two halves: [`Composite::prepare`], before the program submits its work, and [`Composite::draw`],
/// within its pass. Draw cells after what is opaque and before what is translucent: where they cover a pixel in part,
/// they blend with what is there.
pub struct Composite {
    pass: HostPass,
    samples: u32,
    /// Whether each sample of the program's pass gets one of ours.
    per_sample: bool,
    renderers: Vec<TileRenderer>,
    table: ColorTable,
    /// Number of the current table, so that each renderer gets each table once.
    tables: u64,
    states: Vec<u32>,
    layout: wgpu::BindGroupLayout,
    /// For depth forward, and for depth reversed.
    pipelines: [wgpu::RenderPipeline; 2],
    uniform: wgpu::Buffer,
    targets: Option<Targets>,
    /// What the pass binds, and whether depth is reversed; none before the first frame.
    ready: Option<(wgpu::BindGroup, bool)>,
}

impl Composite {
    /// What draws into passes of this kind. The shaders of cells are made for the first frame.
    ///
    /// # Errors
    /// The device cannot draw into such a pass, or reports another error.
    pub fn new(gpu: &Gpu, pass: HostPass) -> Result<Self, DeviceError> {
        gpu.scoped(|| {
            let samples = samples_in_sub_pixel(gpu, 4);
            let per_sample = samples > 1 && pass.samples == samples && gpu.shades_samples;
            let layout = group_layout(&gpu.device, "composite", &entries(samples, per_sample));
            let module = gpu.shader_module(&composite_shader(samples, per_sample));
            let pipelines = [false, true].map(|reversed| {
                let compare = match reversed {
                    true => wgpu::CompareFunction::Greater,
                    false => wgpu::CompareFunction::Less,
                };
                let blend = (!per_sample).then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
                pipeline(gpu, &layout, &module, pass, (compare, blend))
            });
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            Ok(Self {
                pass,
                samples,
                per_sample,
                renderers: Vec::new(),
                table: ColorTable::default(),
                tables: 1,
                states: Vec::new(),
                layout,
                pipelines,
                uniform: make(gpu, "composite", size_of::<Uniform>() as u64, usage),
                targets: None,
                ready: None,
            })
        })
    }

    /// Colors from the next frame on.
    pub fn set_colors(&mut self, table: ColorTable) {
        self.table = table;
        self.tables += 1;
    }

    /// States of instances from the next frame on, in the scene's order:
    /// [`HIGHLIGHTED`](crate::state::HIGHLIGHTED) and so on; 0 for instances beyond the end.
    pub fn set_states(&mut self, states: Vec<u32>) {
        self.states = states;
    }

    /// Draws a frame into targets of ours and submits that. The program's own work must be submitted after it. There is
    /// no ambient occlusion.
    ///
    /// # Errors
    /// The view is none that we draw, or the device reports an error. Then [`Composite::draw`] draws nothing.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        view: &HostView,
        look: &Look,
    ) -> Result<(), CompositeError> {
        self.ready = None;
        let (frame, depths) = view.frame()?;
        let drawn = gpu.scoped(|| {
            let renderer = self.renderer(gpu, source, look)?;
            let shade = Shade::new(&frame, look, 1, &self.renderers[renderer].sizes);
            let uniform = uniform_of(view, self.pass, &depths);
            gpu.queue
                .write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
            self.draw_frame(gpu, source, renderer, &frame, &shade)
        });
        if drawn.is_err() {
            // What was made meanwhile may be what the device refused, so it is made again.
            self.targets = None;
            self.renderers.clear();
        }
        self.ready = Some((drawn?, depths.reversed));
        Ok(())
    }

    /// Draws what was prepared into the program's pass, within the viewport that the pass has. It sets the pipeline and
    /// bind group 0.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some((group, reversed)) = &self.ready {
            pass.set_pipeline(&self.pipelines[usize::from(*reversed)]);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    /// The place of what draws this source with this look.
    fn renderer(
        &mut self,
        gpu: &Gpu,
        source: &dyn VertexSource,
        look: &Look,
    ) -> Result<usize, DeviceError> {
        let key = PipelineKey::new(source.key(), self.samples, &self.table, look);
        let key = key.with_all_depths();
        let place = match self.renderers.iter().position(|p| p.fits(key)) {
            Some(place) => place,
            None => {
                self.renderers.push(TileRenderer::new(gpu, source, key)?);
                self.renderers.len() - 1
            }
        };
        let renderer = &mut self.renderers[place];
        if renderer.holds != self.tables {
            renderer.set_table(gpu, &self.table);
            renderer.holds = self.tables;
        }
        renderer.set_states(gpu, &self.states);
        Ok(place)
    }

    /// Draws a frame into the targets. Returns what the program's pass binds.
    fn draw_frame(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        renderer: usize,
        frame: &Frame,
        shade: &Shade,
    ) -> Result<wgpu::BindGroup, DeviceError> {
        let targets = match self.targets.take() {
            Some(targets) if targets.size == frame.size => targets,
            _ => Targets::new(gpu, frame.size, self.samples),
        };
        gpu.check()?;
        let targets = self.targets.insert(targets);
        let renderer = &self.renderers[renderer];
        gpu.queue
            .write_buffer(&renderer.shade, 0, bytemuck::bytes_of(shade));
        let group = renderer.shade_group(gpu);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let rounds = source.prepare(gpu, frame)?.max(1);
        for round in 0..rounds {
            source.select(round, &mut encoder, None);
            let part = TilePass {
                // Where the program's pass reads each sample, none is given up for their mean.
                last: !self.per_sample && round + 1 == rounds,
                ..TilePass::round(round, rounds)
            };
            renderer.draw(source, &part, targets, &group, &mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(bound(
            gpu,
            &self.layout,
            &self.uniform,
            targets,
            self.per_sample,
        ))
    }
}

/// What the program's pass binds.
fn bound(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    uniform: &wgpu::Buffer,
    targets: &Targets,
    per_sample: bool,
) -> wgpu::BindGroup {
    let resolved = targets.resolved.as_ref().filter(|_| !per_sample);
    let colors = resolved.unwrap_or(&targets.color);
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("composite"),
        layout,
        entries: &[
            entry(0, uniform.as_entire_binding()),
            entry(1, wgpu::BindingResource::TextureView(colors)),
            entry(2, wgpu::BindingResource::TextureView(&targets.distance)),
        ],
    })
}

fn uniform_of(view: &HostView, pass: HostPass, depths: &Depths) -> Uniform {
    use wgpu::TextureFormat::{Rg11b10Ufloat, Rgba16Float, Rgba32Float};
    let floating = matches!(pass.color, Rg11b10Ufloat | Rgba16Float | Rgba32Float);
    let linear = floating || pass.color.is_srgb();
    Uniform {
        z: depths.z.map(|n| n as f32),
        w: depths.w.map(|n| n as f32),
        origin: view.origin,
        encode: u32::from(!linear),
        pad: 0,
    }
}

fn pipeline(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    pass: HostPass,
    (compare, blend): (wgpu::CompareFunction, Option<wgpu::BlendState>),
) -> wgpu::RenderPipeline {
    let device = &gpu.device;
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("composite"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("composite"),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: pass.depth,
            depth_write_enabled: Some(true),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: pass.samples,
            ..wgpu::MultisampleState::default()
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("compose"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: pass.color,
                blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The pass's shader, for this many samples of ours. `per_sample`: the program's pass has as many.
pub(crate) fn composite_shader(samples: u32, per_sample: bool) -> Shader {
    let mut parts = ShaderParts::new(&[shader::file("composite.wgsl")]);
    parts.constants.u32("SAMPLES", samples);
    if samples > 1 {
        parts.constants.flag("MULTISAMPLED");
    }
    if per_sample {
        parts.constants.flag("PER_SAMPLE");
    }
    shader::shader("composite", &parts)
}

/// Group 0 of the pass.
pub(crate) fn entries(samples: u32, per_sample: bool) -> Vec<wgpu::BindGroupLayoutEntry> {
    let fragment = wgpu::ShaderStages::FRAGMENT;
    vec![
        uniform(0, fragment, false),
        texture_binding(1, fragment, UNFILTERED, per_sample),
        texture_binding(2, fragment, UNFILTERED, samples > 1),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use neurotess_refine::{assert_layout, testing};

    #[test]
    fn shaders_are_valid_in_every_language_and_have_our_struct() {
        for (samples, per_sample) in [(1, false), (4, false), (4, true)] {
            let (module, _) = testing::check(&composite_shader(samples, per_sample));
            assert_layout!(&module, "Composite", Uniform, [z, w, origin, encode, pad]);
        }
    }
}
