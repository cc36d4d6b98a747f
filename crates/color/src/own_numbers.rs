//! Numbers of one's own, whichever there are.

use crate::{OwnSeries, OwnValues};

/// Numbers of one's own.
#[derive(Clone, Debug)]
pub enum OwnNumbers {
    /// That do not change.
    Still(OwnValues),
    /// Over time.
    OverTime(OwnSeries),
}
