//! Pictures of what shows.

use std::io::BufWriter;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use neurotess::output::{Output, OutputError};
use neurotess::refine::LodCriterion;
use neurotess::render::{
    AdaptiveSettings, BoundingSphere, Camera, ColorTable, Gpu, Image, Legend, Occlusion, Overlay,
    OverlayOptions, PictureError, PictureOptions, PngWriter, StillRenderer, Watch,
};

use crate::io::save::existing;
use crate::io::tasks::Job;
use crate::model::document::Look;
use crate::model::film::Still;
use crate::model::playback::said;
use crate::model::save::PictureFile;
use crate::scene::colors::paint;
use crate::scene::content::{self, Shown};

/// All that pictures need to know, free of the window.
pub(crate) struct Scenery {
    pub(crate) gpu: Arc<Gpu>,
    /// Whether a window draws with it, too.
    pub(crate) shared: bool,
    pub(crate) shown: Shown,
    pub(crate) look: Look,
    pub(crate) states: Vec<u32>,
    pub(crate) balls: Vec<BoundingSphere>,
}

impl Scenery {
    /// Table and legend of a picture, at its time of a recording if one shows.
    fn colors(&self, time: Option<f64>) -> Result<(ColorTable, Legend), String> {
        let (table, legend) = (&self.shown.table, &self.shown.legend);
        let (Some((replay, all)), Some(time)) = (&self.shown.replay, time) else {
            return Ok((table.clone(), legend.clone()));
        };
        let time = replay.time.nearest(time);
        let standing = &self.shown.instances;
        let shows = |place: usize| standing.get(place).is_none_or(|s| !s.hidden);
        let moment = replay.at(time, self.look.decay, &shows);
        let moment = moment.map_err(|e| e.to_string())?;
        let range = paint(&self.look).range.unwrap_or(*all);
        let table = ColorTable {
            scale: table.scale.clone(),
            categories: table.categories.clone(),
            values: moment.values(range),
        };
        Ok((table, legend.clone().noted(&said(&replay.time, time))))
    }

    /// What stands in the corners, the same ones for all pictures.
    fn overlay(&self, stills: &[Still], options: &PictureFile) -> Result<Overlay, String> {
        let cameras: Vec<Camera> = stills.iter().map(|still| still.view.camera()).collect();
        let (_, legend) = self.colors(stills.first().and_then(|still| still.time))?;
        let overlay = OverlayOptions {
            legend: self.look.legend.then_some(legend),
            scale_bar: self.look.scale_bar.then_some(0.0),
            background: (!options.transparent).then_some(self.look.background),
        };
        Ok(Overlay::new(&overlay, options.size, &cameras, &self.balls))
    }
}

/// Writes pictures: one, or a numbered series.
pub(crate) fn pictures(
    scenery: &Scenery,
    stills: &[Still],
    options: &PictureFile,
    job: &Job,
) -> Result<Vec<PathBuf>, String> {
    let stem = options
        .out
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let file = |i: usize| match stills.len() {
        1 => options.out.with_extension("png"),
        _ => options.out.with_file_name(format!("{stem}_{i:04}.png")),
    };
    let files: Vec<PathBuf> = (0..stills.len()).map(file).collect();
    let existing = existing(options.replace);
    for file in &files {
        existing.check(file).map_err(|e| e.to_string())?;
    }
    let own = own_gpu(scenery)?;
    let gpu = &*own;
    let picture = picture_options(scenery, options);
    let mut maker =
        content::maker(gpu, &scenery.shown, picture.sub_pixels(gpu)).map_err(|e| e.to_string())?;
    maker.set_settings(AdaptiveSettings {
        lod: LodCriterion::PixelError(0.25),
        wireframe: picture.look.wire > 0.0,
        ..Default::default()
    });
    if let Some(still) = stills.first() {
        let tiles = picture.tiles(gpu, &still.view.camera());
        job.all.store(tiles * stills.len(), Ordering::Relaxed);
    }
    let mut studio = StillRenderer::new();
    studio.set_states(&scenery.states);
    studio.set_watch(Watch {
        tiles: Arc::clone(&job.done),
        stopped: Arc::clone(&job.canceled),
    });
    let overlay = scenery.overlay(stills, options)?;
    for (number, (still, file)) in stills.iter().zip(&files).enumerate() {
        let stopped = || format!("stopped after {number} of {} pictures", files.len());
        if job.is_canceled() {
            return Err(stopped());
        }
        let camera = still.view.camera();
        let (table, legend) = scenery.colors(still.time)?;
        let overlay = overlay.again(scenery.look.legend.then_some(&legend), &camera);
        let mut picture = picture;
        picture.look.clip = content::clip(&scenery.look, &scenery.balls);
        let near = camera.near(&scenery.balls);
        let broken = |e: std::io::Error| OutputError::broken(file, e).to_string();
        let mut output = Output::create(file, existing).map_err(|e| e.to_string())?;
        let to = BufWriter::new(output.file().try_clone().map_err(broken)?);
        let mut png = PngWriter::new(to, options.size, options.transparent).map_err(broken)?;
        let painted = studio.paint(
            gpu,
            &mut maker,
            &camera,
            near,
            &table,
            &picture,
            |top, mut band: Image| {
                overlay.lay_on(top, &mut band);
                png.write(&band)
            },
        );
        match painted {
            Ok(_) => {}
            Err(PictureError::Stopped) => {
                // The device ends its tile before it goes; nobody waits for that.
                std::thread::spawn(move || drop((studio, maker, own)));
                return Err(stopped());
            }
            Err(e) => return Err(e.to_string()),
        }
        png.finish().map_err(broken)?;
        output.finish().map_err(|e| e.to_string())?;
    }
    Ok(files)
}

/// In software, a device of its own: what is given to the window's would hold the window up for as long as
/// a tile takes. Tiles that were small enough for that are mostly margins: 850 of 640 sub-pixels instead of
/// 12 for a picture of 1920 × 1440 with 16 samples, twelve times the work.
fn own_gpu(scenery: &Scenery) -> Result<Arc<Gpu>, String> {
    let gpu = &scenery.gpu;
    if !scenery.shared || !gpu.adapter.software {
        return Ok(Arc::clone(gpu));
    }
    let own = Gpu::open(Some(&gpu.adapter.name)).map_err(|e| e.to_string())?;
    Ok(Arc::new(own))
}

fn picture_options(scenery: &Scenery, options: &PictureFile) -> PictureOptions {
    let look = &scenery.look;
    PictureOptions {
        size: options.size,
        samples: options.samples,
        background: (!options.transparent).then_some(look.background),
        look: content::surface_look(look),
        occlusion: if look.occlusion {
            Occlusion::Fit
        } else {
            Occlusion::Off
        },
        ..PictureOptions::default()
    }
}
