//! Films that are saved from a fixed view.

use neurotess::coloring::Film;
use neurotess::picture::{Image, KeyColors};

use crate::model::film::FilmFrame;
use crate::model::save::PictureFile;
use crate::scene::still_scene::StillScene;
use neurotess::drawing::Recolored;

/// Whether the pictures of a film differ in the values of a recording only.
pub(super) fn is_static(scene: &StillScene, frames: &[FilmFrame], options: &PictureFile) -> bool {
    frames.len() > 1
        && scene.content.recording.is_some()
        && frames.iter().all(|frame| frame.time.is_some())
        && frames.windows(2).all(|pair| pair[0].view == pair[1].view)
        && Film::holds(options.size)
}

/// A picture with the film of the scene's recording; none without one.
pub(super) fn film(scene: &StillScene, picture: Recolored) -> Option<(Film, Recolored)> {
    let (recording, _) = scene.content.recording.as_ref()?;
    let decay = scene.look.decay;
    let film = Film::new(picture.keys(), recording, scene.range(), decay);
    Some((film, picture))
}

/// The picture at a time (ms) of the scene's recording; none without these.
pub(super) fn picture(
    (film, picture): &(Film, Recolored),
    scene: &StillScene,
    time: Option<f64>,
) -> Result<Option<Image>, String> {
    let (Some((recording, _)), Some(time)) = (&scene.content.recording, time) else {
        return Ok(None);
    };
    let time = recording.time.nearest(time);
    let values = film.values(recording, time).map_err(|e| e.to_string())?;
    let colors = KeyColors {
        table: &scene.content.table,
        states: &scene.states,
        values: Some(&values),
    };
    let image = picture.image(&colors);
    image.map(Some).map_err(|e| e.to_string())
}
