//! A stopwatch for frames: they are chosen and drawn as a viewer's would be, one sample a pixel, and
//! neither finished nor read back.

use std::time::Instant;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::timing::Pass;
use crate::output::tiles::TileRenderer;
use crate::scene::color::ColorTable;
use crate::shading::shade::{Look, PipelineKey};
use crate::sources::VertexSource;
use crate::view::frame::Frame;

/// What a frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTime {
    /// Milliseconds from the first thing done on the processor until the GPU had finished.
    pub waited_ms: f64,
    /// Milliseconds of the passes that choose and that draw, where the GPU can tell: not of scenes so
    /// large that they are drawn in several rounds, and not in software, whose clock stops before its
    /// threads do.
    pub gpu_ms: Option<[f64; 2]>,
}

impl FrameTime {
    /// The GPU's milliseconds where it can tell, else those waited.
    pub fn best_ms(&self) -> f64 {
        self.gpu_ms
            .map_or(self.waited_ms, |[choose, draw]| choose + draw)
    }
}

/// Times frames of one source.
pub struct Meter<'g> {
    gpu: &'g Gpu,
    renderer: TileRenderer,
}

impl<'g> Meter<'g> {
    /// Makes what all frames of a source share.
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn new(
        gpu: &'g Gpu,
        source: &dyn VertexSource,
        table: &ColorTable,
    ) -> Result<Self, DeviceError> {
        let mut renderer = TileRenderer::new(
            gpu,
            source,
            PipelineKey {
                samples: 1,
                valued: table.values.instances() > 0,
                ..PipelineKey::default()
            },
        )?;
        renderer.set_table(gpu, table);
        Ok(Self { gpu, renderer })
    }

    /// Draws a frame and waits for it.
    ///
    /// # Errors
    /// What the device cannot do.
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
        // Of several rounds the queries hold the last one's times.
        let tells = rounds == 1 && !self.gpu.adapter.software;
        let gpu_ms = self.renderer.timer.milliseconds().filter(|_| tells);
        Ok(FrameTime {
            waited_ms,
            gpu_ms: gpu_ms.map(|ms| [ms[Pass::Choose as usize], ms[Pass::Draw as usize]]),
        })
    }
}
