//! Traces of the document: their names, their values, and the plot of them.

use std::sync::Arc;

use glam::DVec3;
use neurotess::coloring::TracedCompartment;
use neurotess::plot::{Axis, Data, Plot, Series};

use super::State;
use crate::model::document::{Trace, TracePlace};
use crate::model::revision::Revision;
use crate::model::traces::{ReadTrace, TraceContent};

/// Revisions that the plot depends on: of the traces, of what was read, and of the neurons' names.
pub(super) type PlotKey = [Revision; 3];

impl State {
    /// Places that are plotted and were not read yet.
    pub(crate) fn traces_due(&self) -> Vec<TracePlace> {
        if !self.traces.open {
            return Vec::new();
        }
        let places = self.document.traces.iter().map(|trace| trace.place);
        let due = places.filter(|place| self.traces.of(*place).is_none());
        due.collect()
    }

    /// The plot of what was read.
    pub fn trace_plot(&self) -> Arc<Plot> {
        let key = [
            self.document.traces.revision(),
            self.traces.revision(),
            self.document.neurons.revisions().members,
        ];
        self.derived.traces.get(key, || self.plot_of_traces())
    }

    fn plot_of_traces(&self) -> Plot {
        let facts = self.playback.facts.as_ref();
        let spikes = facts.is_some_and(|facts| facts.spikes);
        let (title, unit) = facts.map_or(("", ""), |f| (&f.title, &f.unit));
        let y = match spikes {
            true => Axis::new("neuron", ""),
            false => Axis::new(if title.is_empty() { "value" } else { title }, unit),
        };
        let series = self.document.traces.iter().enumerate().map(|(row, trace)| {
            let read = self.traces.of(trace.place);
            let data = read.map_or(Data::Line(Vec::new()), |read| data(read, row + 1));
            Series {
                name: self.trace_name(trace.place),
                color: trace.color,
                data,
            }
        });
        Plot {
            title: title.to_owned(),
            x: Axis::new("time", "ms"),
            y,
            series: series.collect(),
        }
    }

    /// The name of a place: its cell, section and compartment.
    pub(crate) fn trace_name(&self, place: TracePlace) -> String {
        let neuron = self.document.neurons.get(place.neuron);
        let name = neuron.map_or("", |neuron| neuron.name.as_str());
        let read = self.traces.of(place);
        if read.is_some_and(|read| matches!(read.content, TraceContent::Spikes(_))) {
            return name.to_owned();
        }
        match read.and_then(|read| read.compartment()) {
            Some(compartment) => format!("{name}, {}", part_name(compartment)),
            None => match place.section {
                Some(section) => format!("{name}, section {section}"),
                None => format!("{name}, soma"),
            },
        }
    }

    /// The place that stands for all places of its compartment: that of the trace which shows it, or else its middle.
    pub(crate) fn middle_of_compartment(&self, place: TracePlace) -> TracePlace {
        let read = |trace: &Trace| Some((trace.place, Arc::clone(self.traces.of(trace.place)?)));
        let all = self.document.traces.iter().filter_map(read);
        let of_neuron = all.filter(|(of, _)| of.neuron == place.neuron);
        let mut snapped = place;
        for (of, read) in of_neuron {
            match &read.content {
                TraceContent::Spikes(_) => return of,
                TraceContent::Nothing => {}
                TraceContent::Values { compartment, .. } => {
                    let section = compartment.section.map(|section| section.0);
                    // A section that another trace of the neuron shows although it was clicked elsewhere: there is
                    // one compartment only.
                    if section != of.section {
                        return of;
                    }
                    if section != place.section {
                        continue;
                    }
                    let nearest = nearest(&compartment.all, place.along);
                    if nearest == Some(compartment.number) {
                        return of;
                    }
                    let middle = nearest.and_then(|i| compartment.all.get(i));
                    snapped.along = middle.copied().unwrap_or(place.along);
                }
            }
        }
        snapped
    }

    /// Where a trace is in the world (µm), as it is drawn; none if its neuron does not show.
    pub(crate) fn trace_position(&self, trace: &Trace) -> Option<DVec3> {
        let TracePlace {
            neuron,
            section,
            along,
        } = trace.place;
        if !self.document.neurons.shows(neuron) {
            return None;
        }
        let compartment = self.traces.of(trace.place);
        let compartment = compartment.and_then(|read| read.compartment());
        let (section, along) = match compartment {
            Some(compartment) => (compartment.section.map(|s| s.0), compartment.along),
            None => (section, along),
        };
        let morphology = &self.source_of(neuron)?.morphology;
        let location = TracePlace::location(section, along, morphology)?;
        let placement = *self.placements().get(neuron)?;
        Some(placement.world_from_cell(location.position(morphology)))
    }
}

/// The name of a compartment in its cell.
pub(crate) fn part_name(compartment: &TracedCompartment) -> String {
    let Some(section) = compartment.section else {
        return "soma".into();
    };
    let number = compartment.number + 1;
    match compartment.all.len() {
        0 | 1 => format!("section {}", section.0),
        all => format!("section {}, compartment {number}/{all}", section.0),
    }
}

/// Index of the number that is nearest.
fn nearest(all: &[f32], along: f32) -> Option<usize> {
    let far = |i: &usize| (all[*i] - along).abs();
    (0..all.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
}

fn data(read: &ReadTrace, row: usize) -> Data {
    match &read.content {
        TraceContent::Values { time, values, .. } => {
            // Without the digits that the sum of steps made.
            let rounded = |time: f64| (time * 1e9).round() / 1e9;
            let points = (0..).zip(values);
            let points = points.map(|(i, value)| [rounded(time.time_of(i)), f64::from(*value)]);
            Data::Line(points.collect())
        }
        TraceContent::Spikes(times) => Data::Ticks {
            x: times.clone(),
            y: row as f64,
        },
        TraceContent::Nothing => Data::Line(Vec::new()),
    }
}
