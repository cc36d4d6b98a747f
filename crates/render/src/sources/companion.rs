//! What is drawn beside any vertex source, by one more shader.

use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use crate::gpu::device::Gpu;
use neurotess_picture::Frame;

/// Something that is drawn beside a vertex source: see
/// [`Combined`](crate::sources::combined::Combined).
pub(crate) trait Companion {
    /// WGSL that defines `surface_vertex` and bind group 0.
    fn shader(&self) -> ShaderParts;

    /// WGSL that defines `surface_id`.
    fn id_shader(&self) -> WgslFile;

    /// WGSL that defines `surface_keys`.
    fn key_shader(&self) -> WgslFile;

    /// Layout of bind group 0.
    fn layout(&self) -> &wgpu::BindGroupLayout;

    /// Whether back faces are drawn, too.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// Whether any of it may show in a frame.
    fn shows(&self, frame: &Frame) -> bool;

    /// As [`VertexSource::parts`](crate::sources::VertexSource::parts).
    fn parts(&self) -> usize;

    /// Selects and uploads what a frame needs.
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame);

    /// Draws what was selected.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>);
}
