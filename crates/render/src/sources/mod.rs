//! Vertex sources: what makes vertices, apart from what shades them.
//!
//! A **source** provides WGSL with the function `surface_vertex`, and issues the draws that call
//! it:
//!
//! ```wgsl
//! struct SurfaceVertex {
//!     position: vec3<f32>,  // µm, relative to the eye, after the instance's transform
//!     normal: vec3<f32>,    // unit, outwards
//!     axis: vec3<f32>,      // point of the tube's center line, relative to the eye
//!     radius: f32,          // µm; 0 on somata, which are never widened
//!     color_key: u32,       // of the tracing point: what the color is looked up by
//!     instance: u32,
//!     grid: vec2<f32>,      // for wireframes: lines run where x, y or x + y is a whole number
//! }
//! fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex
//! ```
//!
//! The struct is in `surface_vertex.wgsl`, which both sides import. Bind group 0 is the source's,
//! groups from 1 on are the shading's.

pub(crate) mod adaptive;
pub(crate) mod budgeted;
pub(crate) mod combined;
mod companion;
pub(crate) mod markers;
pub(crate) mod meshes;
pub(crate) mod pick;
pub(crate) mod prerefined;

use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use neurotess_picture::Frame;

/// Which shaders a source draws with: equal keys have equal shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SourceKey {
    /// Name of the source, unlike that of any other.
    pub name: &'static str,
    /// Number of the variant, for a source that has several.
    pub variant: u32,
    /// Whether another source draws some instances more finely, by its own shaders.
    pub finer: bool,
    /// Whether markers are drawn beside it, by one more shader.
    pub markers: bool,
    /// Whether meshes are drawn beside it, by one more shader.
    pub meshes: bool,
}

/// Makes vertices on the GPU, and selects how many.
pub trait VertexSource {
    /// Number of shaders that it draws with.
    fn shaders(&self) -> usize {
        1
    }

    /// Identifies its shaders: pipelines are cached by this key.
    fn key(&self) -> SourceKey;

    /// WGSL of one of its shaders: defines `surface_vertex` and bind group 0.
    fn shader(&self, shader: usize) -> ShaderParts;

    /// WGSL that is added to one of its shaders for picking: defines
    /// `surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32>`. The first component is
    /// less than 8 if a frame can have several rounds. None if the source does not support picking.
    fn id_shader(&self, _shader: usize) -> Option<WgslFile> {
        None
    }

    /// WGSL that is added to one of its shaders for pictures that are colored anew: defines
    /// `surface_keys(vertex_index: u32, instance_index: u32) -> SurfaceKeys`, see
    /// surface_keys.wgsl. None if the source does not support them.
    fn key_shader(&self, _shader: usize) -> Option<WgslFile> {
        None
    }

    /// As [`VertexSource::prepare`], for shaders with [`VertexSource::key_shader`].
    ///
    /// # Errors
    /// The device reports an error.
    fn prepare_keyed(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        self.prepare(gpu, frame)
    }

    /// Layout of bind group 0 of one of its shaders.
    fn layout(&self, shader: usize) -> &wgpu::BindGroupLayout;

    /// Whether one of its shaders draws surfaces that are seen from both sides, which may be open.
    fn is_two_sided(&self, _shader: usize) -> bool {
        false
    }

    /// Whether anything may show in a frame: tiles in which nothing does are not drawn.
    fn shows(&self, _frame: &Frame) -> bool {
        true
    }

    /// Number of things that [`VertexSource::shows`] looks at. With many, a picture is not searched for where
    /// it is empty, which takes some fifty questions.
    fn parts(&self) -> usize {
        1
    }

    /// Uploads what a frame needs. Returns the number of rounds: a frame is drawn in rounds, each
    /// first selected, then drawn.
    ///
    /// # Errors
    /// The device reports an error.
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError>;

    /// The compute pass of a round. An empty pass if there is nothing to do, since its timestamps
    /// are read.
    fn select(
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

    /// Draws what was selected for one of its shaders. The pipeline and the groups from 1 on are
    /// set.
    fn draw(&self, round: usize, shader: usize, pass: &mut wgpu::RenderPass<'_>);
}
