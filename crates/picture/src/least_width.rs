//! How thin a neurite may be drawn.

/// The least width (pixels) of neurites that pictures of so many neurons begin with: nine of ten places of a thin
/// axon then have a contrast of 3.3 : 1 or more to white, half of them 5.4 : 1, and 1.9 and 3 : 1 where they are as
/// wide as they are. None in a crowd: 200 cells of a circuit hide one another, while faint axons show how dense
/// they are, and let thick dendrites through.
pub fn usual_least_width(neurons: usize) -> f32 {
    if neurons <= CROWD { 1.5 } else { 0.0 }
}

/// The most neurons that [`usual_least_width`] takes for single ones.
pub(crate) const CROWD: usize = 50;
