//! The program's options and commands, as types: --help prints their documentation.

use clap::{CommandFactory, Parser, Subcommand};

use crate::commands::check::{self, CheckArgs};
use crate::commands::convert::{self, ConvertArgs};
use crate::commands::diff::{self, DiffArgs};
use crate::commands::info::{self, InfoArgs};
use crate::commands::mesh::{self, MeshArgs};
use crate::commands::neuroglancer::{self, NeuroglancerArgs};
#[cfg(feature = "render")]
use crate::commands::render::{self, RenderArgs};
use crate::commands::synth::{self, SynthArgs};
use crate::commands::tables::{self, NodesArgs, ReportArgs};
#[cfg(feature = "view")]
use crate::commands::view::{self, ViewArgs};
#[cfg(feature = "gpu")]
use crate::commands::{
    bench::{self, BenchArgs},
    html::{self, HtmlArgs},
};
use crate::commands::{completions, man, version};
use crate::report::{Common, Reporter, usage};

/// The end of the program's help. `$render`: an example for builds that draw pictures.
macro_rules! examples {
    ($render:literal) => {
        concat!(
            "Examples:
  neurotess mesh cell.swc -o cell.ply
",
            $render,
            "  neurotess info cells/ --json
  neurotess mesh cells/ -o meshes/ --format glb --resume --log meshes.jsonl
  neurotess check cell.ply

Exit codes: 0 all inputs done, 1 some failed, 2 wrong usage, 130 interrupted."
        )
    };
}

#[cfg(feature = "render")]
const EXAMPLES: &str = examples!("  neurotess render cell.swc -o cell.png\n");
#[cfg(not(feature = "render"))]
const EXAMPLES: &str = examples!("");

/// From tracings of neurons to closed surface meshes. Lengths are micrometers (µm).
#[derive(Debug, Parser)]
#[command(
    name = "neurotess",
    disable_version_flag = true,
    arg_required_else_help = true
)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) common: Common,
    /// Print the version; with -v the formats and features of this build
    #[arg(short = 'V', long)]
    pub(crate) version: bool,
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// What is in a morphology or a circuit: counts, lengths, the soma, populations, warnings
    Info(InfoArgs),
    /// From tracings to closed surface meshes
    Mesh(Box<MeshArgs>),
    /// Draw cells, without a window
    #[cfg(feature = "render")]
    Render(Box<RenderArgs>),
    /// Write cells as one HTML page, to be sent: it opens without a server
    #[cfg(feature = "gpu")]
    Html(Box<HtmlArgs>),
    /// Open the window: look, pick, tune somata, save
    #[cfg(feature = "view")]
    View(Box<ViewArgs>),
    /// Write cells as neuroglancer opens them: meshes, skeletons, properties, a link
    Neuroglancer(Box<NeuroglancerArgs>),
    /// Judge meshes: closed, manifold, oriented, self-intersections, volume
    Check(CheckArgs),
    /// Write morphologies in another format, and mend them
    Convert(Box<ConvertArgs>),
    /// What differs between two tracings
    Diff(DiffArgs),
    /// The nodes of a circuit as a table: CSV or TSV
    Nodes(Box<NodesArgs>),
    /// Values of a simulation report, or spikes, as a table: CSV or TSV
    Report(Box<ReportArgs>),
    /// Grow synthetic neurons, the same for the same seed on every machine
    Synth(SynthArgs),
    /// Benchmarks to repeat on one's own machine
    #[cfg(feature = "gpu")]
    Bench(Box<BenchArgs>),
    /// Print the completions of a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print a manual page, as in: neurotess man mesh > neurotess-mesh.1
    Man {
        /// The command [default: the program]
        command: Option<String>,
    },
}

impl Cli {
    /// Whether something may be drawn by an adapter without a window.
    #[cfg(feature = "gpu")]
    pub(crate) fn draws(&self) -> bool {
        self.version || matches!(self.command, Some(Command::Render(_) | Command::Bench(_)))
    }

    /// Runs the command.
    pub(crate) fn run(&self, reporter: &Reporter) -> anyhow::Result<()> {
        if self.version {
            return version::run(reporter);
        }
        match &self.command {
            Some(Command::Info(args)) => info::run(args, reporter),
            Some(Command::Mesh(args)) => mesh::run(args, reporter),
            Some(Command::Neuroglancer(args)) => neuroglancer::run(args, reporter),
            Some(Command::Check(args)) => check::run(args, reporter),
            Some(Command::Convert(args)) => convert::run(args, reporter),
            Some(Command::Diff(args)) => diff::run(args, reporter),
            #[cfg(feature = "render")]
            Some(Command::Render(args)) => render::run(args, reporter),
            #[cfg(feature = "gpu")]
            Some(Command::Html(args)) => html::run(args, reporter),
            #[cfg(feature = "view")]
            Some(Command::View(args)) => view::run(args, reporter),
            #[cfg(feature = "gpu")]
            Some(Command::Bench(args)) => bench::run(args, reporter),
            Some(Command::Nodes(args)) => tables::nodes(args, reporter),
            Some(Command::Report(args)) => tables::report(args, reporter),
            Some(Command::Synth(args)) => synth::run(args, reporter),
            Some(Command::Completions { shell }) => {
                completions::run(*shell, &mut Self::command(), reporter)
            }
            Some(Command::Man { command }) => {
                man::run(command.as_deref(), Self::command(), reporter)
            }
            None => usage("no command: neurotess --help lists them"),
        }
    }
}
