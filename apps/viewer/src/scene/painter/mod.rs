//! Who draws pictures that are saved: the processor, or a graphics adapter.
//!
//! Software adapters draw the same pictures as the processor, in several times its time.

mod adapter;
mod processor;

use std::io;

use neurotess::drawing::Recolored;
use neurotess::picture::color::ColorTable;
use neurotess::picture::{AdaptiveSettings, Image, PictureOptions, Viewpoint, Watch};
use neurotess::raster;
use neurotess::refine::LodCriterion;

use adapter::Adapter;
use processor::Processor;

use crate::scene::still_scene::StillScene;

pub(super) use processor::{Beside, of_view};

/// What draws the pictures of a scene.
pub(super) enum Painter<'a> {
    Processor(Processor<'a>),
    Adapter(Box<Adapter>),
}

/// Why a picture is not there.
pub(super) enum Unmade {
    Stopped,
    Failed(String),
}

/// Takes bands of a picture: the first row of each, and its pixels.
pub(super) type Take<'a> = &'a mut dyn FnMut(u32, Image) -> io::Result<()>;

impl<'a> Painter<'a> {
    /// The scene's adapter, or else the processor. `beside`: [`Beside::new`] of the same scene.
    ///
    /// # Errors
    /// A message: the adapter reports an error, or the scene is not valid.
    pub(super) fn new(
        scene: &'a StillScene,
        beside: &'a Beside,
        options: &PictureOptions,
        watch: Watch,
    ) -> Result<Self, String> {
        Ok(match &scene.gpu {
            Some(gpu) => Self::Adapter(Box::new(Adapter::new(gpu, scene, options, watch)?)),
            None => Self::Processor(Processor::new(scene, beside, refined(options), watch)?),
        })
    }

    /// Number of tiles or bands of a picture, as the watch counts them.
    pub(super) fn parts(&mut self, view: &Viewpoint, options: &PictureOptions) -> usize {
        match self {
            Self::Processor(_) => raster::bands(view, options),
            Self::Adapter(adapter) => adapter.tiles(view, options),
        }
    }

    /// Draws a picture; `take` gets its bands from the top.
    pub(super) fn draw(
        &mut self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
        take: Take<'_>,
    ) -> Result<(), Unmade> {
        match self {
            Self::Processor(processor) => processor.draw(view, table, options, take),
            Self::Adapter(adapter) => adapter.draw(view, table, options, take),
        }
    }

    /// Draws a picture that can be colored anew; none if this one cannot.
    pub(super) fn draw_static(
        &mut self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
    ) -> Result<Option<Recolored>, Unmade> {
        match self {
            Self::Processor(processor) => processor.draw_static(view, table, options),
            Self::Adapter(adapter) => adapter.draw_static(view, table, options),
        }
    }
}

/// How cells are refined: within a quarter of a pixel.
fn refined(options: &PictureOptions) -> AdaptiveSettings {
    AdaptiveSettings {
        lod: LodCriterion::PixelError(0.25),
        wireframe: options.look.wire > 0.0,
        ..AdaptiveSettings::default()
    }
}
