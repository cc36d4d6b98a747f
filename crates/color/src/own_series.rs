//! Numbers of one's own over time: a recording that is in memory, of cells that need no circuit.

use itertools::Itertools;
use neurotess_circuit::TimeAxis;
use neurotess_picture::color::category;

use crate::own_values::on_mesh;
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

impl Memory {
    /// Numbers of cells, and the cell that each instance shows; with the color keys of the cells.
    ///
    /// # Panics
    /// If cells and series differ in number, or a series has other numbers of values than it says.
    pub(crate) fn new(
        series: OwnSeries,
        cells: &[Cell<'_>],
        instances: &[usize],
    ) -> (Self, Vec<Vec<u32>>) {
        assert_eq!(series.cells.len(), cells.len(), "a series for each cell");
        let frames = series.time.frames as usize;
        for of in &series.cells {
            assert_eq!(of.values.len(), frames * of.columns, "frames of columns");
        }
        let color_keys = cells.iter().zip_eq(&series.cells);
        let color_keys = color_keys.map(|(cell, of)| keys(cell, of)).collect();
        let memory = Self {
            cells: series.cells,
            instances: instances.to_vec(),
            time: series.time,
        };
        (memory, color_keys)
    }

    /// Whether an instance has numbers.
    pub(crate) fn has_values(&self, instance: usize) -> bool {
        let cell = self.instances.get(instance);
        cell.is_some_and(|&cell| self.cells[cell].columns > 0)
    }

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

/// Columns of the points of a cell's mesh, as color keys.
fn keys(cell: &Cell<'_>, series: &CellSeries) -> Vec<u32> {
    let columns = on_mesh(cell, &series.points, series.soma, None).into_iter();
    columns
        .map(|column| column.unwrap_or(category(0)))
        .collect()
}
