//! The textures and buffers that a progressive picture is drawn into.

use crate::gpu::buffers::make;
use crate::gpu::device::Gpu;
use crate::shading::finish::Finisher;
use crate::shading::present::Screen;
use crate::shading::targets::Targets;

/// Textures and buffers of one size.
pub(super) struct Canvas {
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    pub(super) targets: Targets,
    /// Sums over the steps; empty for drafts, which have a single step.
    pub(super) sums: wgpu::Buffer,
    pub(super) screen: Screen,
}

impl Canvas {
    pub(super) fn new(gpu: &Gpu, size: [u32; 2], samples: u32, draft: bool) -> Self {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let sums = if draft { 0 } else { 16 * pixels };
        Self {
            size,
            samples,
            targets: Targets::new(gpu, size, samples),
            sums: make(gpu, "sums", sums, wgpu::BufferUsages::STORAGE),
            screen: Screen::new(gpu, size, draft),
        }
    }

    pub(super) fn group(
        &self,
        gpu: &Gpu,
        finisher: &Finisher,
        finish: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let view = wgpu::BindingResource::TextureView;
        let targets = &self.targets;
        let resolved = targets.resolved.as_ref().unwrap_or(&targets.color);
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("finish"),
            layout: &finisher.layout,
            entries: &[
                entry(0, finish.as_entire_binding()),
                entry(1, view(resolved)),
                entry(2, view(&targets.normal)),
                entry(3, view(&targets.distance)),
                entry(4, targets.raw.as_entire_binding()),
                entry(5, targets.blurred.as_entire_binding()),
                entry(6, targets.pixels.as_entire_binding()),
                entry(7, targets.blocks.as_entire_binding()),
                entry(8, self.sums.as_entire_binding()),
            ],
        })
    }
}
