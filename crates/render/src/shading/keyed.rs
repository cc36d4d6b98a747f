//! The pass that draws whose color each sample has, and how it is lit, with keyed.wgsl.

use neurotess_refine::wgsl::{Shader, ShaderParts, WgslFile};

use crate::gpu::device::Gpu;
use crate::gpu::shader;
use crate::shading::shade::{self, DEPTH_FORMAT, DrawPass, GUARD, PipelineKey};
use crate::shading::targets::target;
use crate::sources::VertexSource;

/// Of all targets: four whole numbers of 16 bits, the largest that can be multisampled everywhere.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Uint;

/// The shader for a source's vertices and its `surface_keys`.
pub(crate) fn keyed_shader(source: &ShaderParts, keys: WgslFile, key: PipelineKey) -> Shader {
    let mut parts = source.clone();
    parts.files.extend([keys, shader::file("keyed.wgsl")]);
    parts.constants.extend(&shade::constants(key));
    parts.constants.flag("KEYED");
    shader::shader("keyed", &parts)
}

/// Textures of one size that the pass draws into.
pub(crate) struct KeyedTargets {
    pub(crate) weights: wgpu::TextureView,
    pub(crate) keys: wgpu::TextureView,
    pub(crate) owners: wgpu::TextureView,
    depth: wgpu::TextureView,
    pub(crate) size: [u32; 2],
    pub(crate) bytes: u64,
}

impl KeyedTargets {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], samples: u32) -> Self {
        let mut bytes = 0;
        let mut texture = |format| {
            let (view, more) = target(gpu, size, samples, format);
            bytes += more;
            view
        };
        Self {
            weights: texture(FORMAT),
            keys: texture(FORMAT),
            owners: texture(FORMAT),
            depth: texture(DEPTH_FORMAT),
            size,
            bytes,
        }
    }
}

/// Draws a source's vertices into [`KeyedTargets`].
pub(crate) struct KeyedShader {
    pipelines: Vec<wgpu::RenderPipeline>,
}

impl KeyedShader {
    /// None if the source has no color keys to look up. `layout`: that of the shading's group 1.
    pub(crate) fn new(
        gpu: &Gpu,
        source: &dyn VertexSource,
        key: PipelineKey,
        layout: &wgpu::BindGroupLayout,
    ) -> Option<Self> {
        let keys = (0..source.shaders()).map(|shader| source.key_shader(shader));
        let keys: Vec<WgslFile> = keys.collect::<Option<_>>()?;
        let pass = DrawPass {
            label: "keyed",
            shader: &|shader| keyed_shader(&source.shader(shader), keys[shader], key),
            entry_points: ["vertex_keyed", "fragment_keyed"],
            formats: [FORMAT; 3],
        };
        Some(Self {
            pipelines: pass.pipelines(gpu, source, key, layout),
        })
    }

    /// Draws a round that was selected just before. `group`: the shading's group 1.
    pub(crate) fn draw(
        &self,
        source: &dyn VertexSource,
        round: usize,
        targets: &KeyedTargets,
        group: &wgpu::BindGroup,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let first = round == 0;
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: match first {
                        true => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        false => wgpu::LoadOp::Load,
                    },
                    store: wgpu::StoreOp::Store,
                },
            })
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("keyed"),
            color_attachments: &[&targets.weights, &targets.keys, &targets.owners].map(attachment),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations {
                    load: match first {
                        true => wgpu::LoadOp::Clear(0.0),
                        false => wgpu::LoadOp::Load,
                    },
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(1, group, &[]);
        let [width, height] = targets.size.map(|n| n as f32 + 2.0 * GUARD);
        pass.set_viewport(-GUARD, -GUARD, width, height, 0.0, 1.0);
        for (shader, pipeline) in self.pipelines.iter().enumerate() {
            pass.set_pipeline(pipeline);
            source.draw(round, shader, &mut pass);
        }
    }
}
