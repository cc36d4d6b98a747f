//! What is of interest in a file of NeuroML: segments and groups of the first morphology.

use crate::sample::Sample;

/// A frustum of a cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Segment {
    pub(super) id: i64,
    pub(super) name: String,
    pub(super) line: u64,
    /// Number of the parent, and how far along it this one begins: 0 at its start, 1 at its end.
    pub(super) parent: Option<(i64, f64)>,
    pub(super) proximal: Option<Sample>,
    pub(super) distal: Option<Sample>,
}

/// Segments that belong together.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    pub(super) id: String,
    /// What it is, in the terms of the NeuroLex and Gene ontologies.
    pub(super) term: String,
    pub(super) members: Vec<i64>,
    /// Many segments at once.
    pub(super) spans: Vec<Span>,
    /// Other groups, by name.
    pub(super) includes: Vec<String>,
}

/// Segments that are told by the first and the last.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) spread: Spread,
    pub(super) from: Option<i64>,
    pub(super) to: Option<i64>,
}

/// What a span has.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spread {
    /// The way from one segment to another.
    Path,
    /// All that is below a segment.
    Subtree,
}

/// What is of interest in a file.
#[derive(Default)]
pub(super) struct Records {
    /// Of the first morphology.
    pub(super) segments: Vec<Segment>,
    pub(super) groups: Vec<Group>,
    pub(super) notes: String,
    /// Morphologies in the file, and the line of the second.
    pub(super) morphologies: u64,
    pub(super) second: u64,
    /// Placed cells of networks, and the line of the first.
    pub(super) instances: u64,
    pub(super) first_instance: u64,
}

impl Span {
    pub(super) fn new(spread: Spread) -> Self {
        Self {
            spread,
            from: None,
            to: None,
        }
    }
}
