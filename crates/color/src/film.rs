//! Films of a recording from a fixed view: one static picture, colored anew for each time.

use neurotess_render::color::ColorTable;
use neurotess_render::{DeviceError, Gpu, Image, KeyColors, StaticPicture};
use thiserror::Error;

use crate::recording::{Recording, RecordingError};
use crate::visible::{VisibleValues, fractions};

/// Most pixels of a picture that is held as a whole, with its weights: larger ones are drawn anew.
const MAX_PIXELS: u64 = 1 << 24;

/// A static picture, and where a recording has the values of what shows in it.
pub struct Film {
    picture: StaticPicture,
    visible: VisibleValues,
    range: [f32; 2],
    decay: f64,
}

/// Why a picture of a film was not made.
#[derive(Debug, Error)]
pub enum FilmError {
    /// The device reports an error.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

impl Film {
    /// Whether pictures of this size (pixels) are not too large for it.
    pub fn holds([width, height]: [u32; 2]) -> bool {
        u64::from(width) * u64::from(height) <= MAX_PIXELS
    }

    /// A film of a recording. `range`: values at both ends of the scale; `decay`: as in
    /// [`Recording::at`].
    pub fn new(picture: StaticPicture, recording: &Recording, range: [f32; 2], decay: f64) -> Self {
        Self {
            visible: recording.visible(picture.keys()),
            picture,
            range,
            decay,
        }
    }

    /// The picture at a time (ms). `recording`: that of the film; `table`: scale and categories;
    /// `states`: as in [`KeyColors`].
    ///
    /// # Errors
    /// The recording has no values at that time, or cannot be read; or the device reports an error.
    pub fn picture(
        &self,
        gpu: &Gpu,
        recording: &Recording,
        time: f64,
        (table, states): (&ColorTable, &[u32]),
    ) -> Result<Image, FilmError> {
        let values = recording.visible_at(time, self.decay, &self.visible)?;
        let colors = KeyColors {
            table,
            states,
            values: Some(&fractions(&values, self.range)),
        };
        self.picture.recolor(gpu, &colors)?;
        Ok(self.picture.image(gpu)?)
    }

    /// The picture that is colored.
    pub fn static_picture(&self) -> &StaticPicture {
        &self.picture
    }

    /// Number of compartments that are read for a picture; 0 for spikes.
    pub fn compartments(&self) -> usize {
        self.visible.compartments()
    }
}
