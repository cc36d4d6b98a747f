//! Saves pictures of the scene.

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use itertools::Itertools;
use neurotess::output::{Output, OutputError};
use neurotess::refine::LodCriterion;
use neurotess::render::color::ColorTable;
use neurotess::render::{
    Adaptive, AdaptiveSettings, BoundingSphere, Combined, Gpu, Image, MarkerSettings, Markers,
    Meshes, Occlusion, PictureError, PictureOptions, PngWriter, StaticError, StillRenderer,
    Viewpoint, Watch, tiles,
};

use crate::io::background::spawn;
use crate::io::save::existing;
use crate::io::task::{Progress, caught};
use crate::model::film::FilmFrame;
use crate::model::save::PictureFile;
use crate::model::targets::film_files;
use crate::scene::content;
use crate::scene::film;
use crate::scene::markers::settings;
use crate::scene::meshes;

pub(crate) use crate::scene::still_scene::StillScene;

/// Writes pictures: one, or a numbered series.
pub(crate) fn pictures(
    still_scene: &Arc<StillScene>,
    film_frames: &[FilmFrame],
    options: &PictureFile,
    progress: &Progress,
) -> Result<Vec<PathBuf>, String> {
    let files = film_files(&options.out, film_frames.len());
    let existing = existing(options.replace);
    for file in &files {
        existing.check(file).map_err(|e| e.to_string())?;
    }
    let Prepared {
        own,
        mut adaptive,
        mut markers,
        mut meshes,
        mut renderer,
        picture,
    } = prepared(still_scene, film_frames, options, progress)?;
    let gpu = &*own;
    let spheres = still_scene.spheres.iter().chain(&still_scene.around);
    let around: Vec<BoundingSphere> = spheres.copied().collect();
    renderer.set_states(&still_scene.states);
    renderer.set_watch(Watch {
        tiles: Arc::clone(&progress.done),
        stopped: Arc::clone(&progress.canceled),
    });
    let overlay = still_scene.overlay(film_frames, options);
    let mut film = None;
    // Of the first picture; others may have more or fewer.
    let mut count = 0;
    for (number, (film_frame, file)) in film_frames.iter().zip_eq(&files).enumerate() {
        let stopped = || format!("stopped after {number} of {} pictures", files.len());
        if progress.is_canceled() {
            return Err(stopped());
        }
        let camera = film_frame.view.camera();
        let legend = still_scene.legend(film_frame.time, options.size);
        let overlay = overlay.again(still_scene.look.legend.then_some(&legend), &camera);
        let near = camera.near(&around);
        let view = Viewpoint { camera, near };
        let broken = |e: io::Error| OutputError::broken(file, e).to_string();
        let mut output = Output::create(file, existing).map_err(|e| e.to_string())?;
        let to = BufWriter::new(output.file().try_clone().map_err(broken)?);
        let mut png = PngWriter::new(to, options.size, options.transparent).map_err(broken)?;
        let annotations = still_scene.annotations(&camera, options);
        let mut lay = |top: u32, mut band: Image| {
            annotations.lay_on(top, &mut band);
            overlay.lay_on(top, &mut band);
            write(&mut png, &band, progress)
        };
        let table = match &film {
            Some(_) => ColorTable::default(),
            None => still_scene.table(film_frame.time)?,
        };
        if number == 0 {
            let source = Combined::new(&mut adaptive)
                .with_markers(markers.as_mut())
                .with_meshes(meshes.as_mut());
            count = tiles(gpu, &source, &view, &picture);
            let all = count * film_frames.len();
            progress.all.store(all, Ordering::Relaxed);
        }
        let mut drawn = Ok(());
        if number == 0 && film::is_static(still_scene, film_frames, options) {
            let mut source = Combined::new(&mut adaptive)
                .with_markers(markers.as_mut())
                .with_meshes(meshes.as_mut());
            match renderer.render_static(gpu, &mut source, &view, &table, &picture) {
                Ok(picture) => film = film::film(still_scene, picture),
                Err(StaticError::Wireframe | StaticError::Source) => {}
                Err(StaticError::Stopped) => drawn = Err(PictureError::Stopped),
                Err(StaticError::Device(e)) => drawn = Err(PictureError::Device(e)),
            }
        }
        let recolored = match &film {
            Some(film) => film::picture(film, gpu, still_scene, film_frame.time)?,
            None => None,
        };
        if let Some(image) = recolored {
            drawn = lay(0, image).map_err(PictureError::Sink);
        } else if drawn.is_ok() {
            let mut source = Combined::new(&mut adaptive)
                .with_markers(markers.as_mut())
                .with_meshes(meshes.as_mut());
            let whole = renderer.render(gpu, &mut source, &view, &table, &picture, lay);
            drawn = whole.map(|_| ());
        }
        match drawn {
            Ok(()) => {}
            Err(PictureError::Stopped) => {
                // Dropping the device waits for its current tile: done on another thread.
                spawn(move || drop((renderer, adaptive, markers, meshes, own)));
                return Err(stopped());
            }
            Err(_) if progress.is_canceled() => return Err(stopped()),
            Err(e) => return Err(e.to_string()),
        }
        png.finish().map_err(broken)?;
        output.finish().map_err(|e| e.to_string())?;
        let done = count * (number + 1);
        progress.done.store(done, Ordering::Relaxed);
    }
    Ok(files)
}

/// What is made before the first picture.
struct Prepared {
    own: Arc<Gpu>,
    adaptive: Adaptive,
    markers: Option<Markers>,
    meshes: Option<Meshes>,
    renderer: StillRenderer,
    picture: PictureOptions,
}

impl Prepared {
    fn new(
        still_scene: &StillScene,
        first: Option<&FilmFrame>,
        options: &PictureFile,
    ) -> Result<Self, String> {
        let own = own_gpu(still_scene)?;
        let gpu = &*own;
        let mut picture = picture_options(still_scene, options);
        picture.look.clip = content::clip(&still_scene.look, &still_scene.spheres);
        let mut adaptive = content::adaptive(gpu, &still_scene.content, gpu.sub_pixels(&picture))
            .map_err(|e| e.to_string())?;
        adaptive.set_settings(AdaptiveSettings {
            lod: LodCriterion::PixelError(0.25),
            wireframe: picture.look.wire > 0.0,
            ..Default::default()
        });
        let mut markers = markers(still_scene, gpu, gpu.sub_pixels(&picture))?;
        let meshes = meshes::upload(gpu, &still_scene.meshes);
        let mut meshes = meshes.map_err(|e| e.to_string())?;
        let mut renderer = StillRenderer::new();
        let table = still_scene.table(first.and_then(|frame| frame.time))?;
        let source = Combined::new(&mut adaptive)
            .with_markers(markers.as_mut())
            .with_meshes(meshes.as_mut());
        renderer
            .make_pipelines(gpu, &source, &table, &picture)
            .map_err(|e| e.to_string())?;
        Ok(Self {
            own,
            adaptive,
            markers,
            meshes,
            renderer,
            picture,
        })
    }
}

/// Time between checks whether saving was canceled.
const CHECK_INTERVAL: Duration = Duration::from_millis(20);

/// What is made before the first picture, on a thread of its own, since it cannot be interrupted: saving stops at
/// once, and what was being made is dropped when it is there.
fn prepared(
    still_scene: &Arc<StillScene>,
    film_frames: &[FilmFrame],
    options: &PictureFile,
    progress: &Progress,
) -> Result<Prepared, String> {
    let (sender, made) = channel();
    let (still_scene, options) = (Arc::clone(still_scene), options.clone());
    let first = film_frames.first().copied();
    spawn(move || {
        let made = caught(|| Prepared::new(&still_scene, first.as_ref(), &options));
        // If saving was canceled, nothing receives it.
        let _ = sender.send(made);
    });
    loop {
        match made.recv_timeout(CHECK_INTERVAL) {
            Ok(made) => return made,
            Err(RecvTimeoutError::Timeout) if !progress.is_canceled() => {}
            Err(RecvTimeoutError::Timeout) => return Err("stopped before the first picture".into()),
            Err(RecvTimeoutError::Disconnected) => return Err("no picture could be begun".into()),
        }
    }
}

/// Rows that are written between checks whether saving was canceled.
const ROWS: usize = 64;

/// Writes a band.
fn write<W: Write>(png: &mut PngWriter<W>, band: &Image, progress: &Progress) -> io::Result<()> {
    for rows in band.pixels.chunks(ROWS * 4 * band.width as usize) {
        if progress.is_canceled() {
            return Err(io::Error::from(io::ErrorKind::Interrupted));
        }
        png.write(&Image {
            width: band.width,
            height: (rows.len() / (4 * band.width as usize)) as u32,
            pixels: rows.to_vec(),
        })?;
    }
    Ok(())
}

/// Synapses and points on the device, as `neurotess render` draws them.
fn markers(
    still_scene: &StillScene,
    gpu: &Gpu,
    sub_pixels: u32,
) -> Result<Option<Markers>, String> {
    let Some(markers) = &still_scene.markers else {
        return Ok(None);
    };
    let mut markers = markers.upload(gpu).map_err(|e| e.to_string())?;
    let most = MarkerSettings::default().most_triangles;
    if let Some(markers) = &mut markers {
        markers.set_settings(settings(
            still_scene.form,
            f64::from(sub_pixels),
            None,
            most,
        ));
    }
    Ok(markers)
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
        look: content::surface_look(look, still_scene.least_width(options.size)),
        occlusion: if look.occlusion {
            Occlusion::Fit
        } else {
            Occlusion::Off
        },
        ..PictureOptions::default()
    }
}
