//! The recording of a page: all of a report, or the times that are asked for.

use std::path::Path;

use neurotess_circuit::{Circuit, NodeRef};
use neurotess_color::{Cell, DECAY, Recording, RecordingError};
use neurotess_web::PageRecording;

use neurotess_options::words::Time;

use crate::error::DrawError;
use crate::host::Host;

/// Most frames of a page without `--time`.
const USUAL_FRAMES: u64 = 200;

/// Reads a recording of the cells, which are these nodes of a circuit in their order; `range`: as in
/// [`page_recording`].
///
/// # Errors
/// Wrong usage; a report that is invalid, or of another circuit.
pub(super) fn read(
    (report, time): (&Path, Option<Time>),
    (circuit, nodes): (&Circuit, &[NodeRef]),
    cells: &[Cell<'_>],
    range: Option<[f32; 2]>,
    host: &dyn Host,
) -> Result<PageRecording, DrawError> {
    let nodes: Vec<_> = nodes.iter().copied().map(Some).enumerate().collect();
    let recording = Recording::open(report, circuit, cells, &nodes).map_err(DrawError::failed)?;
    for warning in &recording.warnings {
        host.warning(warning);
    }
    if recording.without() > 0 {
        let (without, all, file) = (recording.without(), recording.places(), &recording.file);
        host.warning(&format!(
            "{file}: no values for {without} of {all} cells: drawn gray"
        ));
    }
    if let Some(unknown) = recording.unknown_sections() {
        host.warning(&format!("{}: {unknown}", recording.file));
    }
    let times = time.map(|time| time.all(None)).transpose()?;
    page_recording(&recording, times, range, cells.len()).map_err(DrawError::failed)
}

/// A recording as a page plays it, at these times (ms), or at those of all its frames or of some that are evenly spread.
/// `range`: the values at both ends of the scale, if they are not the least and the greatest; `cells`: the page's.
///
/// # Errors
/// The recording has no values at one of the times, or cannot be read.
pub(super) fn page_recording(
    recording: &Recording,
    times: Option<Vec<f64>>,
    range: Option<[f32; 2]>,
    cells: usize,
) -> Result<PageRecording, RecordingError> {
    let times = times.unwrap_or_else(|| all_times(recording));
    let range = match range {
        Some(range) => range,
        None => recording.range_at(times.iter().copied(), &|_| true)?,
    };
    let mut frames = Vec::with_capacity(times.len());
    for &time in &times {
        let frame = recording.at(time, DECAY, &|_| true)?;
        frames.push((0..cells).map(|cell| frame.of(cell).to_vec()).collect());
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
