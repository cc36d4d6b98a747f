//! The render pass that draws what a source has selected.

use std::ops::Range;

use crate::gpu::timing::Pass;
use crate::shading::shade::GUARD;
use crate::shading::targets::Targets;
use crate::sources::VertexSource;

use super::TileRenderer;

/// A render pass over the targets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TilePass {
    pub(crate) round: usize,
    /// Those of the source's shaders that draw.
    pub(crate) shaders: Range<usize>,
    /// Whether the targets are cleared before.
    pub(crate) first: bool,
    /// Whether it is the last pass of the tile, which resolves samples to sub-pixels.
    pub(crate) last: bool,
    /// Left, top, width and height of the rectangle that is drawn to; none: the whole target.
    pub(crate) within: Option<[u32; 4]>,
}

impl TilePass {
    pub(crate) fn round(round: usize, rounds: usize) -> Self {
        Self {
            round,
            shaders: 0..usize::MAX,
            first: round == 0,
            last: round + 1 == rounds,
            within: None,
        }
    }
}

impl TileRenderer {
    /// Draws what the source selected last.
    pub(crate) fn draw(
        &self,
        source: &dyn VertexSource,
        part: &TilePass,
        targets: &Targets,
        group: &wgpu::BindGroup,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let empty = match part.first {
            true => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            false => wgpu::LoadOp::Load,
        };
        let attachment = |view, resolve_target, store| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations { load: empty, store },
            })
        };
        let kept = match part.last {
            true => wgpu::StoreOp::Discard,
            false => wgpu::StoreOp::Store,
        };
        let resolved = targets.resolved.as_ref().filter(|_| part.last);
        let color_store = match targets.resolved {
            Some(_) => kept,
            None => wgpu::StoreOp::Store,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("draw"),
            color_attachments: &[
                attachment(&targets.color, resolved, color_store),
                attachment(&targets.normal, None, wgpu::StoreOp::Store),
                attachment(&targets.distance, None, wgpu::StoreOp::Store),
            ],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations {
                    load: match part.first {
                        true => wgpu::LoadOp::Clear(0.0),
                        false => wgpu::LoadOp::Load,
                    },
                    // The next round needs the depths of this one.
                    store: kept,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: self.timer.render(Pass::Draw),
            ..Default::default()
        });
        pass.set_bind_group(1, group, &[]);
        let [width, height] = targets.size.map(|n| n as f32 + 2.0 * GUARD);
        pass.set_viewport(-GUARD, -GUARD, width, height, 0.0, 1.0);
        if let Some([x, y, width, height]) = part.within {
            pass.set_scissor_rect(x, y, width, height);
        }
        for (shader, pipeline) in self.shader.pipelines.iter().enumerate() {
            if part.shaders.contains(&shader) {
                pass.set_pipeline(pipeline);
                source.draw(part.round, shader, &mut pass);
            }
        }
    }
}
