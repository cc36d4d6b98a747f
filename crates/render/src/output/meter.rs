//! Measures the time of frames: they are selected and drawn as in a window, with one sample a
//! pixel, but neither finished nor read back.

use std::time::Instant;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::timing::Pass;
use crate::output::tiles::TileRenderer;
use crate::shading::shade::PipelineKey;
use crate::sources::VertexSource;
use neurotess_picture::Frame;
use neurotess_picture::Look;
use neurotess_picture::color::ColorTable;

/// The time that a frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTime {
    /// Milliseconds from the start on the CPU until the GPU had finished.
    pub waited_ms: f64,
    /// Milliseconds of the pass that selects and the pass that draws, if the GPU supports
    /// timestamps. None for scenes so large that they are drawn in several rounds, and none in
    /// software rendering, where timestamps are taken before all threads have finished.
    pub gpu_ms: Option<[f64; 2]>,
}

impl FrameTime {
    /// The GPU's milliseconds if they are known, else those waited.
    pub fn best_ms(&self) -> f64 {
        self.gpu_ms
            .map_or(self.waited_ms, |[select, draw]| select + draw)
    }
}

/// Measures the frames of one source.
pub struct Meter<'g> {
    gpu: &'g Gpu,
    renderer: TileRenderer,
}

impl<'g> Meter<'g> {
    /// Makes the pipelines for a source.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn new(
        gpu: &'g Gpu,
        source: &dyn VertexSource,
        table: &ColorTable,
    ) -> Result<Self, DeviceError> {
        let key = PipelineKey::new(source.key(), 1, table, &Look::default());
        let mut renderer = TileRenderer::new(gpu, source, key)?;
        renderer.set_table(gpu, table);
        Ok(Self { gpu, renderer })
    }

    /// Draws a frame and waits for it.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn time(
        &mut self,
        source: &mut dyn VertexSource,
        frame: &Frame,
    ) -> Result<FrameTime, DeviceError> {
        self.renderer.timer.reset();
        let clock = Instant::now();
        let rounds = self
            .renderer
            .draw_only(self.gpu, source, frame, &Look::default())?;
        let waited_ms = clock.elapsed().as_secs_f64() * 1e3;
        self.renderer.timer.read(self.gpu)?;
        // With several rounds, the queries hold only the last one's times.
        let measured = rounds == 1 && !self.gpu.adapter.software;
        let gpu_ms = self.renderer.timer.milliseconds().filter(|_| measured);
        Ok(FrameTime {
            waited_ms,
            gpu_ms: gpu_ms.map(|ms| [ms[Pass::Select as usize], ms[Pass::Draw as usize]]),
        })
    }
}
