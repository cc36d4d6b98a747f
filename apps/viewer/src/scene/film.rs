//! Films of a recording from a fixed view: one static picture, colored anew for each time.

use neurotess::coloring::VisibleValues;
use neurotess::render::{Gpu, Image, KeyColors, StaticPicture};

use crate::model::film::FilmFrame;
use crate::model::save::PictureFile;
use crate::scene::still_scene::StillScene;

/// Most pixels of a picture that is held as a whole, with its weights: larger ones are drawn anew.
const MOST_PIXELS: u64 = 1 << 24;

/// Whether the pictures of a film differ in the values of a recording only.
pub(super) fn is_static(scene: &StillScene, frames: &[FilmFrame], options: &PictureFile) -> bool {
    let [width, height] = options.size.map(u64::from);
    frames.len() > 1
        && scene.content.recording.is_some()
        && frames.iter().all(|frame| frame.time.is_some())
        && frames.windows(2).all(|pair| pair[0].view == pair[1].view)
        && width * height <= MOST_PIXELS
}

/// A picture, and where the values are of what shows in it.
pub(super) struct Film {
    picture: StaticPicture,
    visible: VisibleValues,
}

impl Film {
    pub(super) fn new(scene: &StillScene, picture: StaticPicture) -> Self {
        let recording = scene.content.recording.as_ref();
        let visible = recording.map(|(recording, _)| recording.visible(picture.keys()));
        Self {
            visible: visible.unwrap_or_default(),
            picture,
        }
    }

    /// The picture at a time (ms) of the recording.
    pub(super) fn picture(
        &self,
        gpu: &Gpu,
        scene: &StillScene,
        time: Option<f64>,
    ) -> Result<Image, String> {
        let mut values = None;
        if let (Some((recording, _)), Some(time)) = (&scene.content.recording, time) {
            let time = recording.time.nearest(time);
            let read = recording.visible_at(time, scene.look.decay, &self.visible);
            let [low, high] = scene.range();
            let shares = read.map_err(|e| e.to_string())?;
            let share = |value: f32| (value - low) / (high - low);
            values = Some(shares.into_iter().map(share).collect::<Vec<f32>>());
        }
        let colors = KeyColors {
            table: &scene.content.table,
            states: &scene.states,
            values: values.as_deref(),
        };
        let colored = self.picture.recolor(gpu, &colors);
        let image = colored.and_then(|()| self.picture.image(gpu));
        image.map_err(|e| e.to_string())
    }
}
