//! Reports that contradict themselves.

use std::collections::HashSet;

use super::ReportPopulation;
use crate::Warning;

/// What a population says of itself that its data do not have.
pub(super) fn contradictions(population: &ReportPopulation) -> Vec<Warning> {
    let file = population.mapping.name();
    let mut warnings = Vec::new();
    let (announced, frames) = (population.time.announced(), population.time.frames);
    if announced > frames {
        let message = format!(
            "{announced} frames are announced, and {frames} are there: of a run that was cut short? The rest is left out"
        );
        warnings.push(Warning::new(
            file,
            &*population.times,
            "frames_missing",
            message,
        ));
    }
    // Some writers count the end as a frame of its own.
    if announced + 1 < frames {
        let last = population.time.time_of(frames.saturating_sub(1));
        let message = format!(
            "the end is {} ms, before the last of {frames} frames at {last} ms: all frames are read, by start and step",
            population.time.end
        );
        warnings.push(Warning::new(
            file,
            &*population.times,
            "frames_beyond_end",
            message,
        ));
    }
    let mut seen = HashSet::with_capacity(population.nodes.len());
    let again = population.nodes.iter().filter(|&&node| !seen.insert(node));
    let again: Vec<u64> = again.copied().collect();
    if let Some(first) = again.first() {
        let count = again.len() as u64;
        let message = format!(
            "{count} nodes are there more than once, the first is {first}: of each the last values count"
        );
        let key = population.ids.as_str();
        warnings.push(Warning::new(file, key, "node_repeated", message).times(count));
    }
    warnings
}
