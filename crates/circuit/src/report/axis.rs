//! The times of frames.

use crate::Fault;

/// Equidistant times (ms): frame `i` is at `start + i·step`; `end` is excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeAxis {
    /// Time of the first frame (ms).
    pub start: f64,
    /// Where the report ends (ms), excluded.
    pub end: f64,
    /// Between two frames (ms).
    pub step: f64,
    /// How many frames there are.
    pub frames: u64,
}

impl TimeAxis {
    /// Checks what a file says; `frames` is how many it has.
    pub(crate) fn new([start, end, step]: [f64; 3], frames: u64) -> Result<Self, Fault> {
        let finite = start.is_finite() && end.is_finite() && step.is_finite();
        if !finite || step <= 0.0 || end < start {
            return Err(Fault::Time { start, end, step });
        }
        Ok(Self {
            start,
            end,
            step,
            frames,
        })
    }

    /// How many frames start, end and step make; files may have fewer, of a run cut short.
    pub fn announced(&self) -> u64 {
        ((self.end - self.start) / self.step).round() as u64
    }

    /// The frame that shows at a time (ms): the last one that is not later. `None` before the first
    /// frame and from one step after the last one on.
    pub fn frame_at(&self, time: f64) -> Option<u64> {
        // 0.3 / 0.1 is 2.9999999999999996: a time that is a frame's but for rounding is that frame's.
        let frame = ((time - self.start) / self.step + 1e-6).floor();
        (frame >= 0.0 && frame < self.frames as f64).then_some(frame as u64)
    }

    /// The nearest time (ms) at which a frame shows; no number is the first one's.
    pub fn nearest(&self, time: f64) -> f64 {
        let last = self.time_of(self.frames.saturating_sub(1)).max(self.start);
        if time.is_nan() {
            return self.start;
        }
        time.clamp(self.start, last)
    }

    /// Time of a frame (ms).
    pub fn time_of(&self, frame: u64) -> f64 {
        self.start + frame as f64 * self.step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_find_their_frames() {
        let axis = TimeAxis::new([0.0, 1.0, 0.1], 10).expect("an axis");
        assert_eq!(axis.announced(), 10);
        for frame in 0..10 {
            assert_eq!(axis.frame_at(axis.time_of(frame)), Some(frame));
            assert_eq!(axis.frame_at(axis.time_of(frame) + 0.09), Some(frame));
        }
        assert_eq!([-0.01, 1.0, f64::NAN].map(|t| axis.frame_at(t)), [None; 3]);
        let nearest = [-1.0, 0.25, 7.0, f64::NAN].map(|t| axis.nearest(t));
        assert_eq!(nearest, [0.0, 0.25, axis.time_of(9), 0.0]);
        for wrong in [[0.0, 1.0, 0.0], [1.0, 0.0, 0.1], [0.0, f64::NAN, 0.1]] {
            assert!(TimeAxis::new(wrong, 1).is_err());
        }
    }
}
