//! Numbers of one's own over time: a recording that is in memory, of cells that need no circuit.

use std::collections::HashMap;

use neurotess_circuit::TimeAxis;
use neurotess_mesh::{Role, TracingPoint};
use neurotess_render::color::category;

use crate::recording::{Recording, Source};
use crate::report_frame::ReportFrame;
use crate::scheme::Cell;

/// Numbers of a cell over time, in columns that points of its tracing share.
#[derive(Clone, Debug, PartialEq)]
pub struct CellSeries {
    /// Of each point of its tracing, its column.
    pub points: Vec<Option<u32>>,
    /// The column of its somata.
    pub soma: Option<u32>,
    /// How many columns there are.
    pub columns: usize,
    /// Frame by frame, the number of each column; NaN where there is none.
    pub values: Vec<f32>,
}

/// Numbers of cells over time, and what the legend says of them.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnSeries {
    /// By cell.
    pub cells: Vec<CellSeries>,
    /// Times (ms) of the frames.
    pub time: TimeAxis,
    /// What they are.
    pub title: String,
    /// Their unit; empty if they have none.
    pub unit: String,
}

/// The numbers, and the cell that each instance shows.
#[derive(Debug)]
pub(crate) struct Memory {
    cells: Vec<CellSeries>,
    instances: Vec<usize>,
    time: TimeAxis,
}

impl Recording {
    /// A recording of numbers in memory. `instances`: the cell that each neuron of the scene shows.
    ///
    /// # Panics
    /// If cells and series differ in number, or a series has other numbers of points or values than it says.
    pub fn of_series(series: OwnSeries, cells: &[Cell<'_>], instances: &[usize]) -> Self {
        assert_eq!(series.cells.len(), cells.len(), "a series for each cell");
        let frames = series.time.frames as usize;
        for of in &series.cells {
            assert_eq!(
                of.values.len(),
                frames * of.columns,
                "frames of all columns"
            );
        }
        let color_keys = cells.iter().zip(&series.cells);
        Self {
            file: match series.title.is_empty() {
                true => "values".into(),
                false => series.title.clone(),
            },
            title: series.title,
            unit: series.unit,
            color_keys: color_keys.map(|(cell, of)| keys(cell, of)).collect(),
            has_values: instances
                .iter()
                .map(|&cell| series.cells[cell].columns > 0)
                .collect(),
            source: Source::Memory(Memory {
                cells: series.cells,
                instances: instances.to_vec(),
                time: series.time,
            }),
            time: series.time,
        }
    }
}

impl Memory {
    /// The numbers of an instance at a time (ms); none beyond the frames.
    pub(crate) fn at(&self, time: f64, instance: usize) -> Option<&[f32]> {
        let frame = self.time.frame_at(time)? as usize;
        let of = &self.cells[*self.instances.get(instance)?];
        of.values.get(frame * of.columns..(frame + 1) * of.columns)
    }

    /// All numbers of the instances that `shows` is true for.
    pub(crate) fn frame(&self, time: f64, shows: &dyn Fn(usize) -> bool) -> Option<ReportFrame> {
        self.time.frame_at(time)?;
        let mut frame = ReportFrame::none(self.instances.len());
        for instance in (0..self.instances.len()).filter(|&instance| shows(instance)) {
            let own = self.at(time, instance).unwrap_or_default();
            frame.put(instance, own.iter().copied());
        }
        Some(frame)
    }
}

/// Columns of the points of a cell's mesh, as color keys. Points have the file's numbers there, which may repeat in other
/// sections.
fn keys(cell: &Cell<'_>, series: &CellSeries) -> Vec<u32> {
    let morphology = cell.morphology;
    let mut of_sample: HashMap<(usize, i32), Option<u32>> = HashMap::new();
    for (index, section) in morphology.sections.iter().enumerate() {
        for point in section.range() {
            let sample = i32::try_from(morphology.sample_ids[point]).unwrap_or(i32::MAX);
            of_sample.insert((index, sample), series.points[point]);
        }
    }
    let column = |point: &TracingPoint| match (point.role, point.section.index()) {
        (Role::Soma, _) => series.soma,
        (_, Some(section)) => *of_sample.get(&(section, point.sample.0))?,
        (_, None) => None,
    };
    let points = cell.mesh.tracing.iter();
    points
        .map(|point| column(point).unwrap_or(category(0)))
        .collect()
}

#[cfg(test)]
mod tests {
    use neurotess_render::color::CATEGORY_BIT;

    use super::*;
    use crate::DECAY;

    #[test]
    fn numbers_in_memory_are_a_recording() {
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
        let time = TimeAxis {
            start: 10.0,
            end: 11.0,
            step: 0.5,
            frames: 2,
        };
        let series = OwnSeries {
            cells: vec![CellSeries {
                points: vec![Some(1), None, Some(2)],
                soma: Some(0),
                columns: 3,
                values: vec![-65.0, -64.0, -63.0, 5.0, 6.0, f32::NAN],
            }],
            time,
            title: "voltage".into(),
            unit: "mV".into(),
        };
        let recording = Recording::of_series(series, &[cell], &[0, 0]);
        assert_eq!((recording.places(), recording.without()), (2, 0));
        for (point, &key) in mesh.tracing.iter().zip(&recording.color_keys()[0]) {
            let expected = match (point.role, point.sample.0) {
                (Role::Soma, _) => 0,
                (_, 2) => 1,
                (_, 3) => category(0),
                _ => 2,
            };
            assert_eq!(key, expected, "{point:?}");
        }
        let frame = recording.at(10.7, DECAY, &|_| true).expect("a frame");
        assert_eq!(frame.of(1)[..2], [5.0, 6.0]);
        let range = recording.range(&|_| true).expect("a range");
        assert_eq!(range, [-65.0, 6.0]);
        let keys = recording.color_keys()[0].iter().enumerate();
        let visible: Vec<_> = keys
            .filter(|(_, key)| *key & CATEGORY_BIT == 0)
            .map(|(_, &color_key)| neurotess_render::VisibleKey {
                instance: 1,
                color_key,
            })
            .collect();
        let found = recording.visible(&visible);
        let values = recording.visible_at(10.0, DECAY, &found).expect("values");
        for (key, value) in visible.iter().zip(values) {
            assert_eq!(value, [-65.0, -64.0, -63.0][key.color_key as usize]);
        }
        let beyond = recording.at(11.0, DECAY, &|_| true).expect_err("the end");
        let expected = "voltage: has no values at 11 ms: choose a time from 10 to below 11";
        assert_eq!(beyond.to_string(), expected);
    }
}
