//! How fast drawing is, and what is drawn at rest because of that.

use std::collections::VecDeque;
use std::time::Instant;

use super::cost_model::{CostModel, RestMode};

/// How fast drawing is, and how far the full picture is.
pub(super) struct Pace {
    /// When something last moved.
    pub(super) moved: Instant,
    pub(super) phase: RestPhase,
    /// How many times as coarse drafts are, to be drawn in time.
    pub(super) coarser: f32,
    /// Slices of a step of the full picture.
    pub(super) slices: u32,
    /// Times (ms) of the last drafts.
    pub(super) frames: VecDeque<f32>,
    /// Whether a draft is what was drawn last.
    pub(super) drafted: bool,
    /// Whether the last draft was drawn in exploration mode.
    pub(super) explored: bool,
    pub(super) cost_model: CostModel,
    pub(super) rest_mode: RestMode,
    /// Triangles and patches that the picture at rest draws, and all patches, once they are
    /// counted.
    pub(super) counts: Option<[u64; 3]>,
    /// In exploration mode: triangles drawn, and those needed for half a pixel, once they are
    /// known.
    pub(super) surveyed: Option<[u64; 2]>,
    /// Whether the last work was a slice, whose time is measured.
    pub(super) timed: bool,
}

/// Phases of the full picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RestPhase {
    /// Waits, since something has just moved.
    Waits,
    /// The processor draws, or has drawn and what is under the cursor is still to be found out.
    Draws,
    /// Slices are being drawn.
    Slices,
    /// Everything is drawn in exploration mode; finds out what it left out.
    Surveys,
    /// The picture is made static.
    Collects,
    /// Everything is drawn.
    Done,
}

impl Pace {
    /// That of a device, which may be the processor.
    pub(super) fn new(software: bool) -> Self {
        Self {
            moved: Instant::now(),
            phase: RestPhase::Done,
            coarser: if software { 4.0 } else { 1.0 },
            slices: if software { 2 } else { 1 },
            frames: VecDeque::new(),
            drafted: false,
            explored: false,
            cost_model: CostModel::new(software),
            rest_mode: RestMode::Refined,
            counts: None,
            surveyed: None,
            timed: false,
        }
    }
}
