//! Writing reports.

use std::io::{self, Write};

use hdf5_pure::FileBuilder;

use super::{header, text};
use crate::{CircuitError, TimeAxis};

/// What a report is of.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportLayout {
    /// Name of the population.
    pub population: String,
    /// Times of the frames.
    pub time: TimeAxis,
    /// Unit of the values.
    pub units: String,
    /// Ids of the nodes, ascending.
    pub nodes: Vec<u64>,
    /// Numbers of the sections of each node's compartments; 0 is the soma.
    pub sections: Vec<Vec<u32>>,
    /// Frames and compartments in a chunk; at most as many as there are.
    pub chunk: [u64; 2],
    /// Whether chunks are compressed.
    pub compressed: bool,
}

impl TimeAxis {
    /// Frames from `start` (ms) on, `step` (ms) apart.
    ///
    /// # Errors
    /// [`crate::Fault::Time`] if the step is not above zero.
    pub fn of_frames(start: f64, step: f64, frames: u64) -> Result<Self, CircuitError> {
        let axis = [start, start + frames as f64 * step, step];
        Self::new(axis, frames).map_err(|fault| CircuitError::of_file("new report", fault))
    }
}

/// Writes a report. `data`: frames × compartments.
///
/// # Errors
/// Those of the writer.
///
/// # Panics
/// If there are not as many values as frames and compartments make.
pub fn report(layout: &ReportLayout, data: &[f32], writer: impl Write) -> io::Result<()> {
    let sections: Vec<u32> = layout.sections.concat();
    let (frames, compartments) = (layout.time.frames, sections.len() as u64);
    assert_eq!(
        data.len() as u64,
        frames * compartments,
        "frames × compartments"
    );
    let mut pointers = vec![0u64];
    for own in &layout.sections {
        pointers.push(pointers[pointers.len() - 1] + own.len() as u64);
    }
    let mut file = FileBuilder::new();
    header(&mut file);
    let mut reports = file.create_group("report");
    let mut group = reports.create_group(&layout.population);
    let dataset = group.create_dataset("data");
    let chunk = [
        layout.chunk[0].min(frames),
        layout.chunk[1].min(compartments),
    ];
    dataset
        .with_f32_data(data)
        .with_shape(&[frames, compartments])
        .with_chunks(&chunk.map(|size| size.max(1)))
        .set_attr("units", text(&layout.units));
    if layout.compressed {
        dataset.with_shuffle().with_deflate(4);
    }
    let mut mapping = group.create_group("mapping");
    let TimeAxis {
        start, end, step, ..
    } = layout.time;
    mapping
        .create_dataset("time")
        .with_f64_data(&[start, end, step])
        .set_attr("units", text("ms"));
    mapping
        .create_dataset("node_ids")
        .with_u64_data(&layout.nodes)
        .set_attr("sorted", hdf5_pure::AttrValue::U8(1));
    mapping
        .create_dataset("index_pointers")
        .with_u64_data(&pointers);
    mapping
        .create_dataset("element_ids")
        .with_u32_data(&sections);
    group.add_group(mapping.finish());
    reports.add_group(group.finish());
    file.add_group(reports.finish());
    file.finish_to(writer).map_err(io::Error::other)
}
