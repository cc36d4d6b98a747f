//! Values of a simulation on the membrane: those of a report at a time, or spikes that fade.
//!
//! **Theory.** Compartments are matched with neurons once, when a recording is opened. After that,
//! showing another time only reads the values of the neurons in question, and nothing else of the
//! scene changes. A color key is an index into a neuron's own values, so that neurons of one cell
//! share their keys on the device.
//!
//! **Practice.** The first neuron of a cell that has values determines where compartments are; for
//! another one of the same cell that was cut otherwise, the nearest compartment of the same section
//! is taken.

mod unknown;

use std::collections::{HashMap, HashSet};
use std::path::Path;

use itertools::Itertools;
use neurotess_circuit::{
    Circuit, CircuitError, Compartment, NodeRef, RecordingFile, Report, ReportPopulation,
    SpikePopulation, Spikes, TimeAxis,
};
use neurotess_picture::color::category;
use thiserror::Error;

use crate::categorical::first_values;
use crate::compartments::{matched, on_cell};
use crate::own_series::{Memory, OwnSeries};
use crate::report_frame::{NO_BOUNDS, PopulationMatch, ReportFrame, merged, opened};
use crate::scheme::{Cell, ColorScheme, Coloring};
use unknown::Unknown;
pub use unknown::UnknownSections;

/// Default time (ms) after which the flash of a spike has faded to about a third.
pub const DECAY: f64 = 5.0;
/// Time (ms) between two steps through spikes, which have no frames.
const SPIKE_STEP: f64 = 0.5;
/// Range of the values of flashes, which fade from 1 to 0.
const OF_FLASHES: [f32; 2] = [0.0, 1.0];
/// Most values that are read to find a range, and the fewest frames that they are taken from.
const RANGE_VALUES: u64 = 4_000_000;
const RANGE_FRAMES: u64 = 32;

/// Why there are no values. Displays as `FILE: what: what to do`.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// The file is invalid, or belongs to another circuit.
    #[error(transparent)]
    Circuit(#[from] CircuitError),
    /// A time beyond the recording.
    #[error("{file}: has no values at {time} ms: choose a time from {start} to below {end}")]
    NoValues {
        /// The file.
        file: String,
        /// The requested time (ms).
        time: f64,
        /// Start of the recording (ms).
        start: f64,
        /// End of the recording (ms).
        end: f64,
    },
}

/// A recording, matched with the instances of a scene.
#[derive(Debug)]
pub struct Recording {
    /// The file as it was named.
    pub file: String,
    /// What is recorded, for legends.
    pub title: String,
    /// Unit of the values; empty if unknown.
    pub unit: String,
    /// What is odd in the file, though it can be read.
    pub warnings: Vec<String>,
    /// Times (ms) of its frames, or of steps through spikes.
    pub time: TimeAxis,
    color_keys: Vec<Vec<u32>>,
    pub(crate) has_values: Vec<bool>,
    unknown: Option<UnknownSections>,
    pub(crate) source: Source,
}

/// The instances that show each node of a population of spikes, by id.
pub(crate) type InstancesOfNode = HashMap<u64, Vec<usize>>;

#[derive(Debug)]
pub(crate) enum Source {
    Report(Report, Vec<PopulationMatch>),
    /// Spikes, and the instances by population of the file.
    Spikes(Spikes, Vec<InstancesOfNode>),
    /// Numbers of one's own.
    Memory(Memory),
}

impl Recording {
    /// Opens a recording: a file, or one that the circuit names. `instances`: the cell that each neuron shows and its node; none for a
    /// neuron of no circuit, or of another one.
    ///
    /// # Errors
    /// The file is invalid, or belongs to another circuit.
    pub fn open(
        path: &Path,
        circuit: &Circuit,
        cells: &[Cell<'_>],
        instances: &[(usize, Option<NodeRef>)],
    ) -> Result<Self, RecordingError> {
        let path = &circuit.report_of_sections(path)?;
        let opened = circuit.open_recording(path)?;
        let warnings = opened.warnings().iter().map(ToString::to_string).collect();
        let mut recording = match opened {
            RecordingFile::Report(report) => Self::of_report(report, circuit, cells, instances)?,
            RecordingFile::Spikes(spikes) => Self::of_spikes(spikes, circuit, cells, instances)?,
        };
        recording.warnings = warnings;
        let title = path.file_stem().unwrap_or_default().to_string_lossy();
        recording.file = path.display().to_string();
        recording.title = title.replace('_', " ");
        Ok(recording)
    }

    fn of_report(
        report: Report,
        circuit: &Circuit,
        cells: &[Cell<'_>],
        instances: &[(usize, Option<NodeRef>)],
    ) -> Result<Self, CircuitError> {
        let mut cuts: Vec<Option<Vec<Compartment>>> = vec![None; cells.len()];
        let points = cells.iter().map(|cell| cell.mesh.tracing.len());
        let mut color_keys: Vec<Vec<u32>> = points.map(|n| vec![category(0); n]).collect();
        let mut has_values = vec![false; instances.len()];
        let mut unit = String::new();
        let mut parts = Vec::new();
        let mut unknown = Unknown::new(cells);
        for population in &report.populations {
            let nodes = population.nodes_in(circuit)?;
            let rows: HashMap<NodeRef, usize> = nodes.into_iter().zip(0..).collect();
            let mut part = PopulationMatch::default();
            for (instance, (cell, node)) in instances.iter().enumerate() {
                let Some(&row) = node.as_ref().and_then(|node| rows.get(node)) else {
                    continue;
                };
                let own = population.compartments(row)?;
                unknown.count(*cell, population.nodes[row], &own);
                if cuts[*cell].is_none() {
                    color_keys[*cell] = on_cell(&cells[*cell], &own);
                }
                let cut = cuts[*cell].get_or_insert_with(|| own.clone());
                let first = population.compartment_range(row).start;
                let start = part.compartments.len();
                let compartments = matched(cut, &own);
                part.compartments
                    .extend(compartments.iter().map(|&k| first + k as u64));
                part.spans.push((instance, start..part.compartments.len()));
                part.rows.push(row);
                has_values[instance] = true;
            }
            parts.push(part);
            unit.clone_from(&population.units);
        }
        Ok(Self {
            file: String::new(),
            title: String::new(),
            warnings: Vec::new(),
            unit,
            time: together(&report.populations),
            color_keys,
            has_values,
            unknown: unknown.found,
            source: Source::Report(report, parts),
        })
    }

    fn of_spikes(
        spikes: Spikes,
        circuit: &Circuit,
        cells: &[Cell<'_>],
        instances: &[(usize, Option<NodeRef>)],
    ) -> Result<Self, CircuitError> {
        let mut of_node: HashMap<NodeRef, Vec<usize>> = HashMap::new();
        for (instance, (_, node)) in instances.iter().enumerate() {
            if let Some(node) = node {
                of_node.entry(*node).or_default().push(instance);
            }
        }
        let mut firing = Vec::new();
        let mut known = HashSet::new();
        for population in &spikes.populations {
            let nodes = population.nodes_in(circuit, &spikes.file)?;
            known.extend(nodes.iter().map(|node| node.population));
            let shown = nodes
                .iter()
                .zip_eq(&population.nodes)
                .filter_map(|(node, &id)| {
                    let instances = of_node.get(node)?;
                    Some((id, instances.clone()))
                });
            firing.push(shown.collect());
        }
        // A neuron that never fires has values, all 0.
        let of_known = |node: &Option<NodeRef>| node.is_some_and(|n| known.contains(&n.population));
        let has_values = instances.iter().map(|(_, node)| of_known(node)).collect();
        Ok(Self {
            file: String::new(),
            title: String::new(),
            warnings: Vec::new(),
            unit: String::new(),
            time: steps_through(&spikes),
            color_keys: first_values(cells),
            has_values,
            unknown: None,
            source: Source::Spikes(spikes, firing),
        })
    }

    /// A recording of numbers in memory. `instances`: the cell that each neuron of the scene shows.
    ///
    /// # Panics
    /// If cells and series differ in number, or a series has other numbers of values than it says.
    pub fn of_series(series: OwnSeries, cells: &[Cell<'_>], instances: &[usize]) -> Self {
        let (title, unit, time) = (series.title.clone(), series.unit.clone(), series.time);
        let (memory, color_keys) = Memory::new(series, cells, instances);
        Self {
            file: match title.is_empty() {
                true => "values".into(),
                false => title.clone(),
            },
            title,
            warnings: Vec::new(),
            unit,
            time,
            color_keys,
            has_values: (0..instances.len())
                .map(|instance| memory.has_values(instance))
                .collect(),
            unknown: None,
            source: Source::Memory(memory),
        }
    }

    /// Whether it holds spikes, which have no frames.
    pub fn is_of_spikes(&self) -> bool {
        matches!(self.source, Source::Spikes(..))
    }

    /// Number of neurons that it was matched with.
    pub fn places(&self) -> usize {
        self.has_values.len()
    }

    /// Number of neurons that have no values.
    pub fn without(&self) -> usize {
        self.has_values.iter().filter(|has| !**has).count()
    }

    /// Compartments whose section no shown cell has, if there are any.
    pub fn unknown_sections(&self) -> Option<&UnknownSections> {
        self.unknown.as_ref()
    }

    /// Color keys of cells, the same for all times.
    pub fn color_keys(&self) -> &[Vec<u32>] {
        &self.color_keys
    }

    /// Values at a time (ms) of the neurons for which `shows` is true; the others have none.
    /// `decay`: time (ms) after which the flash of a spike has faded to about a third.
    ///
    /// # Errors
    /// The recording has no values at that time, or the file is invalid.
    pub fn at(
        &self,
        time: f64,
        decay: f64,
        shows: &dyn Fn(usize) -> bool,
    ) -> Result<ReportFrame, RecordingError> {
        match &self.source {
            Source::Report(report, parts) => self.values_at(report, parts, time, shows),
            Source::Spikes(spikes, firing) => {
                let flashes = |(population, instances): (&SpikePopulation, &InstancesOfNode)| {
                    let lit = population.flashes(time, decay).into_iter();
                    let of = |(id, flash)| {
                        instances
                            .get(&id)
                            .map(|instances| (instances.clone(), flash))
                    };
                    lit.filter_map(of).collect::<Vec<_>>()
                };
                let all = spikes.populations.iter().zip_eq(firing).flat_map(flashes);
                Ok(self.flashes(all, shows))
            }
            Source::Memory(memory) => {
                let frame = memory.frame(time, shows);
                frame.ok_or_else(|| self.no_values(time))
            }
        }
    }

    fn values_at(
        &self,
        report: &Report,
        parts: &[PopulationMatch],
        time: f64,
        shows: &dyn Fn(usize) -> bool,
    ) -> Result<ReportFrame, RecordingError> {
        let mut frame_values = ReportFrame::none(self.has_values.len());
        let mut any = false;
        for (population, part) in report.populations.iter().zip_eq(parts) {
            let Some(frame) = population.time.frame_at(time) else {
                continue;
            };
            any = true;
            frame_values.read(population, part, frame, shows)?;
        }
        if !any {
            return Err(self.no_values(time));
        }
        Ok(frame_values)
    }

    pub(crate) fn no_values(&self, time: f64) -> RecordingError {
        let axis = &self.time;
        RecordingError::NoValues {
            file: self.file.clone(),
            time,
            start: axis.start,
            end: axis.time_of(axis.frames),
        }
    }

    fn flashes(
        &self,
        lit: impl Iterator<Item = (Vec<usize>, f32)>,
        shows: &dyn Fn(usize) -> bool,
    ) -> ReportFrame {
        let mut flashes = vec![0.0; self.has_values.len()];
        for (instances, flash) in lit {
            for instance in instances {
                flashes[instance] = flash;
            }
        }
        let mut frame_values = ReportFrame::none(self.has_values.len());
        for (instance, flash) in flashes.into_iter().enumerate() {
            if shows(instance) && self.has_values[instance] {
                frame_values.put(instance, [flash]);
            }
        }
        frame_values
    }

    /// Least and greatest value, over the whole recording, of the neurons for which `shows` is
    /// true: of all frames, or of some that are spread evenly if there are too many.
    ///
    /// # Errors
    /// The file is invalid.
    pub fn range(&self, shows: &dyn Fn(usize) -> bool) -> Result<[f32; 2], RecordingError> {
        if self.is_of_spikes() {
            return Ok(OF_FLASHES);
        }
        let axis = &self.time;
        let values = self.at(axis.start, DECAY, shows)?.len() as u64;
        let affordable = RANGE_VALUES / values.max(1);
        let frames = affordable.max(RANGE_FRAMES).min(axis.frames.max(1));
        let frame = |i: u64| i * axis.frames.saturating_sub(1) / (frames - 1).max(1);
        self.range_at((0..frames).map(|i| axis.time_of(frame(i))), shows)
    }

    /// Least and greatest value, at these times (ms), of the neurons for which `shows` is true.
    ///
    /// # Errors
    /// The recording has no values at one of the times, or the file is invalid.
    pub fn range_at(
        &self,
        times: impl IntoIterator<Item = f64>,
        shows: &dyn Fn(usize) -> bool,
    ) -> Result<[f32; 2], RecordingError> {
        if self.is_of_spikes() {
            return Ok(OF_FLASHES);
        }
        let mut bounds = NO_BOUNDS;
        for time in times {
            bounds = merged(bounds, self.at(time, DECAY, shows)?.bounds());
        }
        Ok(opened(bounds))
    }

    /// Colors without values: set [`ReportFrame::values`] in the table to show a time.
    pub fn coloring(&self, range: [f32; 2], scheme: &ColorScheme) -> Coloring {
        scheme.scaled(self.color_keys.clone(), &self.title, &self.unit, range)
    }
}

/// A time axis from the first start to the last end of all populations, in the smallest of their
/// steps.
fn together(populations: &[ReportPopulation]) -> TimeAxis {
    let all = || populations.iter().map(|population| &population.time);
    let start = all().map(|axis| axis.start).fold(f64::MAX, f64::min);
    let step = all().map(|axis| axis.step).fold(f64::MAX, f64::min);
    let last = all().map(|axis| axis.time_of(axis.frames));
    let end = last.fold(start, f64::max);
    TimeAxis {
        start,
        end,
        step,
        frames: ((end - start) / step).round() as u64,
    }
}

/// A time axis from 0, or from the first spike if it is earlier, to the last spike.
fn steps_through(spikes: &Spikes) -> TimeAxis {
    let times = || spikes.populations.iter().flat_map(|p| &p.times);
    let start = times().copied().fold(0.0, f64::min);
    let last = times().copied().fold(start, f64::max);
    let frames = ((last - start) / SPIKE_STEP).floor() as u64 + 1;
    TimeAxis {
        start,
        end: start + frames as f64 * SPIKE_STEP,
        step: SPIKE_STEP,
        frames,
    }
}

#[cfg(test)]
mod tests;
