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
mod recoloring;
mod step;

use std::sync::Arc;
use std::sync::atomic::Ordering;

use crate::gpu::buffers::make;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::output::ids::Identifier;
use crate::output::options::{Occlusion, samples_in_sub_pixel};
use crate::output::static_picture::StaticPicture;
use crate::output::tiles::{TilePass, TileRenderer};
use crate::scene::color::{ColorTable, InstanceValues};
use crate::shading::finish::{Finish, Finisher, Last};
use crate::shading::present::{Outlines, Presenter};
use crate::shading::shade::PipelineKey;
use crate::sources::VertexSource;
use crate::sources::pick::PickIds;
use crate::view::frame::Frame;

use canvas::Canvas;
use clock::Clock;
use recoloring::Recoloring;
use step::{finish_uniform, offset, selected, shade};

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
    /// The view whose occlusion the fine canvas holds.
    occluded: Option<ViewParams>,
    recoloring: Recoloring,
    clock: Arc<Clock>,
}

/// How far a picture has come.
#[derive(Clone, Copy, Debug)]
struct UnderWay {
    params: ViewParams,
    steps: Steps,
    draft: bool,
    step: u32,
    slice: u32,
    /// Whether slices are bands of rows, each with a selection of its own.
    banded: bool,
    /// Whether it is drawn for its depths and occlusion alone, and only in its first step.
    hidden: bool,
}

impl UnderWay {
    fn new(params: ViewParams, steps: Steps) -> Self {
        Self {
            params,
            steps: Steps {
                slices: steps.slices.clamp(1, params.size[1].max(1)),
                steps: steps.steps.max(1),
            },
            draft: false,
            step: 0,
            slice: 0,
            banded: false,
            hidden: false,
        }
    }
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
        let way = UnderWay {
            params: ViewParams {
                occlusion: Occlusion::Off,
                ..*params
            },
            steps: Steps {
                steps: 1,
                slices: 1,
            },
            draft: true,
            step: 0,
            slice: 0,
            banded: false,
            hidden: false,
        };
        self.shows_draft = true;
        self.draw(gpu, source, renderer, &way)
    }

    /// Begins a picture, which [`ProgressiveRenderer::slice`] then draws.
    pub fn begin(&mut self, params: ViewParams, steps: Steps) {
        self.drop_static();
        self.occluded = None;
        self.under_way = Some(UnderWay::new(params, steps));
    }

    /// Draws no more of the picture under way. A static picture goes on.
    pub fn stop(&mut self) {
        self.under_way = self.under_way.filter(|way| way.hidden);
    }

    /// Share of the picture under way that has been drawn; none if no picture is under way.
    pub fn progress(&self) -> Option<f32> {
        let way = self.under_way?;
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
            lay_out(&mut way, rounds, source);
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

    /// Draws the ids of a picture for picking; [`ProgressiveRenderer::ids`] has them a little
    /// later.
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn identify(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        params: &ViewParams,
    ) -> Result<(), DeviceError> {
        let renderer = self.renderer(gpu, source, 1, params)?;
        let renderer = &self.renderers[renderer];
        if self.identifier.as_ref().is_none_or(|i| !i.fits(renderer)) {
            self.identifier = Identifier::new(gpu, renderer, source);
        }
        let Some(identifier) = &mut self.identifier else {
            return Ok(());
        };
        let shade = shade(renderer, params);
        identifier.draw(
            gpu,
            renderer,
            source,
            &selected(params, None),
            shade,
            params.size,
        )?;
        self.clock.start(gpu);
        Ok(())
    }

    /// The size of the picture that was identified last and its ids by row: given out once, and
    /// none before they have arrived.
    ///
    /// # Errors
    /// The device is lost.
    pub fn ids(&mut self) -> Result<Option<PickIds>, DeviceError> {
        self.identifier.as_mut().map_or(Ok(None), Identifier::take)
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

    /// Draws one slice of one step. The last slice also finishes the step.
    fn draw(
        &self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        renderer: usize,
        way: &UnderWay,
    ) -> Result<(), DeviceError> {
        let UnderWay { params, steps, .. } = way;
        let renderer = &self.renderers[renderer];
        let canvas = match way.draft {
            true => self.draft.as_ref(),
            false => self.fine.as_ref(),
        };
        let Some(canvas) = canvas else {
            return Ok(());
        };
        let [width, height] = params.size;
        let edge = |slice: u32, all: u32| {
            (u64::from(slice) * u64::from(all) / u64::from(steps.slices)) as u32
        };
        let slice = |all: u32| edge(way.slice, all)..edge(way.slice + 1, all);
        let (rows, shaders) = match way.banded {
            true => (slice(height), 0..usize::MAX),
            false => {
                let shaders = slice(source.shaders() as u32);
                (0..height, shaders.start as usize..shaders.end as usize)
            }
        };
        let place = offset(way.step, steps.steps);
        let shade = shade(renderer, params).moved(steps.steps, place);
        gpu.queue
            .write_buffer(&renderer.shade, 0, bytemuck::bytes_of(&shade));
        let group = renderer.shade_group(gpu);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let band = way.banded.then_some((rows.start, rows.end));
        let rounds = source.prepare(gpu, &selected(params, band))?.max(1);
        for round in 0..rounds {
            source.select(round, &mut encoder, None);
            let part = TilePass {
                round,
                shaders: shaders.clone(),
                first: way.slice == 0 && round == 0,
                last: way.slice + 1 == steps.slices && round + 1 == rounds,
                within: Some([0, rows.start, width, rows.end - rows.start]),
            };
            renderer.draw(source, &part, &canvas.targets, &group, &mut encoder);
        }
        if way.slice + 1 == steps.slices {
            self.finish(gpu, canvas, way, &mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
        self.clock.start(gpu);
        gpu.check()
    }

    fn finish(
        &self,
        gpu: &Gpu,
        canvas: &Canvas,
        way: &UnderWay,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let UnderWay {
            params,
            steps,
            step,
            ..
        } = way;
        let Some((_, finisher)) = self.finishers.iter().find(|(n, _)| *n == canvas.samples) else {
            return;
        };
        let frame = Frame::whole(params.camera, params.near, params.size);
        let uniform = finish_uniform(params, &frame, *step, steps.steps);
        gpu.queue
            .write_buffer(&self.finish, 0, bytemuck::bytes_of(&uniform));
        let group = canvas.group(gpu, finisher, &self.finish);
        // Steps lie within the same pixel, so occlusion is computed once for all of them.
        let occluded = uniform.radius > 0.0 && *step == 0;
        if occluded {
            finisher.begin(&canvas.targets, encoder);
        }
        let over = params.size.map(|n| n.div_ceil(8));
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("finish"),
            timestamp_writes: None,
        });
        pass.set_bind_group(0, &group, &[]);
        if occluded {
            let targets = &canvas.targets;
            finisher.find_blocks(gpu, targets, &mut pass);
            finisher.occlude(targets, &mut pass);
            finisher.blur(targets, &mut pass);
        }
        pass.set_pipeline(&finisher.last);
        pass.dispatch_workgroups(over[0], over[1], 1);
        drop(pass);
        if !way.hidden {
            self.present(gpu, canvas, encoder);
        }
    }

    /// Encodes writing the picture of a canvas into its texture.
    fn present(&self, gpu: &Gpu, canvas: &Canvas, encoder: &mut wgpu::CommandEncoder) {
        let fine = !self.shows_draft;
        let recolored = self.recoloring.colored().filter(|_| fine);
        let pixels = recolored.map_or(&canvas.targets.pixels, StaticPicture::pixels);
        let from = (pixels, &canvas.targets.normal);
        self.presenter
            .present(gpu, from, &canvas.screen, &self.outlines, encoder);
    }
}

/// Decides what the slices of a picture are. What is selected in one round is drawn shader by
/// shader, and is not selected again for every slice; with several `rounds` the picture is drawn in
/// bands of rows.
fn lay_out(way: &mut UnderWay, rounds: usize, source: &dyn VertexSource) {
    way.banded = rounds > 1 && way.steps.slices > 1;
    if !way.banded {
        way.steps.slices = way.steps.slices.min(source.shaders() as u32);
    } else if way.params.frozen.is_some() {
        // What a band of rows shows is not known to a selection for another camera.
        (way.banded, way.steps.slices) = (false, 1);
    }
}
