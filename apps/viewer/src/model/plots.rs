//! Plots of measures of the selected cells, in *Inspect*.

use std::sync::Arc;

use neurotess::plot::{Measure, Plot, SHOLL_STEP};

use crate::model::ids::SourceId;
use crate::model::revision::Revision;

/// What is plotted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasureForm {
    /// The measure; none: the plot is closed.
    pub measure: Option<Measure>,
    /// Distance (µm) of the spheres of Sholl profiles.
    pub step: f64,
}

impl Default for MeasureForm {
    fn default() -> Self {
        Self {
            measure: None,
            step: SHOLL_STEP,
        }
    }
}

/// What a plot of measures depends on: what is measured, of which tracings, and the revision of these.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureKey {
    pub(crate) measure: Measure,
    pub(crate) step: f64,
    pub(crate) sources: Vec<SourceId>,
    pub(crate) geometry: Revision,
}

/// A plot, once it is computed.
#[derive(Clone, Debug, Default)]
pub struct MeasurePlot {
    /// What is plotted.
    pub form: MeasureForm,
    /// The newest plot and what it is of, or why there is none.
    pub(crate) plot: Option<(MeasureKey, Result<Arc<Plot>, String>)>,
}
