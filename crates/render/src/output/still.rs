//! Pictures of any size, tile by tile, band by band.
//!
//! A picture is drawn in **tiles** that fit the device and handed over in **bands**: the rows of
//! pixels that one row of tiles covers, and empty ones beside them. Memory is for one tile and one band, whatever the picture's
//! size. Tiles overlap by the reach of ambient occlusion, so that they fit together. Where nothing shows there
//! are none.

use std::time::Instant;

use thiserror::Error;

use crate::gpu::device::Gpu;
use crate::gpu::device::samples_in_sub_pixel;
use crate::gpu::error::DeviceError;
use crate::gpu::timing::PASSES;
use crate::output::static_picture::StaticPicture;
use crate::output::tiles::TileRenderer;
use crate::output::tiling::Tiling;
use crate::shading::shade::PipelineKey;
use crate::sources::VertexSource;
use neurotess_picture::Image;
use neurotess_picture::Watch;
use neurotess_picture::color::ColorTable;
use neurotess_picture::recolor::{MatrixBuilder, Weights};
use neurotess_picture::{PictureOptions, Viewpoint};

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
    ) -> Result<&mut TileRenderer, DeviceError> {
        let samples = samples_in_sub_pixel(gpu, options.samples_taken());
        let key = PipelineKey::new(source.key(), samples, table, &options.look);
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
        let tiling = Tiling::new(gpu, &*source, view, options);
        let watch = self.watch.clone();
        let renderer = self.renderer(gpu, source, table, options)?;
        renderer.timer.reset();
        let finishing = tiling.finishing(options);
        let empty = finishing.empty_pixel();
        for band in tiling.bands() {
            let rows = band.rows.len() as u32;
            let mut image = Image::filled(options.size[0].max(1), rows, empty);
            for (place, tile) in tiling.tiles(&band) {
                let watch = watch.as_ref();
                if watch.is_some_and(Watch::is_stopped) {
                    return Err(PictureError::Stopped);
                }
                let look = &options.look;
                let pixels = renderer.render(gpu, source, &tile, look, &finishing, watch)?;
                let Some(pixels) = pixels else {
                    return Err(PictureError::Stopped);
                };
                image.copy_from(place, &pixels, tile.kept[0]);
                watch.into_iter().for_each(Watch::note_tile);
            }
            take(band.rows.start, image).map_err(PictureError::Sink)?;
        }
        let times = renderer.timer.milliseconds();
        Ok(Cost {
            cpu_ms: clock.elapsed().as_secs_f64() * 1e3,
            gpu_ms: times.map(|times| PASSES.into_iter().zip(times).collect()),
            tiles: tiling.len(),
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
        let tiling = Tiling::new(gpu, &*source, view, options);
        let watch = self.watch.clone();
        let renderer = self.renderer(gpu, source, table, options)?;
        let collector = renderer.collector(gpu, source);
        let mut collector = collector.ok_or(StaticError::Source)?;
        let finishing = tiling.finishing(options);
        let size = options.size.map(|n| n.max(1));
        let mut matrix = MatrixBuilder::default();
        for band in tiling.bands() {
            let mut weights = Weights::new([size[0], band.rows.len() as u32]);
            for (place, tile) in tiling.tiles(&band) {
                if watch.as_ref().is_some_and(Watch::is_stopped) {
                    return Err(StaticError::Stopped);
                }
                let look = &options.look;
                let collected =
                    renderer.collect(gpu, source, &tile, look, &finishing, &mut collector)?;
                if let Some(collected) = collected {
                    weights.add(place, &collected);
                }
                watch.iter().for_each(Watch::note_tile);
            }
            matrix.add(&weights, 1);
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
