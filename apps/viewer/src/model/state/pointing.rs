//! What is under the cursor, and what was clicked last.

use crate::model::document::SourceId;
use crate::model::markers::MarkerRef;

use super::Picked;

/// What is under the cursor, and what was clicked last.
#[derive(Clone, Debug, Default)]
pub struct Pointing {
    /// The part under the cursor, in the picture or in the tree.
    pub hovered: Option<Picked>,
    /// The synapse or point under the cursor.
    pub hovered_marker: Option<MarkerRef>,
    /// The neurite whose ring's slider is under the cursor or being dragged.
    pub touched: Option<(SourceId, u32)>,
    /// The dimension whose line in the list is under the cursor.
    pub dimension: Option<usize>,
    /// The part that was clicked last.
    pub picked: Option<Picked>,
    /// The synapse or point that was clicked last.
    pub picked_marker: Option<MarkerRef>,
    /// The neuron whose line in the list was clicked last: where a range begins.
    pub listed: Option<usize>,
    /// A part that the tree must scroll to.
    pub reveal: Option<Picked>,
}
