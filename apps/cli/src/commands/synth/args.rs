//! `neurotess synth`: its options.

use std::path::PathBuf;

use clap::Args;
use neurotess::synth::Kind;

use crate::report::at_least_one;

/// Where what is grown goes.
#[derive(Args, Clone, Debug)]
pub(crate) struct GrownArgs {
    /// A file OUT.swc for one cell, - for standard output; a folder for several cells and for a
    /// circuit
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) force: bool,
}

/// `neurotess synth`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess synth pyramidal -o cell.swc --seed 7
  neurotess synth purkinje -o cells/ --count 1000 --points 5000
  neurotess synth circuit -o circuit/ --neurons 10000 --morphologies 100")]
pub(crate) struct SynthArgs {
    /// Kind of cell: pyramidal, purkinje, granule, basket, motor or star; or circuit: many cells,
    /// with spikes and a report, as SONATA
    #[arg(value_parser = what)]
    pub(crate) kind: What,
    #[command(flatten)]
    pub(crate) out: GrownArgs,
    /// Seed of the first cell; the next ones count up
    #[arg(long, default_value_t = 1, value_name = "S")]
    pub(crate) seed: u64,
    /// Points of a cell, about, 50 to 500000 [default: what is usual for the kind]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(50..=500_000))]
    pub(crate) points: Option<u32>,
    /// Number of cells; more than one makes OUT a folder
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = at_least_one)]
    pub(crate) count: usize,
    /// Let branches grow through one another, as careless tracings have them
    #[arg(long)]
    pub(crate) may_cross: bool,
    /// Cells of the circuit, up to 10 million
    #[arg(long, default_value_t = 1000, value_name = "N", help_heading = "Circuit",
          value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub(crate) neurons: u32,
    /// Distinct morphologies of the circuit
    #[arg(long, default_value_t = 10, value_name = "M", help_heading = "Circuit",
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) morphologies: u32,
    /// Cells that the circuit's report has voltages of
    #[arg(long, default_value_t = 100, value_name = "N", help_heading = "Circuit",
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) reported: u32,
    /// Synapses onto each cell of the circuit
    #[arg(long, default_value_t = 0, value_name = "N", help_heading = "Circuit",
          value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub(crate) synapses: u32,
}

/// What `neurotess synth` makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    /// Cells of a kind.
    Cells(Kind),
    /// A circuit.
    Circuit,
}

/// What a name stands for, for the command line.
pub(crate) fn what(name: &str) -> Result<What, String> {
    if name == "circuit" {
        return Ok(What::Circuit);
    }
    let kind = name.parse::<Kind>();
    kind.map(What::Cells)
        .map_err(|e| format!("{e}, or circuit"))
}
