//! Reads values of single compartments over time.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use neurotess::coloring::Recording;
use neurotess::morphology::{Morphology, SectionId};

use crate::io::task::{Progress, caught};
use crate::model::document::TracePlace;
use crate::model::traces::{PointedValue, ReadTrace, TraceContent};

/// Fewest frames that are read at once: after as many it is looked whether the work was canceled.
const BLOCK: u64 = 256;

/// What was read, by place.
pub(crate) type Traces = Vec<(TracePlace, ReadTrace)>;

/// Reads what a recording has of places, with the tracings of their neurons. What cannot be read is told by each; what was
/// read before is kept.
pub(crate) fn read(
    recording: &Recording,
    places: &[(TracePlace, Arc<Morphology>)],
    progress: &Progress,
) -> Traces {
    let one = |(place, morphology): &(TracePlace, Arc<Morphology>)| {
        let mut read = ReadTrace {
            content: TraceContent::Nothing,
            problem: None,
        };
        read.problem = caught(|| trace(recording, *place, morphology, &mut read.content, progress))
            .err()
            .map(|why| without(&recording.file, &why));
        (*place, read)
    };
    places.iter().map(one).collect()
}

fn trace(
    recording: &Recording,
    place: TracePlace,
    morphology: &Morphology,
    content: &mut TraceContent,
    progress: &Progress,
) -> Result<(), String> {
    if let Some(times) = recording.spikes_of(place.neuron) {
        if recording.has_values_of(place.neuron) {
            *content = TraceContent::Spikes(times);
        }
        return Ok(());
    }
    let said = |e: neurotess::coloring::RecordingError| e.to_string();
    let section = place.section.map(SectionId);
    let compartment = recording.compartment(place.neuron, morphology, section, place.along);
    let Some(compartment) = compartment.map_err(said)? else {
        return Ok(());
    };
    let Some((time, together)) = recording.trace_axis(&compartment) else {
        return Ok(());
    };
    progress
        .all
        .fetch_add(time.frames as usize, Ordering::Relaxed);
    *content = TraceContent::Values {
        compartment: compartment.clone(),
        time,
        values: Vec::new(),
    };
    let block = together.max(1) * BLOCK.div_ceil(together.max(1));
    let mut from = 0;
    while from < time.frames {
        if progress.is_canceled() {
            return Err("stopped before all values were read".into());
        }
        let to = from.saturating_add(block).min(time.frames);
        let keep = |read: Vec<f32>, content: &mut TraceContent| {
            if let TraceContent::Values { values, .. } = content {
                values.extend(read);
            }
        };
        match recording.trace(&compartment, from..to) {
            Ok(read) => keep(read, content),
            // What comes before the fault is kept.
            Err(_) => {
                for first in (from..to).step_by(together.max(1) as usize) {
                    let last = (first + together.max(1)).min(to);
                    let read = recording.trace(&compartment, first..last);
                    keep(read.map_err(said)?, content);
                }
            }
        }
        progress
            .done
            .fetch_add((to - from) as usize, Ordering::Relaxed);
        from = to;
    }
    Ok(())
}

/// Reads the value of a place in a frame.
pub(crate) fn value(
    recording: &Recording,
    of: (TracePlace, u64),
    morphology: &Morphology,
) -> Result<PointedValue, String> {
    let (place, frame) = of;
    let said = |e: neurotess::coloring::RecordingError| e.to_string();
    let section = place.section.map(SectionId);
    let compartment = recording.compartment(place.neuron, morphology, section, place.along);
    let time = recording.time.time_of(frame);
    let value = match compartment.map_err(said)? {
        Some(compartment) => {
            let value = recording.value_of(&compartment, time).map_err(said)?;
            value.map(|value| (compartment, value))
        }
        None => None,
    };
    Ok(PointedValue { of, value })
}

/// A reason without the file's name, which the window shows beside it.
fn without(file: &str, text: &str) -> String {
    let rest = text.strip_prefix(file).unwrap_or(text);
    rest.trim_start_matches([':', ' ']).to_owned()
}
