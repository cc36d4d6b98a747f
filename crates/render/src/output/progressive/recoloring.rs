//! A static picture of the view that shows, made in short parts and then colored anew on the screen.
//!
//! A part is one step of a **band** of rows: the targets of a whole picture's color keys would take 112
//! bytes a pixel. Occlusion is that of the picture that was drawn last; if there is none, its first
//! step is drawn before, without being shown.

use crate::gpu::buffers::make;
use crate::gpu::device::Gpu;
use crate::gpu::device::samples_in_sub_pixel;
use crate::gpu::error::DeviceError;
use crate::output::static_picture::StaticPicture;
use crate::output::static_picture::collect::{Collector, Part, Wanted};
use crate::output::tiles::TilePass;
use crate::shading::finish::{BLUR, Finish};
use crate::sources::VertexSource;
use neurotess_picture::recolor::KeyColors;
use neurotess_picture::recolor::{MatrixBuilder, Weights};
use neurotess_picture::{Frame, Tile};

use super::step::{finish_uniform, offset, selected, shade};
use super::under_way::UnderWay;
use super::{ProgressiveRenderer, Steps, ViewParams};

/// Most pixels of a band.
const BAND_PIXELS: u32 = 1 << 18;
/// Most pixels of a picture that is made static: a list of weights must fit a binding.
const MAX_PIXELS: u64 = 1 << 24;

/// The static picture, or what is there of it.
#[derive(Default)]
pub(super) struct Recoloring {
    /// For each kind of source and its pipelines.
    collectors: Vec<Collector>,
    making: Option<Making>,
    made: Option<StaticPicture>,
    /// Whether `made` is what the fine picture shows.
    colored: bool,
}

/// A static picture that is being made.
struct Making {
    params: ViewParams,
    steps: Steps,
    collector: usize,
    renderer: usize,
    finish: wgpu::Buffer,
    /// First row of the current band, and its next step.
    top: u32,
    step: u32,
    /// Whether a step was submitted and is not read yet.
    submitted: bool,
    band: Weights,
    matrix: MatrixBuilder,
}

impl Making {
    /// Rows of the current band, and those with what occlusion is blurred over.
    fn rows(&self) -> ([u32; 2], [u32; 2]) {
        let [width, height] = self.params.size;
        let most = (BAND_PIXELS / width.max(1)).max(16);
        let bottom = (self.top + most).min(height);
        let around = [self.top.saturating_sub(BLUR), (bottom + BLUR).min(height)];
        ([self.top, bottom], around)
    }

    fn kept(&self) -> [u32; 2] {
        let ([top, bottom], _) = self.rows();
        [self.params.size[0], bottom - top]
    }
}

impl Recoloring {
    /// The static picture, if it is what shows.
    pub(super) fn colored(&self) -> Option<&StaticPicture> {
        self.made.as_ref().filter(|_| self.colored)
    }

    pub(super) fn bytes(&self) -> u64 {
        let making: u64 = self.collectors.iter().map(Collector::bytes).sum();
        making + self.made.as_ref().map_or(0, StaticPicture::bytes)
    }
}

impl ProgressiveRenderer {
    /// Begins a static picture of a view, which [`ProgressiveRenderer::static_slice`] then makes: the
    /// picture that `steps` give, but colored anew instead of drawn anew. Drafts may be drawn meanwhile.
    /// False if there can be none: of a wireframe, frozen levels, a source without color keys, or too
    /// many pixels.
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn begin_static(
        &mut self,
        gpu: &Gpu,
        source: &dyn VertexSource,
        params: &ViewParams,
        steps: Steps,
    ) -> Result<bool, DeviceError> {
        self.drop_static();
        let [width, height] = params.size.map(u64::from);
        // Selections for a frozen camera do not know what a band shows.
        let possible = params.look.wire <= 0.0 && params.frozen.is_none();
        if !possible || width * height > MAX_PIXELS {
            return Ok(false);
        }
        let samples = samples_in_sub_pixel(gpu, 4);
        let renderer = self.renderer(gpu, source, samples, params)?;
        let Some(collector) = self.collector(gpu, source, renderer, samples) else {
            return Ok(false);
        };
        self.make_canvas(gpu, false, params.size, samples)?;
        if self.occluded != Some(*params) {
            self.under_way = Some(UnderWay {
                hidden: true,
                ..UnderWay::new(*params, steps)
            });
        }
        let mut making = Making {
            params: *params,
            steps,
            collector,
            renderer,
            finish: make(
                gpu,
                "finish",
                size_of::<Finish>() as u64,
                wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            ),
            top: 0,
            step: 0,
            submitted: false,
            band: Weights::default(),
            matrix: MatrixBuilder::default(),
        };
        making.band = Weights::new(making.kept());
        self.recoloring.making = Some(making);
        Ok(true)
    }

    /// Makes the next part of the static picture. True once it is there. The part before must be done:
    /// see [`ProgressiveRenderer::is_busy`].
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn static_slice(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
    ) -> Result<bool, DeviceError> {
        if self.under_way.is_some_and(|way| way.hidden) {
            self.slice(gpu, source)?;
            return Ok(false);
        }
        let Some(mut making) = self.recoloring.making.take() else {
            return Ok(self.recoloring.made.is_some());
        };
        if making.submitted {
            self.read_part(gpu, &mut making)?;
        }
        if making.top < making.params.size[1] {
            self.submit_part(gpu, source, &mut making)?;
            self.recoloring.making = Some(making);
            return Ok(false);
        }
        let (look, background) = (&making.params.look, Some(making.params.background));
        let size = making.params.size;
        let made = StaticPicture::new(gpu, size, making.matrix.finish(), look, background)?;
        self.recoloring.collectors[making.collector].release(gpu);
        self.recoloring.made = Some(made);
        Ok(true)
    }

    /// Share of the static picture that is made, while it is being made.
    pub fn static_progress(&self) -> Option<f32> {
        let making = self.recoloring.making.as_ref()?;
        Some(making.top as f32 / making.params.size[1].max(1) as f32)
    }

    /// The static picture, once it is made.
    pub fn static_picture(&self) -> Option<&StaticPicture> {
        self.recoloring.made.as_ref()
    }

    /// Whether the static picture is what shows.
    pub fn is_recolored(&self) -> bool {
        self.recoloring.colored().is_some() && !self.shows_draft
    }

    /// Forgets the static picture, or what is there of it. What shows stays.
    pub fn drop_static(&mut self) {
        self.under_way = self.under_way.filter(|way| !way.hidden);
        self.recoloring.making = None;
        self.recoloring.made = None;
        self.recoloring.colored = false;
    }

    /// Shows the static picture in the current colors and states. `values`: as in [`KeyColors`]. Does
    /// nothing without one.
    ///
    /// # Errors
    /// What the device cannot do.
    ///
    /// # Panics
    /// If there are values, but not one for each of its keys.
    pub fn recolor(&mut self, gpu: &Gpu, values: Option<&[f32]>) -> Result<(), DeviceError> {
        let (Some(made), Some(canvas)) = (&self.recoloring.made, &self.fine) else {
            return Ok(());
        };
        let colors = KeyColors {
            table: &self.table,
            states: &self.states,
            values,
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        made.encode(gpu, &colors, &mut encoder);
        (self.recoloring.colored, self.shows_draft) = (true, false);
        self.present(gpu, canvas, &mut encoder);
        gpu.queue.submit([encoder.finish()]);
        self.clock.start(gpu);
        gpu.check()
    }

    fn collector(
        &mut self,
        gpu: &Gpu,
        source: &dyn VertexSource,
        renderer: usize,
        samples: u32,
    ) -> Option<usize> {
        let renderer = &self.renderers[renderer];
        let collectors = &mut self.recoloring.collectors;
        if let Some(place) = collectors.iter().position(|c| c.fits(renderer.key())) {
            return Some(place);
        }
        let (_, finisher) = self.finishers.iter().find(|(n, _)| *n == samples)?;
        let wanted = Wanted {
            key: renderer.key(),
            shade_layout: &renderer.shader.layout,
            finish_layout: &finisher.layout,
        };
        collectors.push(Collector::new(gpu, source, &wanted)?);
        Some(collectors.len() - 1)
    }

    /// Draws a band's step once as it is shown, for its depths, and once with its color keys.
    fn submit_part(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        making: &mut Making,
    ) -> Result<(), DeviceError> {
        let (params, steps) = (making.params, making.steps);
        let ([top, bottom], [first, end]) = making.rows();
        let [width, _] = params.size;
        let renderer = &self.renderers[making.renderer];
        let Some(canvas) = &self.fine else {
            return Ok(());
        };
        let place = offset(making.step, steps.steps);
        let group = renderer.shade_group(gpu);
        let whole = shade(renderer, &params).moved(steps.steps, place);
        gpu.queue
            .write_buffer(&renderer.shade, 0, bytemuck::bytes_of(&whole));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let rounds = source
            .prepare(gpu, &selected(&params, Some((first, end))))?
            .max(1);
        for round in 0..rounds {
            source.select(round, &mut encoder, None);
            let pass = TilePass {
                round,
                shaders: 0..usize::MAX,
                first: round == 0,
                last: round + 1 == rounds,
                within: Some([0, first, width, end - first]),
            };
            renderer.draw(source, &pass, &canvas.targets, &group, &mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);

        let band = Tile {
            x: 0,
            y: top as i32,
            width,
            height: bottom - top,
        };
        let of_band = shade(renderer, &params)
            .within(&band)
            .moved(steps.steps, place);
        gpu.queue
            .write_buffer(&renderer.shade, 0, bytemuck::bytes_of(&of_band));
        let frame = Frame::whole(params.camera, params.near, params.size);
        let finish = Finish {
            kept: making.kept(),
            spare: top,
            ..finish_uniform(&params, &frame, 0, steps.steps)
        };
        gpu.queue
            .write_buffer(&making.finish, 0, bytemuck::bytes_of(&finish));
        let Some(finish_group) = self.finish_group(gpu, making) else {
            return Ok(());
        };
        let part = Part {
            frame: &selected(&params, Some((top, bottom))),
            size: making.kept(),
            kept: making.kept(),
        };
        let collector = &mut self.recoloring.collectors[making.collector];
        collector.submit(gpu, source, &part, [&group, &finish_group])?;
        making.submitted = true;
        self.clock.start(gpu);
        Ok(())
    }

    /// Takes what was collected of a band's step, and goes on to the next.
    fn read_part(&mut self, gpu: &Gpu, making: &mut Making) -> Result<(), DeviceError> {
        let Some(group) = self.finish_group(gpu, making) else {
            return Ok(());
        };
        let collector = &mut self.recoloring.collectors[making.collector];
        let collected = collector.read(gpu, &group, making.kept())?;
        making.submitted = false;
        making.band.add([0, 0], &collected);
        making.step += 1;
        if making.step < making.steps.steps {
            return Ok(());
        }
        making.matrix.add(&making.band, making.steps.steps);
        (making.step, making.top) = (0, making.rows().0[1]);
        making.band = Weights::new(making.kept());
        Ok(())
    }

    fn finish_group(&self, gpu: &Gpu, making: &Making) -> Option<wgpu::BindGroup> {
        let canvas = self.fine.as_ref()?;
        let (_, finisher) = self.finishers.iter().find(|(n, _)| *n == canvas.samples)?;
        Some(canvas.group(gpu, finisher, &making.finish))
    }
}
