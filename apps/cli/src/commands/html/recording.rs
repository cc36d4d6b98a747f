//! The recording of a page: all of a report, or the times that are asked for.

use std::path::Path;

use neurotess::coloring::{Cell, DECAY, Recording};
use neurotess::web::PageRecording;

use super::HtmlArgs;
use crate::commands::render::{CircuitInstances, times};
use crate::report::Reporter;

/// Most frames of a page without `--time`.
const USUAL_FRAMES: u64 = 200;

/// Reads a recording of the cells, which are the instances in their order.
///
/// # Errors
/// Wrong usage; a report that is invalid, or of another circuit.
pub(super) fn read(
    report: &Path,
    args: &HtmlArgs,
    instances: &CircuitInstances,
    cells: &[Cell<'_>],
    reporter: &Reporter,
) -> anyhow::Result<PageRecording> {
    let own: Vec<usize> = (0..cells.len()).collect();
    let nodes = instances.with_cells(&own);
    let recording = Recording::open(report, &instances.circuit, cells, &nodes).map_err(whole)?;
    if recording.without() > 0 {
        let (without, all, file) = (recording.without(), recording.places(), &recording.file);
        reporter.warning(&format!(
            "{file}: no values for {without} of {all} cells: drawn gray"
        ));
    }
    let times = match times(args.time, None)? {
        Some(times) => times,
        None => all_times(&recording),
    };
    let range = match args.range {
        Some(range) => range,
        None => recording
            .range_at(times.iter().copied(), &|_| true)
            .map_err(whole)?,
    };
    let mut frames = Vec::with_capacity(times.len());
    for &time in &times {
        let frame = recording.at(time, DECAY, &|_| true).map_err(whole)?;
        frames.push(
            (0..cells.len())
                .map(|cell| frame.of(cell).to_vec())
                .collect(),
        );
    }
    Ok(PageRecording {
        title: recording.title.clone(),
        unit: recording.unit.clone(),
        times,
        range,
        color_keys: recording.color_keys().to_vec(),
        frames,
    })
}

/// Evenly spread frames of the whole recording.
fn all_times(recording: &Recording) -> Vec<f64> {
    let axis = &recording.time;
    let step = axis.frames.div_ceil(USUAL_FRAMES).max(1);
    (0..axis.frames)
        .step_by(step as usize)
        .map(|frame| axis.time_of(frame))
        .collect()
}

/// An error with the message only: with its source, the message would be printed twice.
fn whole(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow::anyhow!("{error}")
}
