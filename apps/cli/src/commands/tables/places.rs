//! What is read of a report: frames, and compartments of the selected nodes.

use std::collections::BTreeSet;

use neurotess::circuit::{Circuit, NodeRef, Report, ReportPopulation, TimeAxis};

use neurotess::options::words::Time;

/// A population of a report, and the indices of its nodes that are selected.
pub(super) type Chosen<'a> = (&'a ReportPopulation, Vec<usize>);

pub(super) fn chosen<'a>(
    report: &'a Report,
    circuit: &Circuit,
    selected: &BTreeSet<NodeRef>,
) -> anyhow::Result<Vec<Chosen<'a>>> {
    let mut all = Vec::new();
    for population in &report.populations {
        let nodes = population.nodes_in(circuit)?;
        let indices = nodes.iter().enumerate();
        let indices = indices.filter(|(_, node)| selected.contains(node));
        all.push((population, indices.map(|(index, _)| index).collect()));
    }
    Ok(all)
}

/// Frames of an axis at the times that are asked for.
pub(super) fn frames(axis: &TimeAxis, time: Option<Time>) -> Vec<u64> {
    let every = |from: f64, to: f64| -> Vec<u64> {
        let margin = 1e-6 * axis.step;
        let within = |time: f64| time > from - margin && time < to - margin;
        let frames = 0..axis.frames;
        frames.filter(|&f| within(axis.time_of(f))).collect()
    };
    match time {
        None => (0..axis.frames).collect(),
        Some(Time::At(time)) => axis.frame_at(time).into_iter().collect(),
        Some(Time::Series(from, to, None)) => every(from, to),
        Some(Time::Series(from, to, Some(step))) => {
            let count = ((to - from) / step - 1e-6).ceil().max(1.0) as u64;
            let mut frames: Vec<u64> = (0..count)
                .map_while(|k| Some(from + k as f64 * step).filter(|&time| time < axis.end))
                .filter_map(|time| axis.frame_at(time))
                .collect();
            frames.dedup();
            frames
        }
    }
}

/// Compartments that are read, and the node of each.
pub(super) struct Places {
    compartments: Vec<u64>,
    pub(super) nodes: Vec<NodePlaces>,
}

/// Compartments of a node.
pub(super) struct NodePlaces {
    pub(super) id: u64,
    pub(super) count: usize,
    /// Section and place along it of each; empty if only their mean is written.
    pub(super) along: Vec<(u64, f32)>,
}

impl Places {
    /// The compartments that are read.
    pub(super) fn compartments(&self) -> &[u64] {
        &self.compartments
    }

    /// Names of the lines of a figure: of each compartment, or of each node.
    pub(super) fn names(&self) -> Vec<String> {
        let of = |node: &NodePlaces| match node.along.is_empty() {
            true => vec![format!("node {}", node.id)],
            false => {
                let name = |(section, along): &(u64, f32)| {
                    format!("node {}, section {section} at {along:.2}", node.id)
                };
                node.along.iter().map(name).collect()
            }
        };
        self.nodes.iter().flat_map(of).collect()
    }

    /// Values of these lines, from those of the compartments.
    pub(super) fn lines(&self, values: &[f32]) -> Vec<f64> {
        let mut rest = values;
        let mut lines = Vec::new();
        for node in &self.nodes {
            let (own, others) = rest.split_at(node.count.min(rest.len()));
            rest = others;
            match node.along.is_empty() {
                true => lines.push(mean(own)),
                false => lines.extend(own.iter().map(|&value| f64::from(value))),
            }
        }
        lines
    }

    pub(super) fn of(
        population: &ReportPopulation,
        nodes: &[usize],
        per_compartment: bool,
    ) -> anyhow::Result<Self> {
        let mut places = Self {
            compartments: Vec::new(),
            nodes: Vec::new(),
        };
        for &index in nodes {
            let range = population.compartment_range(index);
            let count = (range.end - range.start) as usize;
            places.compartments.extend(range);
            let along = match per_compartment {
                true => population.compartments(index)?,
                false => Vec::new(),
            };
            let along = along.iter().map(|c| (c.section, c.along)).collect();
            places.nodes.push(NodePlaces {
                id: population.nodes[index],
                count,
                along,
            });
        }
        Ok(places)
    }
}

/// The mean of values.
pub(super) fn mean(values: &[f32]) -> f64 {
    let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
    sum / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_frames() {
        let axis = TimeAxis {
            start: 10.0,
            end: 12.0,
            step: 0.5,
            frames: 4,
        };
        let found = |text: &str| frames(&axis, Some(text.parse().expect("a time")));
        assert_eq!(frames(&axis, None), [0, 1, 2, 3]);
        assert_eq!(found("10.7"), [1]);
        assert_eq!(found("10.5:11.5"), [1, 2]);
        assert_eq!(found("0:100:1"), [0, 2]);
        assert_eq!(found("10:12:0.1"), [0, 1, 2, 3], "each frame once");
        assert!(found("3").is_empty());
    }
}
