//! A vertex source with another one, markers and meshes beside what it draws.

use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use super::companion::Companion;
use super::markers::Markers;
use super::meshes::Meshes;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::sources::{SourceKey, VertexSource};
use neurotess_picture::Frame;

/// Vertex sources, markers and meshes, drawn together.
pub struct Combined<'a> {
    source: &'a mut dyn VertexSource,
    finer: Option<&'a mut dyn VertexSource>,
    /// Rounds of the frame that was prepared last: of both sources.
    rounds: [usize; 2],
    markers: Option<&'a mut Markers>,
    meshes: Option<&'a mut Meshes>,
}

impl<'a> Combined<'a> {
    /// Draws what the source draws.
    pub fn new(source: &'a mut dyn VertexSource) -> Self {
        Self {
            source,
            finer: None,
            rounds: [1; 2],
            markers: None,
            meshes: None,
        }
    }

    /// Draws what another source draws, too: instances of the same scene that it draws more finely, which the
    /// first one leaves out. Pictures with it have no picking ids.
    #[must_use]
    pub fn with_finer(mut self, finer: Option<&'a mut dyn VertexSource>) -> Self {
        self.finer = finer;
        self
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

    /// What the shader of this number draws.
    fn drawn_by(&self, shader: usize) -> DrawnBy<'_> {
        let Some(after) = shader.checked_sub(self.source.shaders()) else {
            return DrawnBy::Source(0, &*self.source, shader);
        };
        let finer = self.finer.as_deref();
        match after.checked_sub(finer.map_or(0, VertexSource::shaders)) {
            Some(own) => match self.companions().nth(own) {
                Some(companion) => DrawnBy::Companion(companion),
                None => DrawnBy::Source(0, &*self.source, shader),
            },
            None => DrawnBy::Source(1, finer.unwrap_or(&*self.source), after),
        }
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

/// What draws with a shader.
enum DrawnBy<'a> {
    /// One of the sources, by its number, with its shader of this number.
    Source(usize, &'a dyn VertexSource, usize),
    Companion(&'a dyn Companion),
}

impl VertexSource for Combined<'_> {
    fn shaders(&self) -> usize {
        let finer = self.finer.as_deref().map_or(0, VertexSource::shaders);
        self.source.shaders() + finer + self.companions().count()
    }

    fn key(&self) -> SourceKey {
        SourceKey {
            finer: self.finer.is_some(),
            markers: self.markers.is_some(),
            meshes: self.meshes.is_some(),
            ..self.source.key()
        }
    }

    fn shader(&self, shader: usize) -> ShaderParts {
        match self.drawn_by(shader) {
            DrawnBy::Companion(companion) => companion.shader(),
            DrawnBy::Source(_, source, own) => source.shader(own),
        }
    }

    fn id_shader(&self, shader: usize) -> Option<WgslFile> {
        match self.drawn_by(shader) {
            DrawnBy::Companion(companion) => Some(companion.id_shader()),
            DrawnBy::Source(_, source, own) => source.id_shader(own),
        }
    }

    fn key_shader(&self, shader: usize) -> Option<WgslFile> {
        match self.drawn_by(shader) {
            DrawnBy::Companion(companion) => Some(companion.key_shader()),
            DrawnBy::Source(_, source, own) => source.key_shader(own),
        }
    }

    fn layout(&self, shader: usize) -> &wgpu::BindGroupLayout {
        match self.drawn_by(shader) {
            DrawnBy::Companion(companion) => companion.layout(),
            DrawnBy::Source(_, source, own) => source.layout(own),
        }
    }

    fn is_two_sided(&self, shader: usize) -> bool {
        match self.drawn_by(shader) {
            DrawnBy::Companion(companion) => companion.is_two_sided(),
            DrawnBy::Source(_, source, own) => source.is_two_sided(own),
        }
    }

    fn shows(&self, frame: &Frame) -> bool {
        let mut companions = self.companions();
        let finer = self.finer.as_deref();
        self.source.shows(frame)
            || finer.is_some_and(|finer| finer.shows(frame))
            || companions.any(|companion| companion.shows(frame))
    }

    fn parts(&self) -> usize {
        let finer = self.finer.as_deref().map_or(0, VertexSource::parts);
        let companions = self.companions().map(Companion::parts);
        self.source.parts() + finer + companions.sum::<usize>()
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        self.prepare_companions(gpu, frame);
        let finer = match &mut self.finer {
            Some(finer) => finer.prepare(gpu, frame)?,
            None => 0,
        };
        self.rounds = [self.source.prepare(gpu, frame)?.max(1), finer];
        Ok(self.rounds[0].max(finer))
    }

    fn prepare_keyed(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        self.prepare_companions(gpu, frame);
        let finer = match &mut self.finer {
            Some(finer) => finer.prepare_keyed(gpu, frame)?,
            None => 0,
        };
        self.rounds = [self.source.prepare_keyed(gpu, frame)?.max(1), finer];
        Ok(self.rounds[0].max(finer))
    }

    fn select(
        &self,
        round: usize,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        let [own, finer] = self.rounds.map(|rounds| round < rounds);
        if let Some(source) = self.finer.as_deref().filter(|_| finer) {
            // One pass of the round is timed.
            let timed = timestamps.clone().filter(|_| !own);
            source.select(round, encoder, timed);
        }
        if own {
            self.source.select(round, encoder, timestamps);
        }
    }

    fn draw(&self, round: usize, shader: usize, pass: &mut wgpu::RenderPass<'_>) {
        match self.drawn_by(shader) {
            // A frame of many rounds has them in the first.
            DrawnBy::Companion(companion) if round == 0 => companion.draw(pass),
            DrawnBy::Companion(_) => {}
            DrawnBy::Source(which, source, own) if round < self.rounds[which] => {
                source.draw(round, own, pass);
            }
            DrawnBy::Source(..) => {}
        }
    }
}
