//! Values for plots and for the cursor, and plots of measures: read and computed in the background.

use std::sync::Arc;

use neurotess::coloring::Recording;
use neurotess::morphology::Morphology;
use neurotess::plot::{Plot, of_measure};

use super::Viewer;
use crate::io::single::Single;
use crate::io::task::Progress;
use crate::io::traces::{self, Traces};
use crate::model::command::Tab;
use crate::model::document::TracePlace;
use crate::model::plots::MeasureKey;
use crate::model::traces::PointedValue;

/// What is being read and computed.
pub(super) struct PlotWork {
    traces: Single<(), Traces>,
    value: Single<(TracePlace, u64), PointedValue>,
    measure: Single<MeasureKey, Plot>,
    /// The recording that values were read from.
    recording: Option<Arc<Recording>>,
}

impl PlotWork {
    /// `wake` is called when something has been read.
    pub(super) fn new(wake: &Arc<dyn Fn() + Send + Sync>) -> Self {
        Self {
            traces: Single::new(wake),
            value: Single::new(wake),
            measure: Single::new(wake),
            recording: None,
        }
    }

    /// Whether something is being read or computed.
    pub(super) fn is_busy(&self) -> bool {
        self.traces.is_busy() || self.value.is_busy() || self.measure.is_busy()
    }

    /// The progress of reading traces.
    pub(super) fn progress(&self) -> Option<Progress> {
        self.traces.progress()
    }

    /// Drops what is being read: the neurons are others.
    pub(super) fn cancel(&mut self) {
        self.traces.cancel();
        self.value.cancel();
        self.recording = None;
    }
}

impl Viewer {
    /// Takes what has been read and computed, and asks for what is missing.
    pub(super) fn update_plots(&mut self) {
        let recording = self.stage.recording_of(&self.state.document);
        let same = match (&self.plots.recording, recording) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        if !same {
            let recording = recording.cloned();
            self.plots.cancel();
            self.plots.recording = recording;
            self.state.traces.forget();
        }
        self.take_plots();
        self.request_traces();
        self.request_value();
        self.request_measure();
    }

    fn take_plots(&mut self) {
        let file = self.plots.recording.as_ref().map(|r| r.file.clone());
        match self.plots.traces.take() {
            Some((_, Ok(read))) => {
                for (place, read) in read {
                    if let Some(why) = &read.problem {
                        let file = file.clone().unwrap_or_default();
                        self.state.problem(file, why.clone());
                    }
                    self.state.traces.set(place, read);
                }
            }
            Some((_, Err(why))) => self.state.problem("reading traces", why),
            None => {}
        }
        if let Some((of, value)) = self.plots.value.take() {
            // That a value cannot be read is told by the picture, which needs it, too.
            let none = PointedValue { of, value: None };
            self.state.traces.value = Some(value.unwrap_or(none));
        }
        if let Some((of, plot)) = self.plots.measure.take() {
            self.state.measures.plot = Some((of, plot.map(Arc::new)));
        }
    }

    fn request_traces(&mut self) {
        let Some(recording) = self.plots.recording.clone() else {
            return;
        };
        if self.plots.traces.is_busy() {
            return;
        }
        let due = self.state.traces_due();
        let with_tracing = |place: TracePlace| Some((place, self.morphology_of(place.neuron)?));
        let due: Vec<_> = due.into_iter().filter_map(with_tracing).collect();
        if due.is_empty() {
            return;
        }
        // What an undo may bring back is read again: plots need not be kept for ever.
        let plotted: Vec<TracePlace> = self.state.document.traces.iter().map(|t| t.place).collect();
        self.state.traces.keep(|place| plotted.contains(&place));
        let progress = Progress::new("reading traces", "frames", 0);
        let work = move |progress: &Progress| Ok(traces::read(&recording, &due, progress));
        self.plots.traces.start((), progress, work);
    }

    /// Asks for the value under the cursor in the current frame.
    fn request_value(&mut self) {
        let (Some(recording), Some(place), Some(frame)) = (
            self.plots.recording.clone(),
            self.state.traces.pointed,
            self.state.playback.frame(),
        ) else {
            return;
        };
        let of = (place, frame);
        let known = self.state.traces.value.as_ref();
        if recording.is_of_spikes()
            || self.plots.value.is_busy()
            || known.is_some_and(|known| known.of == of)
        {
            return;
        }
        let Some(morphology) = self.morphology_of(place.neuron) else {
            return;
        };
        let progress = Progress::new("reading a value", "values", 1);
        let work = move |_: &Progress| traces::value(&recording, of, &morphology);
        self.plots.value.start(of, progress, work);
    }

    /// Asks for the plot of measures, while it shows.
    fn request_measure(&mut self) {
        let shows = self.state.layout.panels && self.state.layout.tab == Tab::Inspect;
        let Some(key) = self.state.measure_key().filter(|_| shows) else {
            return;
        };
        let known = self.state.measures.plot.as_ref();
        if self.plots.measure.is_busy() || known.is_some_and(|(of, _)| *of == key) {
            return;
        }
        let source = |id| {
            let source = self.state.sources.get(id)?;
            Some((source.name.clone(), Arc::clone(&source.morphology)))
        };
        let cells: Vec<_> = key.sources.iter().filter_map(|&id| source(id)).collect();
        let (measure, step) = (key.measure, key.step);
        let progress = Progress::new("measuring", "cells", cells.len());
        self.plots.measure.start(key, progress, move |_| {
            let cells: Vec<(&str, &Morphology)> = cells
                .iter()
                .map(|(name, morphology)| (name.as_str(), &**morphology))
                .collect();
            of_measure(measure, &cells, step).map_err(|e| e.to_string())
        });
    }

    fn morphology_of(&self, neuron: usize) -> Option<Arc<Morphology>> {
        Some(Arc::clone(&self.state.source_of(neuron)?.morphology))
    }
}
