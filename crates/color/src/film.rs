//! Films of a recording from a fixed view: one static picture, colored anew for each time.

use neurotess_picture::VisibleKey;

use crate::recording::{Recording, RecordingError};
use crate::visible::{VisibleValues, fractions};

/// Most pixels of a picture that is held as a whole, with its weights: larger ones are drawn anew.
const MAX_PIXELS: u64 = 1 << 24;

/// Where a recording has the values of what shows in a static picture, and what it makes of them.
pub struct Film {
    visible: VisibleValues,
    range: [f32; 2],
    decay: f64,
}

impl Film {
    /// Whether pictures of this size (pixels) are not too large for it.
    pub fn holds([width, height]: [u32; 2]) -> bool {
        u64::from(width) * u64::from(height) <= MAX_PIXELS
    }

    /// A film of a recording. `keys`: what shows in the picture; `range`: values at both ends of the scale; `decay`: as
    /// in [`Recording::at`].
    pub fn new(keys: &[VisibleKey], recording: &Recording, range: [f32; 2], decay: f64) -> Self {
        Self {
            visible: recording.visible(keys),
            range,
            decay,
        }
    }

    /// What the picture is colored by at a time (ms): a fraction of the range for each of its keys, as
    /// [`KeyColors::values`](neurotess_picture::KeyColors::values) has them. `recording`: that of the film.
    ///
    /// # Errors
    /// The recording has no values at that time, or cannot be read.
    pub fn values(&self, recording: &Recording, time: f64) -> Result<Vec<f32>, RecordingError> {
        let values = recording.visible_at(time, self.decay, &self.visible)?;
        Ok(fractions(&values, self.range))
    }

    /// Number of compartments that are read for a picture; 0 for spikes.
    pub fn compartments(&self) -> usize {
        self.visible.compartments()
    }
}
