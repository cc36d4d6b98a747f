//! Messages: a line per cell, warnings, the summary.

use std::collections::BTreeMap;
use std::time::Instant;

use neurotess::batch::{CellReport, Entry, OutputState};

use crate::io::inputs::tell_warnings;
use crate::report::{Reporter, count, place};

/// Reports outputs that exist and are made again, and outputs that are kept although nothing is
/// known of their options.
pub(super) fn tell_states(states: &[OutputState], reporter: &Reporter) {
    let number = |state: OutputState| states.iter().filter(|&&s| s == state).count();
    let note = |state, what: &str| {
        let n = number(state);
        if n > 0 {
            reporter.note(&format!("{} {what}", count(n, "output")));
        }
    };
    note(
        OutputState::OtherOptions,
        "made with other options or by another build: made again",
    );
    note(
        OutputState::Incomplete,
        "without a file of materials: made again",
    );
    note(OutputState::OtherInput, "made of another input: made again");
    note(
        OutputState::Newer,
        "kept, though it is not written down with which options they were made: --force makes them again",
    );
}

/// Reports a cell when it is finished.
pub(super) fn tell(entry: &Entry<'_>, one: bool, reporter: &Reporter) {
    match entry {
        Entry::Done(cell) => {
            reporter.result(&line(cell));
            if one || reporter.verbose() {
                warn(cell, reporter);
            }
        }
        Entry::Failed { error, .. } => reporter.error(error),
        Entry::Skipped { .. } => {}
    }
}

/// The line of a cell.
pub(super) fn line(cell: &CellReport) -> String {
    format!(
        "{} → {}: {} vertices, {} faces, {}, {} in {:.3} s",
        cell.file,
        match &cell.parts[..] {
            [] => cell.out.clone(),
            parts => {
                let outs: Vec<&str> = parts.iter().map(|part| &*part.out).collect();
                outs.join(", ")
            }
        },
        cell.vertices,
        cell.triangles + cell.quads,
        if cell.closed { "closed" } else { "NOT CLOSED" },
        count(cell.components, "part"),
        cell.seconds.of_mesh(),
    )
}

pub(super) fn warn(cell: &CellReport, reporter: &Reporter) {
    for warning in &cell.warnings {
        let place = place(&cell.file, warning.line());
        reporter.warning(&format!("{place} {warning} ({})", warning.code()));
    }
}

/// Prints the summary to standard error. `kept`: how many of the entries were not to be done.
pub(super) fn summarize(entries: &[Entry<'_>], kept: usize, clock: Instant, reporter: &Reporter) {
    let mut done = 0;
    let mut causes: BTreeMap<&'static str, usize> = BTreeMap::new();
    let is_skipped = |entry: &&Entry<'_>| matches!(entry, Entry::Skipped { .. });
    let skipped = entries.iter().filter(is_skipped).count();
    for entry in entries {
        if let Entry::Done(cell) = entry {
            done += 1;
            for warning in &cell.warnings {
                *causes.entry(warning.code()).or_default() += 1;
            }
        }
    }
    let to_do = entries.len() - kept;
    if to_do > 1 {
        tell_warnings(&causes, reporter);
    }
    if to_do != 1 || kept > 0 {
        reporter.note(&format!(
            "{} meshed, {skipped} skipped, {} failed in {:.2} s",
            count(done, "cell"),
            reporter.failures(),
            clock.elapsed().as_secs_f64()
        ));
    }
}
