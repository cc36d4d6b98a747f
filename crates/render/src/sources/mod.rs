//! The seam between who makes vertices and who shades them.
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
//! The struct stands in [`SURFACE_VERTEX_WGSL`], which comes first; then the source's text, then the
//! shading. Bind group 0 is the source's, groups from 1 on are the shading's.

pub(crate) mod adaptive;
pub(crate) mod budgeted;
pub(crate) mod pick;
pub(crate) mod prerefined;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::view::frame::Frame;

/// The struct that sources return.
pub const SURFACE_VERTEX_WGSL: &str = include_str!("surface_vertex.wgsl");

/// Makes vertices on the GPU, and decides how many.
pub trait VertexSource {
    /// Number of shaders that it draws with.
    fn shaders(&self) -> usize {
        1
    }

    /// Defines `surface_vertex` and what it needs, with bind group 0, for one of its shaders.
    fn wgsl(&self, shader: usize) -> String;

    /// Defines `surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32>`, the first less than 8 where
    /// a frame has several rounds, to stand after [`VertexSource::wgsl`]; nothing where what is drawn cannot be told apart.
    fn id_wgsl(&self) -> Option<&'static str> {
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
