//! A vertex source with markers and meshes beside what it draws.

use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use super::companion::Companion;
use super::markers::Markers;
use super::meshes::Meshes;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::sources::{SourceKey, VertexSource};
use crate::view::frame::Frame;

/// A vertex source, markers and meshes, drawn together.
pub struct Combined<'a> {
    source: &'a mut dyn VertexSource,
    markers: Option<&'a mut Markers>,
    meshes: Option<&'a mut Meshes>,
}

impl<'a> Combined<'a> {
    /// Draws what the source draws.
    pub fn new(source: &'a mut dyn VertexSource) -> Self {
        Self {
            source,
            markers: None,
            meshes: None,
        }
    }

    /// Draws markers beside it, if there are any.
    #[must_use]
    pub fn with_markers(mut self, markers: Option<&'a mut Markers>) -> Self {
        self.markers = markers;
        self
    }

    /// Draws meshes beside it, if there are any.
    #[must_use]
    pub fn with_meshes(mut self, meshes: Option<&'a mut Meshes>) -> Self {
        self.meshes = meshes;
        self
    }

    fn companions(&self) -> impl Iterator<Item = &dyn Companion> {
        let markers = self.markers.as_deref().map(|m| m as &dyn Companion);
        let meshes = self.meshes.as_deref().map(|m| m as &dyn Companion);
        markers.into_iter().chain(meshes)
    }

    /// What the shader of this number draws, if it is not the source's.
    fn drawn_by(&self, shader: usize) -> Option<&dyn Companion> {
        let own = shader.checked_sub(self.source.shaders())?;
        self.companions().nth(own)
    }

    fn prepare_companions(&mut self, gpu: &Gpu, frame: &Frame) {
        if let Some(markers) = &mut self.markers {
            markers.prepare(gpu, frame);
        }
        if let Some(meshes) = &mut self.meshes {
            meshes.prepare(gpu, frame);
        }
    }
}

impl VertexSource for Combined<'_> {
    fn shaders(&self) -> usize {
        self.source.shaders() + self.companions().count()
    }

    fn key(&self) -> SourceKey {
        SourceKey {
            markers: self.markers.is_some(),
            meshes: self.meshes.is_some(),
            ..self.source.key()
        }
    }

    fn shader(&self, shader: usize) -> ShaderParts {
        match self.drawn_by(shader) {
            Some(companion) => companion.shader(),
            None => self.source.shader(shader),
        }
    }

    fn id_shader(&self, shader: usize) -> Option<WgslFile> {
        match self.drawn_by(shader) {
            Some(companion) => Some(companion.id_shader()),
            None => self.source.id_shader(shader),
        }
    }

    fn key_shader(&self, shader: usize) -> Option<WgslFile> {
        match self.drawn_by(shader) {
            Some(companion) => Some(companion.key_shader()),
            None => self.source.key_shader(shader),
        }
    }

    fn layout(&self, shader: usize) -> &wgpu::BindGroupLayout {
        match self.drawn_by(shader) {
            Some(companion) => companion.layout(),
            None => self.source.layout(shader),
        }
    }

    fn is_two_sided(&self, shader: usize) -> bool {
        match self.drawn_by(shader) {
            Some(companion) => companion.is_two_sided(),
            None => self.source.is_two_sided(shader),
        }
    }

    fn shows(&self, frame: &Frame) -> bool {
        let mut companions = self.companions();
        self.source.shows(frame) || companions.any(|companion| companion.shows(frame))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        self.prepare_companions(gpu, frame);
        Ok(self.source.prepare(gpu, frame)?.max(1))
    }

    fn prepare_keyed(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        self.prepare_companions(gpu, frame);
        Ok(self.source.prepare_keyed(gpu, frame)?.max(1))
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
            // A frame of many rounds has them in the first.
            Some(companion) if round == 0 => companion.draw(pass),
            Some(_) => {}
            None => self.source.draw(round, shader, pass),
        }
    }
}
