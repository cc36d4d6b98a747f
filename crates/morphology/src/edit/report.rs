//! What an edit has changed.

use serde::Serialize;

use super::nodes::{Edits, Nodes};
use crate::{Morphology, shape};

/// A number before and after an edit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct BeforeAfter<T> {
    /// Before it.
    pub before: T,
    /// After it.
    pub after: T,
}

/// What an edit has changed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct EditReport {
    /// [`Edit::name`](super::Edit::name).
    pub edit: &'static str,
    /// Number of samples, those of somata among them.
    pub samples: BeforeAfter<usize>,
    /// Number of sections.
    pub sections: BeforeAfter<usize>,
    /// Number of pieces that are not connected with one another.
    pub pieces: BeforeAfter<usize>,
    /// Length of all neurites (µm).
    pub length: BeforeAfter<f64>,
    /// Samples that have another place, radius, type or parent now; where other samples have taken their place,
    /// those that went and those that came.
    pub changed: usize,
    /// How far the tracing has moved at most (µm); where samples went, how far these are from the new line.
    pub largest_move: f64,
    /// Greatest change of a sample's radius (µm), of samples that stay.
    pub largest_radius_change: f64,
    /// What could not be done: samples whose neurite has no good radius, pieces too far from others, spines
    /// without room.
    pub left: usize,
    /// Whether samples have other numbers now.
    pub renumbered: bool,
}

impl EditReport {
    pub(super) fn new(
        edit: &'static str,
        before: &Morphology,
        nodes: &Nodes,
        after: &Morphology,
        edits: &Edits,
    ) -> Self {
        let same = edits.largest_move.is_none();
        let change = if same {
            Change::of(nodes, edits)
        } else {
            Change::default()
        };
        let rebuilt = Nodes::of(after);
        let stayed = edits.nodes.len() - edits.came;
        let went_and_came = nodes.nodes.len().abs_diff(stayed) + edits.came;
        let all_new = nodes.nodes.len() + edits.nodes.len() - 2 * nodes.somata;
        Self {
            edit,
            samples: pair(nodes.nodes.len(), rebuilt.nodes.len()),
            sections: pair(before.sections.len(), after.sections.len()),
            pieces: pair(nodes.trees().1, rebuilt.trees().1),
            length: pair(length(before), length(after)),
            changed: match (same, edits.renumbered) {
                (true, _) => change.samples,
                (false, false) => went_and_came,
                (false, true) => all_new,
            },
            largest_move: edits.largest_move.unwrap_or(change.largest_move),
            largest_radius_change: change.largest_radius_change,
            left: edits.left,
            renumbered: edits.renumbered,
        }
    }
}

/// What is different about nodes that are still those that they were.
#[derive(Default)]
struct Change {
    samples: usize,
    largest_move: f64,
    largest_radius_change: f64,
}

impl Change {
    fn of(nodes: &Nodes, edits: &Edits) -> Self {
        let mut change = Self::default();
        for (old, new) in nodes.nodes.iter().zip(&edits.nodes) {
            change.samples += usize::from(old != new);
            change.largest_move = change.largest_move.max(old.position.distance(new.position));
            let radius = (old.radius - new.radius).abs();
            change.largest_radius_change = change.largest_radius_change.max(radius);
        }
        change
    }
}

fn pair<T>(before: T, after: T) -> BeforeAfter<T> {
    BeforeAfter { before, after }
}

fn length(morphology: &Morphology) -> f64 {
    // The sum of nothing would be −0.
    shape::section_lengths(morphology)
        .iter()
        .fold(0.0, |sum, length| sum + length)
}
