//! Pictures of any size, tile by tile, band by band.
//!
//! A picture is drawn in **tiles** that fit the device and handed over in **bands**: the rows of
//! pixels that one row of tiles covers. Memory is for one tile and one band, whatever the picture's
//! size. Tiles overlap by the reach of ambient occlusion, so that they fit together.

use std::time::Instant;

use thiserror::Error;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::timing::PASSES;
use crate::output::image::Image;
use crate::output::static_picture::StaticPicture;
use crate::output::static_picture::matrix::{MatrixBuilder, Weights};
use crate::output::tiles::{Finishing, TileRenderer};
use crate::output::watch::Watch;
use crate::scene::color::{ColorTable, Rgb};
use crate::shading::finish::BLUR;
use crate::shading::shade::{GUARD, Look, PipelineKey};
use crate::sources::VertexSource;
use crate::view::camera::Camera;
use crate::view::frame::{Frame, Tile};

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureOptions {
    /// Width and height (pixels), from 1 on.
    pub size: [u32; 2],
    /// Samples of a pixel: 1, 4, 16, 36 or 64.
    pub samples: u32,
    /// Color behind everything; none: transparent.
    pub background: Option<Rgb>,
    /// Light and wireframe.
    pub look: Look,
    /// Ambient occlusion, which darkens corners.
    pub occlusion: Occlusion,
    /// Greatest width and height of a tile (sub-pixels).
    pub tile: u32,
}

/// Ambient occlusion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Occlusion {
    /// Within 8 % of the picture's height, at the distance of the camera's target.
    #[default]
    Fit,
    /// Within this distance (µm), at most 9 % of the picture's height and 360 sub-pixels.
    Within(f32),
    /// None.
    Off,
}

impl Occlusion {
    /// Radius of occlusion in a picture of this height (sub-pixels): µm, and the most sub-pixels.
    /// It does not depend on tiles, so that they fit together.
    pub(crate) fn reach(self, camera: &Camera, height: u32) -> Option<(f32, f32)> {
        let height = f64::from(height);
        let sub_pixel = camera.pixel_at_target(height);
        let most = (0.09 * height).min(MOST_MARGIN).ceil();
        let radius = match self {
            Self::Fit => 0.08 * height * sub_pixel,
            Self::Within(radius) => f64::from(radius),
            Self::Off => 0.0,
        };
        (radius > 0.0).then_some((radius as f32, most as f32))
    }
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            size: [1280, 960],
            samples: 16,
            background: Some([255, 255, 255]),
            look: Look::default(),
            occlusion: Occlusion::Fit,
            tile: TILE,
        }
    }
}

/// Greatest width and height of a tile by default: with four samples of a sub-pixel, which take 104
/// bytes, 240 MiB.
const TILE: u32 = 1536;
/// Greatest reach (sub-pixels) of ambient occlusion: with more, margins would take up most of a
/// tile.
const MOST_MARGIN: f64 = 360.0;
/// Numbers of samples that a pixel can have.
pub const SAMPLES: [u32; 5] = [1, 4, 16, 36, 64];
/// Greatest width or height of a picture: positions are f32 and keep 1/256 of a sub-pixel.
pub const LARGEST: u32 = 32_768;

/// Why a picture was not made.
#[derive(Debug, Error)]
pub enum PictureError<E> {
    /// The device reports an error.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The function that takes the bands returned an error.
    #[error("{0}")]
    Sink(E),
    /// It was stopped by a [`Watch`].
    #[error("stopped")]
    Stopped,
}

/// The time and memory that a picture took.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cost {
    /// Milliseconds from the first command to the last byte.
    pub cpu_ms: f64,
    /// Milliseconds by pass, if the GPU supports timestamps.
    pub gpu_ms: Option<Vec<(&'static str, f64)>>,
    /// Number of tiles.
    pub tiles: usize,
    /// Bytes of the textures and buffers that a tile is drawn into and finished in.
    pub target_bytes: u64,
}

/// How a picture is divided into tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Parting {
    /// Sub-pixels per pixel along a side.
    scale: u32,
    /// Samples of a sub-pixel.
    samples: u32,
    /// Sub-pixels around a tile.
    margin: u32,
    /// Pixels kept of a tile.
    step: [u32; 2],
    /// Radius of occlusion: µm, and most sub-pixels.
    occlusion: Option<(f32, f32)>,
}

impl Parting {
    fn finishing(&self, options: &PictureOptions) -> Finishing {
        Finishing {
            scale: self.scale,
            margin: self.margin,
            occlusion: self.occlusion,
            background: options.background,
        }
    }

    /// The frame of the tile whose upper left pixel is at `[left, top]` of a picture of this size.
    fn frame(&self, view: &Viewpoint, size: [u32; 2], [left, top]: [u32; 2]) -> Frame {
        let Self {
            scale,
            margin,
            step,
            ..
        } = *self;
        let place = |n: u32| (n * scale) as i32 - margin as i32;
        Frame {
            camera: view.camera,
            near: view.near,
            size: size.map(|n| n * scale),
            tile: Tile {
                x: place(left),
                y: place(top),
                width: step[0] * scale + 2 * margin,
                height: step[1] * scale + 2 * margin,
            },
        }
    }
}

impl PictureOptions {
    /// Number of samples that a pixel gets: the greatest possible number that is not above
    /// `samples`.
    pub fn samples_taken(&self) -> u32 {
        let most = SAMPLES.into_iter().rfind(|&n| n <= self.samples);
        most.unwrap_or(1)
    }

    /// Number of sub-pixels along a pixel's side.
    pub fn sub_pixels(&self, gpu: &Gpu) -> u32 {
        let in_each = f64::from(samples_in_sub_pixel(gpu, self.samples_taken()));
        ((f64::from(self.samples_taken()) / in_each).sqrt() as u32).max(1)
    }

    /// Number of tiles of a picture.
    pub fn tiles(&self, gpu: &Gpu, camera: &Camera) -> usize {
        let Parting { step, .. } = self.parting(gpu, camera);
        let [across, down] = [0, 1].map(|k| self.size[k].max(1).div_ceil(step[k]));
        across as usize * down as usize
    }

    fn parting(&self, gpu: &Gpu, camera: &Camera) -> Parting {
        let samples = self.samples_taken();
        let scale = self.sub_pixels(gpu);
        let height = self.size[1] * scale;
        let largest = self.tile.min(gpu.largest_texture() - 2 * GUARD as u32);
        let occlusion = self.occlusion.reach(camera, height);
        let margin = occlusion
            .map_or(0, |(_, most)| most as u32 + BLUR + 2)
            .next_multiple_of(scale);
        let inner = (largest.saturating_sub(2 * margin) / scale).max(32);
        Parting {
            scale,
            samples: samples_in_sub_pixel(gpu, samples),
            margin,
            step: self.size.map(|n| inner.min(n.max(1))),
            occlusion,
        }
    }
}

/// Number of samples of a sub-pixel: four; or one if a pixel has only one sample, and on OpenGL,
/// for which naga 30 translates sample masks wrongly.
pub(crate) fn samples_in_sub_pixel(gpu: &Gpu, samples: u32) -> u32 {
    if samples == 1 || gpu.adapter.backend == "gl" {
        1
    } else {
        4
    }
}

/// Draws one picture: see [`StillRenderer::render`].
///
/// # Errors
/// The device reports an error, or `take` returns one.
pub fn render_still<E>(
    gpu: &Gpu,
    source: &mut dyn VertexSource,
    view: &Viewpoint,
    table: &ColorTable,
    options: &PictureOptions,
    take: impl FnMut(u32, Image) -> Result<(), E>,
) -> Result<Cost, PictureError<E>> {
    StillRenderer::new().render(gpu, source, view, table, options, take)
}

/// The view that a picture is drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// The camera.
    pub camera: Camera,
    /// Depth (µm) of the near plane: [`Camera::near`]'s, which without perspective is negative.
    pub near: f64,
}

/// Draws pictures one after the other. Keeps pipelines and targets, so that a series of pictures
/// makes them once.
#[derive(Default)]
pub struct StillRenderer {
    renderers: Vec<TileRenderer>,
    states: Vec<u32>,
    watch: Option<Watch>,
}

impl StillRenderer {
    /// A renderer without pipelines: the first picture makes them.
    pub fn new() -> Self {
        Self::default()
    }

    /// States of instances in the scene's order, [`HIGHLIGHTED`](crate::state::HIGHLIGHTED) and so
    /// on; 0 for instances beyond the end.
    pub fn set_states(&mut self, states: &[u32]) {
        self.states = states.to_vec();
    }

    /// Sets the watch that counts finished tiles, and by which pictures can be stopped.
    pub fn set_watch(&mut self, watch: Watch) {
        self.watch = Some(watch);
    }

    fn renderer(
        &mut self,
        gpu: &Gpu,
        source: &dyn VertexSource,
        table: &ColorTable,
        options: &PictureOptions,
        parting: &Parting,
    ) -> Result<&mut TileRenderer, DeviceError> {
        let key = PipelineKey::new(source.key(), parting.samples, table, &options.look);
        let place = match self.renderers.iter().position(|p| p.fits(key)) {
            Some(place) => place,
            None => {
                self.renderers.push(TileRenderer::new(gpu, source, key)?);
                self.renderers.len() - 1
            }
        };
        let renderer = &mut self.renderers[place];
        renderer.set_states(gpu, &self.states);
        renderer.set_table(gpu, table);
        Ok(renderer)
    }

    /// Draws a picture and calls `take` with its bands from the top: the first row of each, and its
    /// pixels.
    ///
    /// # Errors
    /// The device reports an error, `take` returns one, or the watch has stopped the picture.
    pub fn render<E>(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
        mut take: impl FnMut(u32, Image) -> Result<(), E>,
    ) -> Result<Cost, PictureError<E>> {
        let clock = Instant::now();
        let parting = options.parting(gpu, &view.camera);
        let step = parting.step;
        let watch = self.watch.clone();
        let renderer = self.renderer(gpu, source, table, options, &parting)?;
        renderer.timer.reset();
        let finishing = parting.finishing(options);
        let [width, height] = options.size.map(|n| n.max(1));
        let mut tiles = 0;
        for top in (0..height).step_by(step[1] as usize) {
            let rows = step[1].min(height - top);
            let mut band = Image::new(width, rows);
            for left in (0..width).step_by(step[0] as usize) {
                let frame = parting.frame(view, [width, height], [left, top]);
                let watch = watch.as_ref();
                if watch.is_some_and(Watch::is_stopped) {
                    return Err(PictureError::Stopped);
                }
                let look = &options.look;
                let pixels = renderer.render(gpu, source, &frame, look, &finishing, watch)?;
                let Some(pixels) = pixels else {
                    return Err(PictureError::Stopped);
                };
                band.copy_from(left, &pixels, step[0]);
                watch.into_iter().for_each(Watch::note_tile);
                tiles += 1;
            }
            take(top, band).map_err(PictureError::Sink)?;
        }
        let times = renderer.timer.milliseconds();
        Ok(Cost {
            cpu_ms: clock.elapsed().as_secs_f64() * 1e3,
            gpu_ms: times.map(|times| PASSES.into_iter().zip(times).collect()),
            tiles,
            target_bytes: renderer.target_bytes(),
        })
    }

    /// Makes a picture that can be colored anew, with the pixels that [`StillRenderer::render`]
    /// gives. `table`: colors, of which only those of the [`StaticPicture`] matter.
    ///
    /// # Errors
    /// The device reports an error; the watch has stopped the picture; or the picture cannot be
    /// colored anew, since it has a wireframe or the source does not support it.
    pub fn render_static(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
    ) -> Result<StaticPicture, StaticError> {
        if options.look.wire > 0.0 {
            return Err(StaticError::Wireframe);
        }
        let parting = options.parting(gpu, &view.camera);
        let watch = self.watch.clone();
        let renderer = self.renderer(gpu, source, table, options, &parting)?;
        let collector = renderer.collector(gpu, source);
        let mut collector = collector.ok_or(StaticError::Source)?;
        let finishing = parting.finishing(options);
        let size = options.size.map(|n| n.max(1));
        let step = parting.step.map(|n| n as usize);
        let mut matrix = MatrixBuilder::default();
        for top in (0..size[1]).step_by(step[1]) {
            let mut band = Weights::new([size[0], parting.step[1].min(size[1] - top)]);
            for left in (0..size[0]).step_by(step[0]) {
                if watch.as_ref().is_some_and(Watch::is_stopped) {
                    return Err(StaticError::Stopped);
                }
                let frame = parting.frame(view, size, [left, top]);
                let look = &options.look;
                let collected =
                    renderer.collect(gpu, source, &frame, look, &finishing, &mut collector)?;
                if let Some(collected) = collected {
                    band.add([left, 0], &collected);
                }
                watch.iter().for_each(Watch::note_tile);
            }
            matrix.add(&band, 1);
        }
        let (look, background) = (&options.look, options.background);
        let matrix = matrix.finish();
        Ok(StaticPicture::new(gpu, size, matrix, look, background)?)
    }
}

/// Why a static picture was not made.
#[derive(Debug, Error)]
pub enum StaticError {
    /// The device reports an error.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// Lines of a wireframe have colors of their own.
    #[error("a picture with a wireframe cannot be colored anew")]
    Wireframe,
    /// The source has no color keys to look up.
    #[error("a picture of a surface that was refined beforehand cannot be colored anew")]
    Source,
    /// It was stopped by a [`Watch`].
    #[error("stopped")]
    Stopped,
}
