//! Saves pictures of the scene.

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use itertools::Itertools;
use neurotess::drawing::{begin_png, recipe_of};
use neurotess::output::{Output, OutputError};
use neurotess::picture::color::ColorTable;
use neurotess::picture::{BoundingSphere, Image, PictureOptions, PngWriter, Viewpoint, Watch};

use crate::io::save::existing;
use crate::io::task::Progress;
use crate::model::film::FilmFrame;
use crate::model::save::PictureFile;
use crate::model::targets::film_files;
use crate::model::view::View;
use crate::scene::content;
use crate::scene::film;
use crate::scene::painter::{Beside, Painter, Unmade};

pub(crate) use crate::scene::still_scene::StillScene;

/// Writes pictures: one, or a numbered series.
pub(crate) fn pictures(
    still_scene: &StillScene,
    film_frames: &[FilmFrame],
    options: &PictureFile,
    progress: &Progress,
) -> Result<Vec<PathBuf>, String> {
    let files = film_files(&options.out, film_frames.len());
    let existing = existing(options.replace);
    for file in &files {
        existing.check(file).map_err(|e| e.to_string())?;
    }
    let picture = picture_options(still_scene, options);
    let beside = Beside::new(still_scene, &picture);
    let watch = Watch {
        tiles: Arc::clone(&progress.done),
        stopped: Arc::clone(&progress.canceled),
    };
    let mut painter = Painter::new(still_scene, &beside, &picture, watch)?;
    let spheres = still_scene.spheres.iter().chain(&still_scene.around);
    let around: Vec<BoundingSphere> = spheres.copied().collect();
    let overlay = still_scene.overlay(film_frames, options);
    let mut film = None;
    // Of the first picture; others may have more or fewer.
    let mut count = 0;
    for (number, (film_frame, file)) in film_frames.iter().zip_eq(&files).enumerate() {
        let stopped = || format!("stopped after {number} of {} pictures", files.len());
        let unmade = |why: Unmade| match why {
            Unmade::Failed(why) if !progress.is_canceled() => why,
            Unmade::Failed(_) | Unmade::Stopped => stopped(),
        };
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
        let told = still_scene
            .told
            .file(options, &film_frame.view, film_frame.time);
        let recipe = options
            .recipe
            .then(|| recipe_of(&told, &still_scene.told.left_out));
        let mut png = begin_png(to, &told, recipe.as_deref()).map_err(broken)?;
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
            count = painter.parts(&view, &picture);
            let all = count * film_frames.len();
            progress.all.store(all, Ordering::Relaxed);
        }
        if number == 0 && film::is_static(still_scene, film_frames, options) {
            let recolored = painter.draw_static(&view, &table, &picture);
            let recolored = recolored.map_err(unmade)?;
            film = recolored.and_then(|recolored| film::film(still_scene, recolored));
        }
        let recolored = match &film {
            Some(film) => film::picture(film, still_scene, film_frame.time)?,
            None => None,
        };
        let drawn = match recolored {
            Some(image) => lay(0, image).map_err(|e| Unmade::Failed(e.to_string())),
            None => painter.draw(&view, &table, &picture, &mut lay),
        };
        drawn.map_err(unmade)?;
        png.finish().map_err(broken)?;
        output.finish().map_err(|e| e.to_string())?;
        let done = count * (number + 1);
        progress.done.store(done, Ordering::Relaxed);
    }
    Ok(files)
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

/// How the scene is drawn: as options tell it, with what only the window has.
fn picture_options(still_scene: &StillScene, options: &PictureFile) -> PictureOptions {
    let look = &still_scene.look;
    let told = still_scene.told.file(options, &View::default(), None);
    let mut picture = told.drawn(still_scene.least_width(options.size));
    picture.look.clip = content::clip(look, &still_scene.spheres);
    (picture.look.highlighted, picture.look.ghosted) = content::of_states(look);
    picture
}
