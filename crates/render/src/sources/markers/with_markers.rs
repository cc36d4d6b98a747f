//! A vertex source with markers beside what it draws.

use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use super::{Markers, vertex_shader};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::sources::{SourceKey, VertexSource};
use crate::view::frame::Frame;

/// A vertex source and markers, drawn together.
pub struct WithMarkers<'a> {
    source: &'a mut dyn VertexSource,
    markers: Option<&'a mut Markers>,
    /// Rounds of the source; the markers are drawn in the first.
    rounds: usize,
}

impl<'a> WithMarkers<'a> {
    /// Draws markers, if there are any, beside what the source draws.
    pub fn new(source: &'a mut dyn VertexSource, markers: Option<&'a mut Markers>) -> Self {
        Self {
            source,
            markers,
            rounds: 0,
        }
    }

    /// The markers, if they are what the shader of this number draws.
    fn drawn_by(&self, shader: usize) -> Option<&Markers> {
        let markers = self.markers.as_deref();
        markers.filter(|_| shader >= self.source.shaders())
    }
}

impl VertexSource for WithMarkers<'_> {
    fn shaders(&self) -> usize {
        self.source.shaders() + usize::from(self.markers.is_some())
    }

    fn key(&self) -> SourceKey {
        SourceKey {
            markers: self.markers.is_some(),
            ..self.source.key()
        }
    }

    fn shader(&self, shader: usize) -> ShaderParts {
        match self.drawn_by(shader) {
            Some(_) => vertex_shader(),
            None => self.source.shader(shader),
        }
    }

    fn id_shader(&self, shader: usize) -> Option<WgslFile> {
        match self.drawn_by(shader) {
            Some(_) => Some(shader::file("marker_id.wgsl")),
            None => self.source.id_shader(shader),
        }
    }

    fn key_shader(&self, shader: usize) -> Option<WgslFile> {
        match self.drawn_by(shader) {
            Some(_) => Some(shader::file("marker_keys.wgsl")),
            None => self.source.key_shader(shader),
        }
    }

    fn layout(&self, shader: usize) -> &wgpu::BindGroupLayout {
        match self.drawn_by(shader) {
            Some(markers) => &markers.layout,
            None => self.source.layout(shader),
        }
    }

    fn shows(&self, frame: &Frame) -> bool {
        let markers = self.markers.as_deref();
        self.source.shows(frame) || markers.is_some_and(|markers| markers.shows(frame))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        if let Some(markers) = &mut self.markers {
            markers.prepare(gpu, frame);
        }
        self.rounds = self.source.prepare(gpu, frame)?;
        Ok(self.rounds.max(1))
    }

    fn prepare_keyed(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        if let Some(markers) = &mut self.markers {
            markers.prepare(gpu, frame);
        }
        self.rounds = self.source.prepare_keyed(gpu, frame)?;
        Ok(self.rounds.max(1))
    }

    fn select(
        &self,
        round: usize,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        self.source.select(round, encoder, timestamps);
    }

    fn draw(&self, round: usize, shader: usize, pass: &mut wgpu::RenderPass<'_>) {
        match self.drawn_by(shader) {
            Some(markers) if round == 0 => markers.draw(pass),
            Some(_) => {}
            None => self.source.draw(round, shader, pass),
        }
    }
}
