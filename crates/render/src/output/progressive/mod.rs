//! Pictures for a window: they stay on the device, and get better slice by slice.
//!
//! **Theory.** A picture of 16 samples takes a GPU milliseconds and a processor seconds. While the
//! camera moves, a **draft** is drawn at once: four samples, no occlusion. At rest the picture is
//! drawn in **steps** of one sub-pixel each, offset so that they add up to the samples of a saved
//! picture (`still.rs`), and each step in **slices**, which are short whatever the scene: between
//! them a window can show what there is so far, or stop.
//!
//! ```text
//! source ─▶ draw, band by band ─▶ occlude once ─▶ accumulate ─▶ present: texture, outlines
//!      └─▶ ids: which patch is at which pixel
//! ```
//!
//! After that it can be made into a picture that is colored anew without being drawn: `recoloring.rs`.

mod canvas;
mod clock;
mod draw;
mod picking;
mod recoloring;
mod step;
mod under_way;

use std::sync::Arc;
use std::sync::atomic::Ordering;

use crate::gpu::buffers::make;
use crate::gpu::device::Gpu;
use crate::gpu::device::samples_in_sub_pixel;
use crate::gpu::error::DeviceError;
use crate::output::ids::Identifier;
use crate::output::tiles::TileRenderer;
use crate::shading::finish::{Finish, Finisher, Last};
use crate::shading::present::{Outlines, Presenter};
use crate::shading::shade::PipelineKey;
use crate::sources::VertexSource;
use neurotess_picture::Image;
use neurotess_picture::color::{ColorTable, InstanceValues};

use canvas::Canvas;
use clock::Clock;
use recoloring::Recoloring;
use step::selected;
use under_way::UnderWay;

pub use step::{Steps, ViewParams};

/// A picture on the device.
pub struct ProgressiveRenderer {
    renderers: Vec<TileRenderer>,
    finishers: Vec<(u32, Finisher)>,
    identifier: Option<Identifier>,
    presenter: Presenter,
    finish: wgpu::Buffer,
    draft: Option<Canvas>,
    fine: Option<Canvas>,
    shows_draft: bool,
    outlines: Outlines,
    table: ColorTable,
    /// Number of the current table, so that each renderer gets each table once.
    tables: u64,
    states: Vec<u32>,
    under_way: Option<UnderWay>,
    /// What shows instead of the fine canvas's own picture.
    given: Option<wgpu::Buffer>,
    /// The view whose occlusion the fine canvas holds.
    occluded: Option<ViewParams>,
    recoloring: Recoloring,
    clock: Arc<Clock>,
}

impl ProgressiveRenderer {
    /// A renderer without a picture. Pipelines are made with the first source.
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            renderers: Vec::new(),
            finishers: Vec::new(),
            identifier: None,
            presenter: Presenter::new(gpu, samples_in_sub_pixel(gpu, 4)),
            finish: make(
                gpu,
                "finish",
                size_of::<Finish>() as u64,
                wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            ),
            draft: None,
            fine: None,
            shows_draft: false,
            outlines: Outlines::default(),
            table: ColorTable::default(),
            tables: 1,
            states: Vec::new(),
            under_way: None,
            given: None,
            occluded: None,
            recoloring: Recoloring::default(),
            clock: Arc::default(),
        }
    }

    /// Colors from the next picture on.
    pub fn set_colors(&mut self, table: ColorTable) {
        self.table = table;
        self.tables += 1;
    }

    /// Other values of instances from the next picture on; the colors stay.
    pub fn set_values(&mut self, values: InstanceValues) {
        self.table.values = values;
        self.tables += 1;
    }

    /// States of instances from the next picture on, in the scene's order:
    /// [`HIGHLIGHTED`](crate::state::HIGHLIGHTED) and so on; 0 for instances beyond the end.
    pub fn set_states(&mut self, states: Vec<u32>) {
        self.states = states;
    }

    /// Outlines from the next [`ProgressiveRenderer::show`] on: bytes of
    /// [`SELECTED`](crate::outline::SELECTED) and [`HOVERED`](crate::outline::HOVERED) by pixel of
    /// a picture of this size.
    pub fn set_outlines(&mut self, gpu: &Gpu, outlines: Outlines, mask: Option<([u32; 2], &[u8])>) {
        self.outlines = outlines;
        self.presenter.set_mask(gpu, mask);
    }

    /// Draws a draft at once. Instances that are [`OUTLINED`](crate::state::OUTLINED) have an
    /// outline in the color of selected ones, as wide as [`ProgressiveRenderer::set_outlines`]
    /// says.
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn draft(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        params: &ViewParams,
    ) -> Result<(), DeviceError> {
        self.stop();
        // As many samples as the first step at rest has: with one, lines thinner than a pixel are
        // dots.
        let samples = samples_in_sub_pixel(gpu, 4);
        let renderer = self.renderer(gpu, source, samples, params)?;
        self.make_canvas(gpu, true, params.size, samples)?;
        let way = UnderWay::draft(params);
        self.shows_draft = true;
        self.draw(gpu, source, renderer, &way)
    }

    /// Begins a picture, which [`ProgressiveRenderer::slice`] then draws.
    pub fn begin(&mut self, params: ViewParams, steps: Steps) {
        self.drop_static();
        self.given = None;
        self.occluded = None;
        self.under_way = Some(UnderWay::new(params, steps));
    }

    /// Shows a picture of this view that someone else has drawn, until another one is begun.
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn put(
        &mut self,
        gpu: &Gpu,
        params: &ViewParams,
        image: &Image,
    ) -> Result<(), DeviceError> {
        self.drop_static();
        self.stop();
        self.make_canvas(gpu, false, params.size, samples_in_sub_pixel(gpu, 4))?;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let given = make(gpu, "given", image.pixels.len() as u64, usage);
        gpu.queue.write_buffer(&given, 0, &image.pixels);
        self.given = Some(given);
        self.shows_draft = false;
        self.show(gpu);
        gpu.check()
    }

    /// Whether no pipelines were made yet: the first draft or slice makes them.
    pub fn is_new(&self) -> bool {
        self.renderers.is_empty()
    }

    /// Draws no more of the picture under way. A static picture goes on.
    pub fn stop(&mut self) {
        self.under_way = self.under_way.filter(|way| way.hidden);
    }

    /// Share of the picture under way that has been drawn; none if no picture is under way.
    pub fn progress(&self) -> Option<f32> {
        let way = self.under_way.filter(|way| !way.hidden)?;
        let made = way.step * way.steps.slices + way.slice;
        Some(made as f32 / (way.steps.steps * way.steps.slices) as f32)
    }

    /// Draws the next slice of the picture under way. True if it was the last of its step, so that
    /// there is something new to show. The slice before must be done: see
    /// [`ProgressiveRenderer::is_busy`].
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn slice(&mut self, gpu: &Gpu, source: &mut dyn VertexSource) -> Result<bool, DeviceError> {
        let Some(mut way) = self.under_way else {
            return Ok(false);
        };
        if (way.step, way.slice) == (0, 0) {
            let rounds = source.prepare(gpu, &selected(&way.params, None))?;
            way.lay_out(rounds, source);
        }
        let samples = samples_in_sub_pixel(gpu, 4);
        let renderer = self.renderer(gpu, source, samples, &way.params)?;
        self.make_canvas(gpu, false, way.params.size, samples)?;
        self.draw(gpu, source, renderer, &way)?;
        let mut next = way;
        next.slice += 1;
        let whole = next.slice == way.steps.slices;
        if whole {
            (next.slice, next.step) = (0, next.step + 1);
            self.shows_draft &= way.hidden;
            self.occluded = Some(way.params);
        }
        let ends = next.step == way.steps.steps || (whole && way.hidden);
        self.under_way = (!ends).then_some(next);
        Ok(whole)
    }

    /// Whether the device is still at work on what was submitted last. Call it again and again: it
    /// polls the device, which makes progress only when polled.
    pub fn is_busy(&self, gpu: &Gpu) -> bool {
        // The next call that draws returns what went wrong.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        let clock = &self.clock;
        clock.done.load(Ordering::Acquire) < clock.submitted.load(Ordering::Acquire)
    }

    /// Milliseconds from submitting the last work until it was done.
    pub fn last_ms(&self) -> f64 {
        self.clock.took.load(Ordering::Acquire) as f64 / 1e3
    }

    /// Writes the current picture into its texture once more, with the current outlines.
    pub fn show(&self, gpu: &Gpu) {
        if let Some(canvas) = self.shown() {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.present(gpu, canvas, &mut encoder);
            gpu.queue.submit([encoder.finish()]);
        }
    }

    /// The texture to show. It changes with the size, and from drafts to pictures.
    pub fn texture(&self) -> Option<&wgpu::Texture> {
        self.shown().map(|canvas| &canvas.screen.texture)
    }

    /// Whether it is a draft that shows.
    pub fn shows_draft(&self) -> bool {
        self.shows_draft
    }

    /// Bytes of textures and buffers.
    pub fn bytes(&self) -> u64 {
        let canvases = self.draft.iter().chain(&self.fine);
        let drawn: u64 = canvases.map(|c| c.targets.bytes + c.sums.size()).sum();
        drawn + self.recoloring.bytes()
    }

    fn shown(&self) -> Option<&Canvas> {
        if self.shows_draft {
            self.draft.as_ref()
        } else {
            self.fine.as_ref()
        }
    }

    fn renderer(
        &mut self,
        gpu: &Gpu,
        source: &dyn VertexSource,
        samples: u32,
        params: &ViewParams,
    ) -> Result<usize, DeviceError> {
        let key = PipelineKey::new(source.key(), samples, &self.table, &params.look);
        let place = match self.renderers.iter().position(|p| p.fits(key)) {
            Some(place) => place,
            None => {
                self.renderers.push(TileRenderer::new(gpu, source, key)?);
                self.renderers.len() - 1
            }
        };
        let renderer = &mut self.renderers[place];
        if renderer.holds != self.tables {
            renderer.set_table(gpu, &self.table);
            renderer.holds = self.tables;
        }
        renderer.set_states(gpu, &self.states);
        if !self.finishers.iter().any(|(n, _)| *n == samples) {
            let finisher = Finisher::new(gpu, samples, Last::Accumulate);
            self.finishers.push((samples, finisher));
        }
        Ok(place)
    }

    fn make_canvas(
        &mut self,
        gpu: &Gpu,
        draft: bool,
        size: [u32; 2],
        samples: u32,
    ) -> Result<(), DeviceError> {
        let place = if draft {
            &mut self.draft
        } else {
            &mut self.fine
        };
        let fits = |c: &Canvas| c.size == size && c.samples == samples;
        if !place.as_ref().is_some_and(fits) {
            *place = None;
            *place = Some(Canvas::new(gpu, size, samples, draft));
            if !draft {
                self.occluded = None;
            }
            gpu.check()?;
        }
        Ok(())
    }
}
