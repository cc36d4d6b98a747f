//! Plots that are saved, and plots of measures.

use std::path::PathBuf;
use std::sync::Arc;

use neurotess::plot::{Measure, Plot};

use super::State;
use crate::model::command::PlotOf;
use crate::model::ids::SourceId;
use crate::model::plots::MeasureKey;
use crate::model::save::SaveRequest;

/// Least distance (µm) of the spheres of Sholl profiles.
const MIN_STEP: f64 = 0.01;

impl State {
    /// The tracings of the selected cells, each once; of the only cell, if none is selected.
    pub(super) fn inspected_sources(&self) -> Vec<SourceId> {
        let neurons = &self.document.neurons;
        match neurons.len() {
            1 => neurons.meant_sources(),
            _ => neurons.selected_sources().collect(),
        }
    }

    /// What the plot of measures is to be of: the tracings of the selected cells, each once; of all, if none is selected
    /// and there is one cell only.
    pub(crate) fn measure_key(&self) -> Option<MeasureKey> {
        let form = self.measures.form;
        let sources = self.inspected_sources();
        let measure = form.measure.filter(|_| !sources.is_empty())?;
        Some(MeasureKey {
            measure,
            step: match measure {
                Measure::Sholl => form.step.max(MIN_STEP),
                _ => 1.0,
            },
            sources,
            geometry: self.sources.geometry(),
        })
    }

    /// The plot of measures, once it is computed: the newest one, and whether it is of the current selection.
    pub fn measure_plot(&self) -> Option<(Result<&Arc<Plot>, &str>, bool)> {
        let key = self.measure_key()?;
        let (of, plot) = self.measures.plot.as_ref()?;
        let plot = plot.as_ref().map_err(String::as_str);
        Some((plot, *of == key))
    }

    /// Saves a plot, if there is one.
    pub(super) fn save_plot(&mut self, of: PlotOf, path: PathBuf) {
        let plot = match of {
            PlotOf::Traces => Some(self.trace_plot()),
            PlotOf::Measure => match self.measure_plot() {
                Some((Ok(plot), true)) => Some(Arc::clone(plot)),
                _ => None,
            },
        };
        match plot.filter(|plot| !plot.is_empty()) {
            Some(plot) => self.save(SaveRequest::Plot(path, plot)),
            None => self.messages.status = "Not saved: there is nothing in the plot yet".into(),
        }
    }
}
