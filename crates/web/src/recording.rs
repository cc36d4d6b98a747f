//! Values over time, or of one time, in a page.

use neurotess_render::color::CATEGORY_BIT;
use serde::Serialize;

use crate::arrays::{ArrayRef, Arrays};

/// Values of a simulation or of one's own.
#[derive(Clone, Debug, Default)]
pub struct PageRecording {
    /// What they are.
    pub title: String,
    /// Their unit; empty if unknown.
    pub unit: String,
    /// Times (ms) of the frames; one or none if values do not change.
    pub times: Vec<f64>,
    /// Numbers at the ends of the scale.
    pub range: [f32; 2],
    /// By cell: color keys, indices of its values; categories have none.
    pub color_keys: Vec<Vec<u32>>,
    /// By frame, then by cell: its values; NaN where there is none.
    pub frames: Vec<Vec<Vec<f32>>>,
}

/// A recording as the page's host reads it.
#[derive(Debug, Serialize)]
pub(crate) struct RecordingData {
    title: String,
    unit: String,
    times: Vec<f64>,
    range: [f32; 2],
    /// By cell: 1 + index of the value of each tracing point, or 0.
    keys: Vec<ArrayRef>,
    /// By cell: index of its first value in a frame.
    firsts: Vec<usize>,
    /// Number of values of a frame.
    values: usize,
    /// Frame by frame, each as differences to the one before: 1 to 255 for the range, 0 for none.
    frames: ArrayRef,
}

impl RecordingData {
    pub(crate) fn new(recording: &PageRecording, arrays: &mut Arrays) -> Self {
        let key = |&key: &u32| match key & CATEGORY_BIT {
            0 => (key + 1).min(u32::from(u16::MAX)) as u16,
            _ => 0,
        };
        let keys = recording.color_keys.iter();
        let keys = keys.map(|keys| arrays.u16s(&keys.iter().map(key).collect::<Vec<_>>()));
        let keys = keys.collect();
        let cells = recording.color_keys.len();
        let counts: Vec<usize> = (0..cells)
            .map(|cell| {
                let of_frame = |frame: &Vec<Vec<f32>>| frame.get(cell).map_or(0, Vec::len);
                recording.frames.iter().map(of_frame).max().unwrap_or(0)
            })
            .collect();
        let mut firsts = Vec::new();
        let mut values = 0;
        for count in &counts {
            firsts.push(values);
            values += count;
        }
        let mut before = vec![0_u8; values];
        let mut bytes = Vec::with_capacity(values * recording.frames.len());
        for frame in &recording.frames {
            let mut now = vec![0_u8; values];
            for (cell, of_cell) in frame.iter().enumerate() {
                for (k, &value) in of_cell.iter().enumerate() {
                    now[firsts[cell] + k] = step_of(value, recording.range);
                }
            }
            bytes.extend(
                now.iter()
                    .zip(&before)
                    .map(|(now, before)| now.wrapping_sub(*before)),
            );
            before = now;
        }
        Self {
            title: recording.title.clone(),
            unit: recording.unit.clone(),
            times: recording.times.clone(),
            range: recording.range,
            keys,
            firsts,
            values,
            frames: arrays.u8s(&bytes),
        }
    }
}

/// A value as one of 255 steps of the range, from 1 on; 0 for none.
fn step_of(value: f32, [low, high]: [f32; 2]) -> u8 {
    if !value.is_finite() {
        return 0;
    }
    let share = (value - low) / (high - low);
    1 + (share.clamp(0.0, 1.0) * 254.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_255_steps_and_nothing_is_0() {
        let step = |value| step_of(value, [-80.0, 40.0]);
        assert_eq!(
            [-90.0, -80.0, -20.0, 40.0, 50.0].map(step),
            [1, 1, 128, 255, 255]
        );
        assert_eq!(step(f32::NAN), 0);
    }
}
