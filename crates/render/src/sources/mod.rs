//! The seam between what makes vertices and what shades them.
//!
//! A **source** gives WGSL with one function, and draws by it:
//!
//! ```wgsl
//! struct SurfaceVertex {
//!     position: vec3<f32>,  // µm, relative to the eye, after the instance's transform
//!     normal: vec3<f32>,    // unit, outwards
//!     axis: vec3<f32>,      // point of the tube's center line, relative to the eye
//!     radius: f32,          // µm; 0 on somata, which are never widened
//!     color_key: u32,            // color key of the tracing point: what the color is looked up by
//!     instance: u32,
//!     grid: vec2<f32>,      // for wireframes: lines run where x, y or x + y is a whole number
//! }
//! fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex
//! ```
//!
//! The struct is in `surface_vertex.wgsl`, which both sides import. Bind group 0 is the source's, groups from 1 on are the shading's.

pub(crate) mod adaptive;
pub(crate) mod budgeted;
pub(crate) mod pick;
pub(crate) mod prerefined;

use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::view::frame::Frame;

/// Which shaders a source draws with: equal keys have equal shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SourceKey {
    /// Name of the source, its own.
    pub name: &'static str,
    /// Which of its variants.
    pub variant: u32,
}

/// Makes vertices on the GPU, and decides how many.
pub trait VertexSource {
    /// Number of shaders that it draws with.
    fn shaders(&self) -> usize {
        1
    }

    /// Which shaders it draws with: pipelines are kept by this.
    fn key(&self) -> SourceKey;

    /// Defines `surface_vertex` and what it needs, with bind group 0, for one of its shaders.
    fn shader(&self, shader: usize) -> ShaderParts;

    /// Defines `surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32>`, the first less than 8
    /// where a frame has several rounds, beside what [`VertexSource::shader`] defines; none where what is
    /// drawn cannot be picked.
    fn id_shader(&self) -> Option<WgslFile> {
        None
    }

    /// Layout of bind group 0.
    fn layout(&self) -> &wgpu::BindGroupLayout;

    /// Whether anything may show in a frame: tiles in which nothing does are not drawn.
    fn shows(&self, _frame: &Frame) -> bool {
        true
    }

    /// What must be uploaded before a frame can be drawn. Gives the number of rounds that draw it:
    /// one after the other, each chosen, then drawn.
    ///
    /// # Errors
    /// What the device cannot do.
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError>;

    /// The compute pass of a round. Nothing to do is still a pass: its times are read.
    fn choose(
        &self,
        _round: usize,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("choose"),
            timestamp_writes: timestamps,
        });
    }

    /// Draws what was chosen for one of its shaders. The pipeline and the groups from 1 on are set.
    fn draw(&self, round: usize, shader: usize, pass: &mut wgpu::RenderPass<'_>);
}
