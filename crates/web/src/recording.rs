//! Values over time, or of one time, in a page.

use neurotess_color::{Cell, OwnValues};
use neurotess_picture::color::{CATEGORY_BIT, category};
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

impl PageRecording {
    /// Numbers of one's own for cells, which do not change; `range`: those at the ends of the scale, if they are not the
    /// least and the greatest.
    ///
    /// They are told in the steps in which a page stores them, so that cells may have any number of points.
    pub fn still(cells: &[Cell<'_>], values: &OwnValues, range: Option<[f32; 2]>) -> Self {
        let (shown, range) = values.spread(cells, range);
        let key = |&value: &f32| match step_of(value, range) {
            0 => category(0),
            step => u32::from(step) - 1,
        };
        let [low, high] = range;
        let steps: Vec<f32> = (0..STEPS)
            .map(|step| low + (high - low) * f32::from(step) / LAST)
            .collect();
        Self {
            title: values.title.clone(),
            unit: values.unit.clone(),
            times: Vec::new(),
            range,
            color_keys: shown
                .iter()
                .map(|of| of.iter().map(key).collect())
                .collect(),
            frames: vec![vec![steps; shown.len()]],
        }
    }
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

/// Values are stored in so many steps.
const STEPS: u8 = 255;
/// Number of the last step, from 0 on.
const LAST: f32 = 254.0;

/// A value as one of [`STEPS`] of the range, from 1 on; 0 for none.
fn step_of(value: f32, [low, high]: [f32; 2]) -> u8 {
    if !value.is_finite() {
        return 0;
    }
    let share = (value - low) / (high - low);
    1 + (share.clamp(0.0, 1.0) * LAST).round() as u8
}

#[cfg(test)]
mod tests {
    use neurotess_color::CellValues;
    use neurotess_mesh::Role;

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

    #[test]
    fn still_values_are_those_of_their_points_to_half_a_step() {
        let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 20 0 1 2\n4 3 0 40 0 1 3\n";
        let read = neurotess_formats::swc::read_bytes(text, "cell", &Default::default());
        let morphology = read.expect("a cell").morphology;
        let generated = neurotess_generate::generate(&morphology, &Default::default());
        let mesh = generated.expect("meshed").mesh;
        let cell = Cell {
            name: "",
            morphology: &morphology,
            mesh: &mesh,
            radius_factor: 1.0,
        };
        let values = OwnValues {
            cells: vec![CellValues {
                points: vec![-80.3, f32::NAN, 41.7],
                soma: 12.3,
            }],
            ..OwnValues::default()
        };
        let still = PageRecording::still(&[cell], &values, None);
        assert_eq!(still.range, [-80.3, 41.7]);
        let shown = &still.frames[0][0];
        for (point, &key) in mesh.tracing.iter().zip(&still.color_keys[0]) {
            let expected = match (point.role, point.sample.0) {
                (Role::Soma, _) => 12.3,
                (_, 2) => -80.3,
                (_, 3) => {
                    assert_eq!(key, category(0));
                    continue;
                }
                _ => 41.7,
            };
            let told = shown[key as usize];
            assert!((told - expected).abs() <= 0.25, "{told} {expected}");
            // As the page stores it.
            assert_eq!(u32::from(step_of(told, still.range)), key + 1);
        }
        let steps: Vec<u8> = shown.iter().map(|&v| step_of(v, still.range)).collect();
        assert_eq!(steps, (1..=STEPS).collect::<Vec<_>>());
    }
}
