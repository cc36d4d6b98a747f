//! The seam between who makes vertices and who shades them.
//!
//! A **maker** gives WGSL with one function, and draws by it:
//!
//! ```wgsl
//! struct SurfaceVertex {
//!     position: vec3<f32>,  // µm, relative to the eye, after the instance's transform
//!     normal: vec3<f32>,    // unit, outwards
//!     axis: vec3<f32>,      // point of the tube's centre line, relative to the eye
//!     radius: f32,          // µm; 0 on somata, which are never widened
//!     word: u32,            // word of the tracing point: what the colour is looked up by
//!     instance: u32,
//!     grid: vec2<f32>,      // for wireframes: lines run where x, y or x + y is a whole number
//! }
//! fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex
//! ```
//!
//! The struct stands in [`SURFACE_VERTEX_WGSL`], which comes first; then the maker's text, then the
//! shading. Bind group 0 is the maker's, groups from 1 on are the shading's.

use crate::device::Gpu;
use crate::error::DeviceError;
use crate::frame::Frame;

/// The struct that makers return.
pub const SURFACE_VERTEX_WGSL: &str = include_str!("surface_vertex.wgsl");

/// Makes vertices on the GPU, and decides how many.
pub trait VertexMaker {
    /// Defines `surface_vertex` and what it needs, with bind group 0.
    fn wgsl(&self) -> String;

    /// Layout of bind group 0.
    fn layout(&self) -> &wgpu::BindGroupLayout;

    /// What must be done before a frame can be drawn: uniforms, compute passes.
    ///
    /// # Errors
    /// What the device cannot do.
    fn prepare(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame,
    ) -> Result<(), DeviceError>;

    /// Draws what was prepared. The pipeline and the groups from 1 on are set.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>);
}
