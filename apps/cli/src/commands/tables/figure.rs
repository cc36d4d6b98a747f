//! `neurotess report --svg`: values over time, or a raster of spikes, as a figure.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::Path;

use itertools::Itertools;
use neurotess::circuit::{Circuit, NodeRef, Spikes};
use neurotess::output::write_into;
use neurotess::plot::{Axis, Data, Plot, Series};

use super::places::{Chosen, Places, frames};
use crate::io::output;
use crate::report::usage;
use neurotess::options::words::Time;

/// Size of the figure (pixels).
const SIZE: [u32; 2] = [900, 480];
/// Most lines, and most rows of spikes.
const MOST: [usize; 2] = [100, 5000];

/// The plot of values: a line for each compartment, or for the mean of each node.
pub(super) fn values(
    chosen: &[Chosen<'_>],
    time: Option<Time>,
    per_compartment: bool,
) -> anyhow::Result<Plot> {
    let mut plot = Plot {
        x: Axis::new("time", "ms"),
        ..Plot::default()
    };
    for (population, nodes) in chosen {
        let places = Places::of(population, nodes, per_compartment)?;
        let names = places.names();
        few(plot.series.len() + names.len(), MOST[0])?;
        let first = plot.series.len();
        let mut lines = vec![Vec::new(); names.len()];
        for frame in frames(&population.time, time) {
            let at = (population.time.time_of(frame) * 1e9).round() / 1e9;
            let values = population.values(frame, places.compartments())?;
            for (line, value) in lines.iter_mut().zip_eq(places.lines(&values)) {
                line.push([at, value]);
            }
        }
        let series = (first..).zip(names.into_iter().zip(lines));
        let series = series.map(|(color, (name, line))| Series::new(name, color, Data::Line(line)));
        plot.series.extend(series);
        plot.y = Axis::new("value", population.units.as_str());
    }
    Ok(plot)
}

/// A raster of spikes with a row for each node that fires.
pub(super) fn raster(
    spikes: &Spikes,
    circuit: &Circuit,
    selected: &BTreeSet<NodeRef>,
    within: impl Fn(f64) -> bool,
) -> anyhow::Result<Plot> {
    let mut rows: BTreeMap<NodeRef, (String, Vec<f64>)> = BTreeMap::new();
    for population in &spikes.populations {
        let nodes = population.nodes_in(circuit, &spikes.file)?;
        let all = population
            .times
            .iter()
            .zip_eq(&population.nodes)
            .zip_eq(nodes);
        for ((&at, id), node) in
            all.filter(|((at, _), node)| within(**at) && selected.contains(node))
        {
            let row = rows.entry(node);
            let row = row.or_insert_with(|| (format!("{} {id}", population.name), Vec::new()));
            row.1.push(at);
        }
    }
    few(rows.len(), MOST[1])?;
    let series = rows.into_values().enumerate().map(|(row, (name, x))| {
        let y = (row + 1) as f64;
        Series::new(name, row, Data::Ticks { x, y })
    });
    Ok(Plot {
        x: Axis::new("time", "ms"),
        y: Axis::new("neuron", ""),
        series: series.collect(),
        ..Plot::default()
    })
}

fn few(count: usize, most: usize) -> anyhow::Result<()> {
    match count > most {
        true => usage(format!(
            "--svg: {count} lines are more than the {most} that a figure can show: choose fewer cells (--nodes), or \
             --per node"
        )),
        false => Ok(()),
    }
}

/// Writes a figure.
pub(super) fn write(plot: &Plot, out: &Path, force: bool) -> anyhow::Result<()> {
    let text = plot.svg(SIZE);
    let output = output::begin(out, force)?;
    write_into(output, out, |to| to.write_all(text.as_bytes()))?;
    Ok(())
}
