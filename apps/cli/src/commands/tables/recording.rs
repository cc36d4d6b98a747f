//! `neurotess report`: values of a simulation report, or spikes, as a table.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use itertools::Itertools;
use neurotess::circuit::{
    Circuit, Elements, NodeRef, RecordingFile, ReportPopulation, Spikes, TimeAxis,
};
use serde::Serialize;

use super::figure;
use super::places::{Chosen, NodePlaces, Places, chosen, frames, mean};
use crate::io::circuits;
use crate::io::output::{is_standard, reserve_standard};
use crate::io::table::{self, Rows, TableArgs};
use crate::report::{Failure, Reporter, usage};
use neurotess::options::groups::CellSelection;
use neurotess::options::words::Time;

/// `neurotess report`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess report circuit/ --report voltage --nodes 0-9 --time 0:100:0.5 --csv voltage.csv
  neurotess report circuit/ --report voltage --nodes 3 --per node --svg voltage.svg
  neurotess report circuit/ --report spikes.h5 --csv -")]
pub(crate) struct ReportArgs {
    /// A circuit: SONATA, or a scene of your own
    #[arg(value_name = "CIRCUIT")]
    circuit: PathBuf,
    /// A report or spikes: a file, or a name of the circuit's configuration [default: its only one]
    #[arg(long, value_name = "FILE|NAME")]
    report: Option<PathBuf>,
    /// Times (ms): one, or FROM:TO or FROM:TO:STEP, TO excluded [default: all]
    #[arg(long, value_name = "MS", allow_hyphen_values = true)]
    time: Option<Time>,
    /// Rows of a time: each compartment, or the mean of each node's
    #[arg(long, value_name = "WHAT", default_value = "compartment")]
    per: Per,
    /// Draw the values over time, or a raster of spikes, as SVG, instead of writing a table; - for standard output
    #[arg(long, value_name = "FILE", conflicts_with = "csv")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    table: TableArgs,
    #[command(flatten)]
    cells: CellSelection,
}

/// What has a row at each time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Per {
    /// Each compartment
    Compartment,
    /// The mean over the compartments of each node
    Node,
}

/// The JSON document.
#[derive(Serialize)]
struct Written {
    file: String,
    report: String,
    out: String,
    rows: u64,
    nodes: usize,
}

/// Runs the command.
pub(crate) fn run(args: &ReportArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let out = args.svg.as_ref().unwrap_or(&args.table.csv);
    reserve_standard(out, reporter)?;
    let circuit =
        circuits::open(&args.circuit, reporter).map_err(|Failure(why)| anyhow::anyhow!(why))?;
    let selected = args.cells.select(&circuit)?;
    let selected: BTreeSet<NodeRef> = selected.into_iter().collect();
    let path = path_of(&circuit, args.report.as_deref())?;
    let opened = circuit.open_recording(&path)?;
    for warning in opened.warnings() {
        reporter.warning(&warning.to_string());
    }
    let (rows, nodes) = match opened {
        RecordingFile::Report(report) => {
            let chosen = chosen(&report, &circuit, &selected)?;
            let nodes = chosen.iter().map(|(_, nodes)| nodes.len()).sum();
            let rows = match &args.svg {
                Some(svg) => {
                    let per_compartment = args.per == Per::Compartment;
                    let plot = figure::values(&chosen, args.time, per_compartment)?;
                    figure::write(&plot, svg, args.table.force)?;
                    plot.series.len() as u64
                }
                None => {
                    let declared = circuit.declared_report(&path);
                    let elements = declared.map_or(Elements::Sections, |report| report.elements);
                    table::write(&args.table, |rows| values(rows, &chosen, elements, args))?
                }
            };
            (rows, nodes)
        }
        RecordingFile::Spikes(spikes) => match &args.svg {
            Some(svg) => {
                let within = |at| is_within(at, args.time);
                let plot = figure::raster(&spikes, &circuit, &selected, within)?;
                figure::write(&plot, svg, args.table.force)?;
                (plot.series.len() as u64, plot.series.len())
            }
            None => table::write(&args.table, |rows| {
                firing(rows, &spikes, &circuit, &selected, args.time)
            })?,
        },
    };
    if nodes == 0 {
        let what = if args.svg.is_some() {
            "figure"
        } else {
            "table"
        };
        reporter.warning(&format!(
            "none of the selected cells is in the report: the {what} is empty"
        ));
    }
    if !is_standard(out) {
        let (file, what) = (
            out.display(),
            if args.svg.is_some() { "lines" } else { "rows" },
        );
        reporter.result(&format!("{file}: {rows} {what} of {nodes} nodes"));
    }
    reporter.document(&Written {
        file: circuit.file.clone(),
        report: path.display().to_string(),
        out: out.display().to_string(),
        rows,
        nodes,
    })
}

/// The file of a report.
fn path_of(circuit: &Circuit, wanted: Option<&std::path::Path>) -> anyhow::Result<PathBuf> {
    let names = || {
        let names: Vec<&str> = circuit.reports.keys().map(String::as_str).collect();
        match names.is_empty() {
            true => "the circuit names no report that exists".to_owned(),
            false => format!("the circuit has {}", names.join(", ")),
        }
    };
    match wanted {
        Some(wanted) => Ok(circuit.report_file(wanted)?),
        None => match circuit.reports.values().collect::<Vec<_>>()[..] {
            [only] => Ok(only.clone()),
            _ => usage(format!("which report? --report FILE or NAME; {}", names())),
        },
    }
}

/// Writes a report's rows, time by time; returns how many there are.
fn values(
    rows: &mut Rows,
    chosen: &[Chosen<'_>],
    elements: Elements,
    args: &ReportArgs,
) -> anyhow::Result<u64> {
    let per_compartment = args.per == Per::Compartment;
    let mut heading = vec!["time_ms", "population", "node_id"];
    match (per_compartment, elements) {
        (false, _) => {}
        (true, Elements::Sections) => heading.extend(["section", "position"]),
        (true, others) => heading.push(others.name()),
    }
    heading.push("value");
    rows.write_record(&heading)?;
    let mut count = 0;
    let mut any = false;
    for (population, nodes) in chosen {
        let places = Places::of(population, nodes, per_compartment)?;
        let frames = frames(&population.time, args.time);
        any |= !frames.is_empty();
        for frame in frames {
            let values = population.values(frame, places.compartments())?;
            let time = rounded(population.time.time_of(frame));
            count += write_rows(&places, rows, population, elements, &time, &values)?;
        }
    }
    if let (false, Some((population, _))) = (any, chosen.first()) {
        let TimeAxis { start, end, .. } = population.time;
        anyhow::bail!("the report has values from {start} to {end} ms: choose --time within these");
    }
    Ok(count)
}

/// Whether a spike is within the times that are asked for.
fn is_within(at: f64, time: Option<Time>) -> bool {
    match time {
        None => true,
        Some(Time::At(time)) => at == time,
        Some(Time::Series(from, to, _)) => (from..to).contains(&at),
    }
}

/// Writes spikes in the order of time, by population; returns numbers of rows and of nodes that fire.
fn firing(
    rows: &mut Rows,
    spikes: &Spikes,
    circuit: &Circuit,
    selected: &BTreeSet<NodeRef>,
    time: Option<Time>,
) -> anyhow::Result<(u64, usize)> {
    rows.write_record(["time_ms", "population", "node_id"])?;
    let mut fired = BTreeSet::new();
    let mut count = 0;
    for population in &spikes.populations {
        let nodes = population.nodes_in(circuit, &spikes.file)?;
        let spikes = population
            .times
            .iter()
            .zip_eq(&population.nodes)
            .zip_eq(nodes);
        for ((&at, id), node) in spikes {
            if is_within(at, time) && selected.contains(&node) {
                rows.write_record([&rounded(at), &population.name, &id.to_string()])?;
                fired.insert(node);
                count += 1;
            }
        }
    }
    Ok((count, fired.len()))
}

/// Writes the rows of a time.
fn write_rows(
    places: &Places,
    rows: &mut Rows,
    population: &ReportPopulation,
    elements: Elements,
    time: &str,
    values: &[f32],
) -> anyhow::Result<u64> {
    let mut count = 0;
    let mut rest = values;
    for NodePlaces {
        id,
        count: own,
        along,
    } in &places.nodes
    {
        let (own, others) = rest.split_at((*own).min(rest.len()));
        rest = others;
        let node = id.to_string();
        if along.is_empty() {
            let mean = table::cell(mean(own));
            rows.write_record([time, &population.name, &node, &mean])?;
            count += 1;
            continue;
        }
        for ((section, position), value) in along.iter().zip_eq(own) {
            let (section, position) = (section.to_string(), position.to_string());
            let value = table::cell(f64::from(*value));
            let name = &population.name;
            match elements {
                Elements::Sections => {
                    rows.write_record([time, name, &node, &section, &position, &value])?;
                }
                _ => rows.write_record([time, name, &node, &section, &value])?,
            }
            count += 1;
        }
    }
    Ok(count)
}

/// A time (ms) without the digits that its sum of steps made.
fn rounded(time: f64) -> String {
    ((time * 1e9).round() / 1e9).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_no_digits_of_sums() {
        assert_eq!(rounded(0.1 + 0.2), "0.3");
    }
}
