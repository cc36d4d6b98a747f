//! The pipeline that shades a source's vertices, with shade.wgsl.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::wgsl::{Constants, Shader as Composed, ShaderParts};

use crate::gpu::buffers::{group_layout, storage, uniform};
use crate::gpu::device::Gpu;
use crate::gpu::parallel::side_by_side;
use crate::gpu::shader;
use crate::sources::{SourceKey, VertexSource};
use neurotess_picture::color::{CATEGORY_BIT, ColorTable, linear};
use neurotess_picture::state::{GHOSTED, HIGHLIGHTED, OUTLINED, WITHOUT_NEURITES, WITHOUT_SOMA};
use neurotess_picture::{Frame, Tile};
use neurotess_picture::{HALF_WIDTH, KEY, Light, Look, edge_color};

/// Linear color, premultiplied.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Normals in the view.
pub(crate) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Depths (µm), as the bytes of an f32.
pub(crate) const DISTANCE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Depth buffer: floating point, which reversed depth needs to be precise.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Twin of `Shade` in `shade.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Shade {
    pub(crate) clip_from_relative: [f32; 16],
    pub(crate) right: [f32; 3],
    pub(crate) near: f32,
    pub(crate) up: [f32; 3],
    pub(crate) slope: f32,
    pub(crate) backward: [f32; 3],
    pub(crate) half_width: f32,
    pub(crate) key: [f32; 3],
    pub(crate) wire: f32,
    pub(crate) size: [f32; 2],
    pub(crate) tile_origin: [f32; 2],
    pub(crate) viewport_origin: [f32; 2],
    pub(crate) viewport_size: [f32; 2],
    pub(crate) lit: f32,
    pub(crate) scale_entries: u32,
    pub(crate) colors: u32,
    pub(crate) valued: u32,
    pub(crate) shift: [f32; 3],
    pub(crate) ghosted: f32,
    pub(crate) clip: [f32; 4],
    pub(crate) highlighted: [f32; 4],
    pub(crate) jitter: [f32; 2],
    pub(crate) batch: u32,
    pub(crate) least_half_width: f32,
    pub(crate) edge: [f32; 4],
    pub(crate) flat: f32,
    pub(crate) steps: f32,
    pub(crate) turn: [f32; 2],
}

/// Sizes of a color table, for shaders.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TableSizes {
    /// Colors of the scale.
    pub(crate) scale: u32,
    /// All colors.
    pub(crate) colors: u32,
    /// Instances with values.
    pub(crate) valued: u32,
}

impl Shade {
    /// `scale`: sub-pixels per pixel along a side.
    pub(crate) fn new(frame: &Frame, look: &Look, scale: u32, table: &TableSizes) -> Self {
        let [right, up, backward] = frame.camera.view_rotation().map(|axis| axis.to_array());
        let (key, lit) = match look.light {
            Light::Soft => (KEY, 1.0),
            Light::From(direction) => (direction, 1.0),
            Light::Flat => (KEY, 0.0),
        };
        let clip = look.clip.map_or([0.0; 4], |clip| {
            let away = clip.normal.dot(frame.camera.eye() - clip.point);
            clip.normal.as_vec3().extend(away as f32).to_array()
        });
        let [r, g, b] = linear(look.highlighted.0);
        Self {
            clip_from_relative: frame.clip_from_relative().to_cols_array(),
            right,
            near: frame.near as f32,
            up,
            slope: frame.pixel().slope as f32,
            backward,
            half_width: HALF_WIDTH * scale as f32,
            key: key.normalize_or(KEY).to_array(),
            wire: 0.5 * look.wire * scale as f32,
            size: frame.size.map(|n| n as f32),
            tile_origin: [0.0; 2],
            viewport_origin: [0.0; 2],
            viewport_size: [0.0; 2],
            lit,
            scale_entries: table.scale,
            colors: table.colors,
            valued: table.valued,
            shift: [0.0; 3],
            ghosted: look.ghosted,
            clip,
            highlighted: [r, g, b, look.highlighted.1],
            jitter: [0.0; 2],
            batch: 0,
            least_half_width: 0.5 * look.least_width.max(0.0) * scale as f32,
            edge: edge_color(look),
            flat: frame.pixel().flat as f32,
            steps: 1.0,
            turn: [0.0; 2],
        }
        .within(&frame.tile)
    }

    /// For targets that hold a tile of the picture.
    pub(crate) fn within(mut self, tile: &Tile) -> Self {
        self.tile_origin = [tile.x as f32, tile.y as f32];
        self.viewport_origin = [tile.x, tile.y].map(|n| n as f32 - GUARD);
        self.viewport_size = [tile.width, tile.height].map(|n| n as f32 + 2.0 * GUARD);
        self
    }

    /// For a step of a progressive picture of so many: offset by `jitter` (sub-pixels), its dither pattern
    /// by `turn`.
    pub(crate) fn moved(mut self, steps: u32, (jitter, turn): ([f32; 2], [f32; 2])) -> Self {
        self.jitter = jitter;
        self.steps = steps as f32;
        self.tile_origin = [0, 1].map(|k| self.tile_origin[k] + turn[k]);
        self.turn = turn;
        self
    }
}

/// Sub-pixels by which the viewport is larger than the tile on each side. Software rasterizers clip
/// at the viewport, and a clipped edge may cover other samples: one in 600,000 differed at the
/// borders of tiles.
pub(crate) const GUARD: f32 = 512.0;

/// Draws samples from a source's vertices.
pub(crate) struct Shader {
    /// A pipeline for each of the source's shaders.
    pub(crate) pipelines: Vec<wgpu::RenderPipeline>,
    pub(crate) layout: wgpu::BindGroupLayout,
}

impl Shader {
    pub(crate) fn new(gpu: &Gpu, source: &dyn VertexSource, key: PipelineKey) -> Self {
        let layout = group_layout(&gpu.device, "shade", &entries());
        let pass = DrawPass {
            label: "shade",
            shader: &|shader| shade_shader(&source.shader(shader), key),
            entry_points: ["vertex", "fragment"],
            formats: [COLOR_FORMAT, NORMAL_FORMAT, DISTANCE_FORMAT],
        };
        let pipelines = pass.pipelines(gpu, source, key, &layout);
        Self { pipelines, layout }
    }
}

/// A pass that draws a source's vertices.
pub(crate) struct DrawPass<'a> {
    pub(crate) label: &'static str,
    /// The composed shader for each of the source's.
    pub(crate) shader: &'a dyn Fn(usize) -> Composed,
    /// Of the vertex and the fragment stage.
    pub(crate) entry_points: [&'static str; 2],
    pub(crate) formats: [wgpu::TextureFormat; 3],
}

impl DrawPass<'_> {
    /// A pipeline for each of the source's shaders. `layout`: that of group 1.
    pub(crate) fn pipelines(
        &self,
        gpu: &Gpu,
        source: &dyn VertexSource,
        key: PipelineKey,
        layout: &wgpu::BindGroupLayout,
    ) -> Vec<wgpu::RenderPipeline> {
        let PipelineKey { samples, cut, .. } = key;
        let Self {
            label,
            shader,
            entry_points,
            formats,
        } = *self;
        let both_sides = |shader: usize| cut || source.is_two_sided(shader);
        let device = &gpu.device;
        let target = |format: wgpu::TextureFormat| {
            Some(wgpu::ColorTargetState {
                format,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            })
        };
        let shaders: Vec<Composed> = (0..source.shaders()).map(shader).collect();
        let layouts: Vec<_> = (0..shaders.len())
            .map(|shader| source.layout(shader))
            .collect();
        let both_sides: Vec<bool> = (0..shaders.len()).map(both_sides).collect();
        side_by_side(gpu, shaders.len(), |shader| {
            let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(layouts[shader]), Some(layout)],
                immediate_size: 0,
            });
            let module = gpu.shader_module(&shaders[shader]);
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(label),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(entry_points[0]),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    cull_mode: (!both_sides[shader]).then_some(wgpu::Face::Back),
                    ..wgpu::PrimitiveState::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState {
                    count: samples,
                    ..wgpu::MultisampleState::default()
                },
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry_points[1]),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &formats.map(target),
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}

/// All that pipelines depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct PipelineKey {
    /// The source's shaders.
    pub(crate) source: SourceKey,
    /// Samples of a sub-pixel: 1 or 4.
    pub(crate) samples: u32,
    /// Whether back faces are drawn, since a plane cuts the surface.
    pub(crate) cut: bool,
    /// Whether instances have values. Shaders for scenes without values do not look for them: that
    /// took software Vulkan 10 ms a frame.
    pub(crate) valued: bool,
    /// Whether colors of a scale have edges, see [`Look::contrast`]. Elsewhere they are not
    /// interpolated: where triangles are small, setting up one more color for each took software
    /// Vulkan as long as all the rest of drawing them.
    pub(crate) edged: bool,
    /// Whether what is translucent has depths, too. In pictures it has none, since it darkens no corners.
    pub(crate) all_depths: bool,
}

impl PipelineKey {
    /// For a source's shaders, colors and looks.
    pub(crate) fn new(source: SourceKey, samples: u32, table: &ColorTable, look: &Look) -> Self {
        Self {
            source,
            samples,
            cut: look.clip.is_some(),
            valued: table.values.instances() > 0,
            edged: !table.scale.is_empty() && look.edges_against().is_some(),
            all_depths: false,
        }
    }

    /// For passes of other programs, where all that shows needs a depth.
    pub(crate) fn with_all_depths(self) -> Self {
        Self {
            all_depths: true,
            ..self
        }
    }

    /// For passes that draw no colors.
    pub(crate) fn without_edges(self) -> Self {
        Self {
            edged: false,
            ..self
        }
    }
}

/// The shader for a source's vertices.
pub(crate) fn shade_shader(source: &ShaderParts, key: PipelineKey) -> Composed {
    let mut parts = source.clone();
    parts.files.push(shader::file("shade.wgsl"));
    parts.constants.extend(&constants(key));
    shader::shader("shade", &parts)
}

/// Constants that shade.wgsl shares with Rust.
pub(crate) fn constants(key: PipelineKey) -> Constants {
    let mut constants = Constants::default();
    constants.u32("SAMPLES", key.samples);
    constants.bool("VALUED", key.valued);
    constants.bool("ALL_DEPTHS", key.all_depths);
    for (name, value) in [
        ("CATEGORY_BIT", CATEGORY_BIT),
        ("HIGHLIGHTED", HIGHLIGHTED),
        ("GHOSTED", GHOSTED),
        ("WITHOUT_NEURITES", WITHOUT_NEURITES),
        ("WITHOUT_SOMA", WITHOUT_SOMA),
        ("OUTLINED", OUTLINED),
    ] {
        constants.u32(name, value);
    }
    if key.samples > 1 {
        constants.flag("MULTISAMPLED");
    }
    if key.edged {
        constants.flag("EDGED");
    }
    constants
}

/// Group 1: the uniform, the colors, the states of instances.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let vertex = wgpu::ShaderStages::VERTEX;
    vec![
        uniform(0, wgpu::ShaderStages::VERTEX_FRAGMENT, false),
        storage(1, vertex, true),
        storage(2, vertex, true),
    ]
}
