//! Playback of a recording: its time, and how fast it is played.

use neurotess::circuit::TimeAxis;
use serde::{Deserialize, Serialize};

/// Time (s) in which a whole recording is played unless a speed is set.
const WHOLE: f64 = 10.0;
/// Most pictures in a second: frames between them are left out.
const PICTURES: f64 = 30.0;

/// Time and speed, which are saved in a session.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Pace {
    /// Time of the recording (ms).
    pub time: f64,
    /// Milliseconds of the recording in a second; 0: so that the whole recording takes 10 s.
    pub speed: f64,
    /// Whether it starts over at the end.
    pub loops: bool,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            time: 0.0,
            speed: 0.0,
            loops: true,
        }
    }
}

/// What is known of the recording that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Its name.
    pub title: String,
    /// Unit of the values.
    pub unit: String,
    /// Times (ms).
    pub time: TimeAxis,
    /// Whether it holds spikes.
    pub spikes: bool,
    /// Numbers at both ends of the color map.
    pub range: [f32; 2],
    /// Number of neurons that have no values, and of all.
    pub without: [usize; 2],
    /// What is odd in the file, though it can be read.
    pub warnings: Vec<String>,
}

/// A recording that is played.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Playback {
    /// Time and speed.
    pub pace: Pace,
    /// Whether it is playing.
    pub playing: bool,
    /// What is known of it, once it is open.
    pub facts: Option<Facts>,
}

impl Playback {
    /// Notes that another recording is open, or none.
    pub fn set_facts(&mut self, facts: Option<Facts>) {
        self.facts = facts;
        let Some(Facts { time, .. }) = &self.facts else {
            self.playing = false;
            return;
        };
        if !(self.pace.speed > 0.0 && self.pace.speed.is_finite()) {
            self.pace.speed = nice((time.end - time.start).max(time.step) / WHOLE);
        }
        self.seek(self.pace.time);
    }

    /// Goes to a time (ms), or to the nearest that there is.
    pub fn seek(&mut self, time: f64) {
        if let Some(axis) = self.axis() {
            self.pace.time = axis.nearest(time);
        } else {
            self.pace.time = time;
        }
    }

    /// Advances by a time of the clock (s).
    pub fn advance(&mut self, seconds: f64) {
        let Some(axis) = self.axis().filter(|_| self.playing) else {
            return;
        };
        let length = axis.frames as f64 * axis.step;
        let time = self.pace.time + self.pace.speed * seconds;
        let beyond = time - axis.start >= length;
        if beyond && self.pace.loops && length > 0.0 {
            self.pace.time = axis.start + (time - axis.start) % length;
        } else {
            self.playing = !beyond;
            self.pace.time = axis.nearest(time);
        }
    }

    /// Plays or pauses. At the end it starts over.
    pub fn play(&mut self, playing: bool) {
        self.playing = playing && self.facts.is_some();
        if let Some(axis) = self.axis().filter(|_| self.playing)
            && self.frame() == Some(axis.frames.saturating_sub(1))
        {
            self.pace.time = axis.start;
        }
    }

    /// Goes a number of frames forwards or backwards.
    pub fn step(&mut self, frames: i64) {
        if let (Some(axis), Some(frame)) = (self.axis(), self.frame()) {
            self.playing = false;
            self.seek(axis.time_of(frame.saturating_add_signed(frames)));
        }
    }

    /// The frame that is shown.
    pub fn frame(&self) -> Option<u64> {
        let frame = self.axis()?.frame_at(self.pace.time)?;
        // The same frames each time it is played over, so that they have been read already.
        Some(frame - frame % self.stride())
    }

    /// Frames from one picture to the next.
    pub fn stride(&self) -> u64 {
        match self.axis().filter(|_| self.playing) {
            Some(axis) => (self.pace.speed / PICTURES / axis.step).max(1.0) as u64,
            None => 1,
        }
    }

    /// Seconds until the next picture is due.
    pub fn next(&self) -> Option<f64> {
        let axis = self.axis().filter(|_| self.playing)?;
        let next = axis.time_of(self.frame()? + self.stride());
        Some(((next - self.pace.time) / self.pace.speed).max(0.0))
    }

    fn axis(&self) -> Option<TimeAxis> {
        self.facts.as_ref().map(|facts| facts.time)
    }
}

/// The time (ms) of the frame that is shown at a time, as text.
pub(crate) fn said(axis: &TimeAxis, time: f64) -> String {
    let frame = axis.frame_at(time).map_or(time, |f| axis.time_of(f));
    format!("{frame:.*} ms", digits(axis.step))
}

/// Number of decimals that distinguish frames.
pub(crate) fn digits(step: f64) -> usize {
    let rounded = |digits: usize| {
        let unit = 10f64.powi(digits as i32);
        ((step * unit).round() / unit - step).abs() < 1e-6 * step
    };
    (0..6).find(|&digits| rounded(digits)).unwrap_or(6)
}

/// The nearest of the numbers 1, 2, 5, 10, 20 and so on.
fn nice(number: f64) -> f64 {
    let unit = 10f64.powf(number.log10().floor());
    let near = |a: &&f64, b: &&f64| {
        let far = |n: f64| (number / (n * unit)).ln().abs();
        far(**a).total_cmp(&far(**b))
    };
    let nearest = [1.0, 2.0, 5.0, 10.0].iter().min_by(near).copied();
    nearest.unwrap_or(1.0) * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(frames: u64, step: f64) -> Playback {
        let mut playback = Playback::default();
        playback.set_facts(Some(Facts {
            title: "voltage".into(),
            unit: "mV".into(),
            time: TimeAxis {
                start: 10.0,
                end: 10.0 + frames as f64 * step,
                step,
                frames,
            },
            spikes: false,
            range: [0.0, 1.0],
            without: [0, 1],
            warnings: Vec::new(),
        }));
        playback
    }

    #[test]
    fn a_whole_recording_takes_about_ten_seconds() {
        let mut playback = opened(1000, 0.1);
        assert_eq!((playback.pace.time, playback.pace.speed), (10.0, 10.0));
        playback.play(true);
        playback.advance(3.0);
        assert!((playback.pace.time - 40.0).abs() < 1e-9);
        // 30 pictures a second, of 100 frames in that time: every third is shown.
        assert_eq!((playback.stride(), playback.frame()), (3, Some(300)));
        assert!((playback.next().expect("plays") - 0.03).abs() < 1e-9);
    }

    #[test]
    fn the_end_is_the_beginning_or_the_end() {
        let mut playback = opened(100, 0.5);
        playback.play(true);
        playback.advance(13.0);
        assert!(playback.playing && (10.0..60.0).contains(&playback.pace.time));
        playback.pace.loops = false;
        playback.advance(1e3);
        assert!(!playback.playing);
        assert_eq!(playback.frame(), Some(99));
        playback.play(true);
        assert_eq!(playback.frame(), Some(0), "once more");
    }

    #[test]
    fn times_have_the_digits_that_tell_frames_apart() {
        assert_eq!([1.0, 0.5, 0.025, 0.1].map(digits), [0, 1, 3, 1]);
        assert_eq!(digits(1.0 / 3.0), 6);
        let facts = opened(100, 0.5).facts.expect("open");
        assert_eq!(said(&facts.time, 12.7), "12.5 ms");
    }

    #[test]
    fn steps_stop_at_the_ends() {
        let mut playback = opened(10, 0.5);
        playback.step(-1);
        assert_eq!(playback.frame(), Some(0));
        playback.step(3);
        assert_eq!((playback.frame(), playback.pace.time), (Some(3), 11.5));
        playback.step(100);
        assert_eq!(playback.frame(), Some(9));
        playback.seek(f64::NAN);
        assert_eq!(playback.frame(), Some(0));
        playback.set_facts(None);
        playback.play(true);
        assert!(!playback.playing && playback.frame().is_none());
    }
}
