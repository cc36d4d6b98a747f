//! Saves pictures of the scene.

use std::io::BufWriter;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use neurotess::output::{Output, OutputError};
use neurotess::refine::LodCriterion;
use neurotess::render::color::ColorTable;
use neurotess::render::overlay::{Legend, Overlay, OverlayOptions};
use neurotess::render::{
    AdaptiveSettings, BoundingSphere, Camera, Gpu, Image, Occlusion, PictureError, PictureOptions,
    PngWriter, StillRenderer, Viewpoint, Watch,
};

use crate::io::save::existing;
use crate::io::task::Progress;
use crate::model::document::Look;
use crate::model::film::FilmFrame;
use crate::model::playback::said;
use crate::model::save::PictureFile;
use crate::scene::colors::color_scheme;
use crate::scene::content::{self, SceneContent};

/// All that pictures are drawn from, for another thread.
pub(crate) struct StillScene {
    pub(crate) gpu: Arc<Gpu>,
    /// Whether a window draws with the same device.
    pub(crate) shared: bool,
    pub(crate) content: SceneContent,
    pub(crate) look: Look,
    pub(crate) states: Vec<u32>,
    pub(crate) spheres: Arc<Vec<BoundingSphere>>,
}

impl StillScene {
    /// Color table and legend of a picture, at its time of the recording if there is one.
    fn colors(&self, time: Option<f64>) -> Result<(ColorTable, Legend), String> {
        let (table, legend) = (&self.content.table, &self.content.legend);
        let (Some((recording, all)), Some(time)) = (&self.content.recording, time) else {
            return Ok((table.clone(), legend.clone()));
        };
        let time = recording.time.nearest(time);
        let instances = &self.content.instances;
        let shows = |place: usize| instances.get(place).is_none_or(|s| !s.hidden);
        let frame = recording.at(time, self.look.decay, &shows);
        let frame = frame.map_err(|e| e.to_string())?;
        let range = color_scheme(&self.look).range.unwrap_or(*all);
        let table = ColorTable {
            scale: table.scale.clone(),
            categories: table.categories.clone(),
            values: frame.values(range),
        };
        Ok((table, legend.clone().noted(&said(&recording.time, time))))
    }

    /// Legend and scale bar, in the same corners for all pictures.
    fn overlay(&self, film_frames: &[FilmFrame], options: &PictureFile) -> Result<Overlay, String> {
        let cameras: Vec<Camera> = film_frames
            .iter()
            .map(|film_frame| film_frame.view.camera())
            .collect();
        let (_, legend) =
            self.colors(film_frames.first().and_then(|film_frame| film_frame.time))?;
        let overlay = OverlayOptions {
            legend: self.look.legend.then_some(legend),
            scale_bar: self.look.scale_bar.then_some(0.0),
            background: (!options.transparent).then_some(self.look.background),
        };
        Ok(Overlay::new(
            &overlay,
            options.size,
            &cameras,
            &self.spheres,
        ))
    }
}

/// Writes pictures: one, or a numbered series.
pub(crate) fn pictures(
    still_scene: &StillScene,
    film_frames: &[FilmFrame],
    options: &PictureFile,
    progress: &Progress,
) -> Result<Vec<PathBuf>, String> {
    let stem = options
        .out
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let file = |i: usize| match film_frames.len() {
        1 => options.out.with_extension("png"),
        _ => options.out.with_file_name(format!("{stem}_{i:04}.png")),
    };
    let files: Vec<PathBuf> = (0..film_frames.len()).map(file).collect();
    let existing = existing(options.replace);
    for file in &files {
        existing.check(file).map_err(|e| e.to_string())?;
    }
    let own = own_gpu(still_scene)?;
    let gpu = &*own;
    let picture = picture_options(still_scene, options);
    let mut adaptive = content::adaptive(gpu, &still_scene.content, picture.sub_pixels(gpu))
        .map_err(|e| e.to_string())?;
    adaptive.set_settings(AdaptiveSettings {
        lod: LodCriterion::PixelError(0.25),
        wireframe: picture.look.wire > 0.0,
        ..Default::default()
    });
    if let Some(film_frame) = film_frames.first() {
        let tiles = picture.tiles(gpu, &film_frame.view.camera());
        progress
            .all
            .store(tiles * film_frames.len(), Ordering::Relaxed);
    }
    let mut renderer = StillRenderer::new();
    renderer.set_states(&still_scene.states);
    renderer.set_watch(Watch {
        tiles: Arc::clone(&progress.done),
        stopped: Arc::clone(&progress.canceled),
    });
    let overlay = still_scene.overlay(film_frames, options)?;
    for (number, (film_frame, file)) in film_frames.iter().zip(&files).enumerate() {
        let stopped = || format!("stopped after {number} of {} pictures", files.len());
        if progress.is_canceled() {
            return Err(stopped());
        }
        let camera = film_frame.view.camera();
        let (table, legend) = still_scene.colors(film_frame.time)?;
        let overlay = overlay.again(still_scene.look.legend.then_some(&legend), &camera);
        let mut picture = picture;
        picture.look.clip = content::clip(&still_scene.look, &still_scene.spheres);
        let near = camera.near(&still_scene.spheres);
        let broken = |e: std::io::Error| OutputError::broken(file, e).to_string();
        let mut output = Output::create(file, existing).map_err(|e| e.to_string())?;
        let to = BufWriter::new(output.file().try_clone().map_err(broken)?);
        let mut png = PngWriter::new(to, options.size, options.transparent).map_err(broken)?;
        let drawn = renderer.render(
            gpu,
            &mut adaptive,
            &Viewpoint { camera, near },
            &table,
            &picture,
            |top, mut band: Image| {
                overlay.lay_on(top, &mut band);
                png.write(&band)
            },
        );
        match drawn {
            Ok(_) => {}
            Err(PictureError::Stopped) => {
                // Dropping the device waits for its current tile: done on another thread.
                std::thread::spawn(move || drop((renderer, adaptive, own)));
                return Err(stopped());
            }
            Err(e) => return Err(e.to_string()),
        }
        png.finish().map_err(broken)?;
        output.finish().map_err(|e| e.to_string())?;
    }
    Ok(files)
}

/// The device for pictures: in software rendering another one than the window's, since the window
/// would have to wait for each tile. Tiles small enough not to be noticed would be mostly margins:
/// 850 of 640 sub-pixels instead of 12 for a picture of 1920 × 1440 with 16 samples, twelve times
/// the work.
fn own_gpu(still_scene: &StillScene) -> Result<Arc<Gpu>, String> {
    let gpu = &still_scene.gpu;
    if !still_scene.shared || !gpu.adapter.software {
        return Ok(Arc::clone(gpu));
    }
    let own = Gpu::open(Some(&gpu.adapter.name)).map_err(|e| e.to_string())?;
    Ok(Arc::new(own))
}

fn picture_options(still_scene: &StillScene, options: &PictureFile) -> PictureOptions {
    let look = &still_scene.look;
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
