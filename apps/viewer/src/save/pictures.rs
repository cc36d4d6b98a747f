//! Pictures of what shows.

use std::io::BufWriter;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use neurotess::output::{Output, OutputError};
use neurotess::render::{
    Ball, Choice, Gpu, Image, Occlusion, Overlay, OverlayOptions, PictureOptions, PngWriter,
    Refining, Studio,
};

use super::existing;
use crate::document::Look;
use crate::scene::{self, Shown};
use crate::view::View;
use crate::worker::Job;

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureFile {
    /// Its file.
    pub out: PathBuf,
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Samples of a pixel.
    pub samples: u32,
    /// Without a background.
    pub transparent: bool,
    /// Whether the file may be replaced.
    pub replace: bool,
}

/// All that pictures need to know, free of the window.
pub(crate) struct Scenery {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) shown: Shown,
    pub(crate) look: Look,
    pub(crate) states: Vec<u32>,
    pub(crate) balls: Vec<Ball>,
}

/// Writes pictures of views: one, or a numbered series.
pub(crate) fn pictures(
    scenery: &Scenery,
    views: &[View],
    options: &PictureFile,
    job: &Job,
) -> Result<Vec<PathBuf>, String> {
    let stem = options
        .out
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let file = |i: usize| match views.len() {
        1 => options.out.with_extension("png"),
        _ => options.out.with_file_name(format!("{stem}_{i:04}.png")),
    };
    let files: Vec<PathBuf> = (0..views.len()).map(file).collect();
    let existing = existing(options.replace);
    for file in &files {
        existing.check(file).map_err(|e| e.to_string())?;
    }
    let gpu = &*scenery.gpu;
    let picture = picture_options(scenery, options);
    let mut maker =
        scene::maker(gpu, &scenery.shown, picture.sub_pixels(gpu)).map_err(|e| e.to_string())?;
    maker.set_refining(Refining {
        choice: Choice::PixelError(0.25),
        wires: picture.look.wire > 0.0,
        ..Default::default()
    });
    let mut studio = Studio::new();
    studio.set_states(&scenery.states);
    for (view, file) in views.iter().zip(&files) {
        if job.is_cancelled() {
            return Err("stopped".into());
        }
        let camera = view.camera();
        let mut picture = picture;
        picture.look.clip = scene::clip(&scenery.look, &scenery.balls);
        let overlay = OverlayOptions {
            legend: scenery
                .look
                .legend
                .then(|| scenery.shown.colouring.legend.clone()),
            scale_bar: scenery.look.scale_bar.then_some(0.0),
            background: picture.background,
        };
        let overlay = Overlay::new(&overlay, options.size, &[camera], &scenery.balls);
        let near = camera.near(&scenery.balls);
        let broken = |e: std::io::Error| OutputError::broken(file, e).to_string();
        let mut output = Output::create(file, existing).map_err(|e| e.to_string())?;
        let to = BufWriter::new(output.file().try_clone().map_err(broken)?);
        let mut png = PngWriter::new(to, options.size, options.transparent).map_err(broken)?;
        let table = &scenery.shown.colouring.table;
        let painted = studio.paint(
            gpu,
            &mut maker,
            &camera,
            near,
            table,
            &picture,
            |top, mut band: Image| {
                overlay.lay_on(top, &mut band);
                png.write(&band)
            },
        );
        painted.map_err(|e| e.to_string())?;
        png.finish().map_err(broken)?;
        output.finish().map_err(|e| e.to_string())?;
        job.done.fetch_add(1, Ordering::Relaxed);
    }
    Ok(files)
}

/// Tiles are small: the window draws between them.
const TILE: u32 = 640;

fn picture_options(scenery: &Scenery, options: &PictureFile) -> PictureOptions {
    let look = &scenery.look;
    PictureOptions {
        size: options.size,
        samples: options.samples,
        background: (!options.transparent).then_some(look.background),
        look: scene::surface_look(look),
        occlusion: if look.occlusion {
            Occlusion::Fit
        } else {
            Occlusion::Off
        },
        tile: if scenery.gpu.adapter.software {
            TILE
        } else {
            4 * TILE
        },
    }
}
