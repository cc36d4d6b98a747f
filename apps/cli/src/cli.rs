//! What the command line says, as types. Help texts are the documentation of the options.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand, ValueEnum};
use neurotess::formats;
use neurotess::generate::SomaMethod;
use neurotess::mesh::Format;
use neurotess::morphology::NeuriteKind;
use neurotess::synth::Kind;

pub(crate) use crate::commands::bench::BenchArgs;
pub(crate) use crate::commands::render::args::RenderArgs;
use crate::commands::view::ViewArgs;
use crate::options::cells::CellArgs;
use crate::options::rings::RingArgs;

/// From tracings of neurons to closed surface meshes. Lengths are micrometers (µm).
#[derive(Debug, Parser)]
#[command(
    name = "neurotess",
    disable_version_flag = true,
    arg_required_else_help = true
)]
#[command(after_help = "Examples:
  neurotess mesh cell.swc -o cell.ply
  neurotess render cell.swc -o cell.png
  neurotess info cells/ --json
  neurotess mesh cells/ -o meshes/ --format glb --resume --log meshes.jsonl
  neurotess check cell.ply

Exit codes: 0 all inputs done, 1 some failed, 2 wrong usage, 130 interrupted.")]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) common: Common,
    /// Print the version; with -v the formats and features of this build
    #[arg(short = 'V', long)]
    pub(crate) version: bool,
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

/// Options that every command has.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct Common {
    /// Print one JSON document on standard output, everything else on standard error
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say more: every warning of every input; of `view`, every command that the window runs
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// Threads to use [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = at_least_one,
          allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,
    /// Show no progress bar, not even on a terminal
    #[arg(long, global = true)]
    pub(crate) no_progress: bool,
    /// Color messages
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    pub(crate) color: Color,
}

/// When messages are colored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// What is in a morphology or a circuit: counts, lengths, the soma, populations, warnings
    Info(InfoArgs),
    /// From tracings to closed surface meshes
    Mesh(Box<MeshArgs>),
    /// Draw cells, without a window
    Render(Box<RenderArgs>),
    /// Open the window: look, pick, tune somata, save
    View(ViewArgs),
    /// Judge meshes: closed, manifold, oriented, self-intersections, volume
    Check(CheckArgs),
    /// Write morphologies in another format
    Convert(ConvertArgs),
    /// Grow synthetic neurons, the same for the same seed on every machine
    Synth(SynthArgs),
    /// Benchmarks to repeat on one's own machine
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

/// `neurotess info`
#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// Morphology files, folders (searched recursively) or globs, - for standard input; circuits (a
    /// SONATA configuration or the folder of one, a scene)
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Format of standard input (-), where its content does not tell: swc, asc, h5 or nml
    #[arg(long, value_name = "FORMAT", value_parser = morphology_format)]
    pub(crate) format: Option<formats::Format>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
}

/// `neurotess check`
#[derive(Args, Debug)]
#[command(
    after_help = "Vertices are those of the file. STL repeats them for every face: use --merge.
A mesh that is not closed is a verdict, not a failure: the exit code is 0 if all could be read."
)]
pub(crate) struct CheckArgs {
    /// Mesh files (ply, obj, stl, glb, off, vtu), folders (searched recursively) or globs; - for standard
    /// input, with --format
    #[arg(required = true, value_name = "MESH")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Format, whatever the names say: ply, obj, stl, glb, off, vtu
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<Format>,
    /// Merge vertices of identical position first
    #[arg(long)]
    pub(crate) merge: bool,
}

/// `neurotess convert`
#[derive(Args, Debug)]
pub(crate) struct ConvertArgs {
    /// Morphology files, folders (searched recursively) or globs; - for standard input
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) out: OutArgs,
    /// Format to write, where OUT's extension does not tell: swc, asc or h5
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<String>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
}

/// Where results go.
#[derive(Args, Clone, Debug)]
pub(crate) struct OutArgs {
    /// A file for one input, - for standard output; a folder for several, or for a folder, whose
    /// structure it repeats
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) force: bool,
}

/// Where what is grown goes.
#[derive(Args, Clone, Debug)]
pub(crate) struct GrownArgs {
    /// A file OUT.swc for one cell, - for standard output; a folder for several cells and for a circuit
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
    /// Kind of cell: pyramidal, purkinje, granule, basket, motor or star; or circuit: many cells, with
    /// spikes and a report, as SONATA
    #[arg(value_parser = crate::commands::synth::what)]
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
}

/// What `neurotess synth` makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    /// Cells of a kind.
    Cells(Kind),
    /// A circuit.
    Circuit,
}

/// `neurotess mesh`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess mesh cell.swc -o cell.ply
  neurotess mesh cell.swc -o cell.glb --max-error 0.05
  neurotess mesh cell.swc -o cell.ply --poisson 0.1 --ring 1=0.5 --ring 2=1.5
  neurotess mesh cells/ -o meshes/ --format stl --types axon,2,custom_9
  neurotess mesh cells/ -o meshes/ --shard $SLURM_ARRAY_TASK_ID/100 --resume --log 1.jsonl
  neurotess mesh circuit/ -o meshes/ --node-set L4 --sample 20
  neurotess mesh circuit/ -o circuit.glb      (one file: each morphology once, each cell a node)

PLY, GLB and VTU carry normals and, per vertex, type (SWC), point (number of the sample), section
and radius (µm).")]
pub(crate) struct MeshArgs {
    /// Morphology files, folders (searched recursively) or globs, - for standard input; or one circuit,
    /// whose cells are written in its coordinates
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) out: OutArgs,
    /// Subdivisions per coarse edge, 1 to 64; 0 writes the coarse quads themselves
    #[arg(long, default_value_t = 4, value_name = "N", help_heading = "Refinement",
          allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(0..=64))]
    pub(crate) level: u32,
    /// As fine as keeps the surface within E µm of the level-64 one, instead of --level
    #[arg(long, value_name = "E", conflicts_with = "level", value_parser = positive,
          allow_negative_numbers = true, help_heading = "Refinement")]
    pub(crate) max_error: Option<f64>,
    /// Course between traced points
    #[arg(long, value_enum, default_value_t = PathArg::Hermite, value_name = "COURSE",
          help_heading = "Refinement")]
    pub(crate) path: PathArg,
    /// Shape of the ends of neurites
    #[arg(long, value_enum, default_value_t = CapsArg::Round, value_name = "SHAPE",
          help_heading = "Refinement")]
    pub(crate) caps: CapsArg,
    /// How the soma is made
    #[arg(long, value_enum, default_value_t = SomaArg::Fem, value_name = "METHOD",
          help_heading = "Soma")]
    pub(crate) soma: SomaArg,
    /// Poisson's ratio ν of the soma's material, 0 ≤ ν < 0.5
    #[arg(long, default_value_t = 0.3, value_name = "NU", value_parser = poisson,
          allow_negative_numbers = true, help_heading = "Soma")]
    pub(crate) poisson: f64,
    /// Factor on the soma's radius
    #[arg(long, default_value_t = 1.0, value_name = "S", value_parser = positive,
          allow_negative_numbers = true, help_heading = "Soma")]
    pub(crate) soma_scale: f64,
    /// Reference sphere [default: cube]
    #[arg(long, value_enum, value_name = "SPHERE", help_heading = "Soma")]
    pub(crate) soma_sphere: Option<SphereArg>,
    /// Resolution of the sphere: octahedron 1 to 5, cube 2 to 32 [default: what fits the neurites]
    #[arg(
        long,
        value_name = "N",
        allow_negative_numbers = true,
        help_heading = "Soma"
    )]
    pub(crate) soma_level: Option<u32>,
    #[command(flatten)]
    pub(crate) rings: RingArgs,
    /// Keep only these: axon, basal, apical, dendrite (both), undefined, custom_N, SWC numbers
    #[arg(long, value_delimiter = ',', value_name = "TYPE,…")]
    pub(crate) types: Vec<Types>,
    /// Format, where OUT's extension does not tell: ply, obj, stl, glb, off, vtu
    #[arg(long, value_name = "FORMAT", help_heading = "Output")]
    pub(crate) format: Option<Format>,
    /// Quads instead of triangles (ply, obj, off, vtu)
    #[arg(long, help_heading = "Output")]
    pub(crate) quads: bool,
    /// Do every N-th input only, from the I-th on, 1 ≤ I ≤ N
    #[arg(long, value_name = "I/N", help_heading = "Many inputs")]
    pub(crate) shard: Option<Shard>,
    /// Skip inputs whose output is there, newer than they are and made with the same options; outputs of
    /// other options are made again. Several runs may share a folder
    #[arg(long, help_heading = "Many inputs")]
    pub(crate) resume: bool,
    /// Append one JSON line per cell to this file as it finishes
    #[arg(long, value_name = "FILE.jsonl", help_heading = "Many inputs")]
    pub(crate) log: Option<PathBuf>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) cells: CellArgs,
}

/// `--path`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PathArg {
    /// A smooth curve
    Hermite,
    /// Straight
    Linear,
}

/// `--caps`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum CapsArg {
    /// Half spheres
    Round,
    /// Disks
    Flat,
}

/// `--soma`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SomaArg {
    /// A sphere deformed towards the neurites by linear elasticity
    Fem,
    /// A sphere
    Sphere,
    /// LiveMesh's radius function
    Profile,
    /// None: every neurite is closed by itself
    None,
}

impl SomaArg {
    /// As the library has it.
    pub(crate) fn method(self) -> SomaMethod {
        match self {
            Self::Fem => SomaMethod::Fem,
            Self::Sphere => SomaMethod::Sphere,
            Self::Profile => SomaMethod::Profile,
            Self::None => SomaMethod::None,
        }
    }
}

/// `--soma-sphere`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SphereArg {
    /// The paper's
    Octahedron,
    /// Six faces of quads
    Cube,
}

/// What one word of `--types` keeps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Types(pub(crate) Vec<NeuriteKind>);

impl FromStr for Types {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let kinds = match word.to_ascii_lowercase().as_str() {
            "axon" => vec![NeuriteKind::AXON],
            "basal" | "basal_dendrite" => vec![NeuriteKind::BASAL_DENDRITE],
            "apical" | "apical_dendrite" => vec![NeuriteKind::APICAL_DENDRITE],
            "dendrite" => vec![NeuriteKind::BASAL_DENDRITE, NeuriteKind::APICAL_DENDRITE],
            "undefined" => vec![NeuriteKind::UNDEFINED],
            other => {
                let number = other.strip_prefix("custom_").unwrap_or(other).parse();
                let unknown = "use axon, basal, apical, dendrite, undefined, custom_N or a number";
                vec![NeuriteKind(number.map_err(|_| unknown.to_owned())?)]
            }
        };
        Ok(Self(kinds))
    }
}

/// `--shard I/N`: the I-th of N parts, I counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    /// Which part, from 0 on.
    index: usize,
    /// How many parts.
    count: usize,
}

impl Shard {
    /// Every N-th item, from the I-th on.
    pub(crate) fn of<T>(self, items: Vec<T>) -> Vec<T> {
        items
            .into_iter()
            .skip(self.index)
            .step_by(self.count)
            .collect()
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let numbers = parts.and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((i, n)) if (1..=n).contains(&i) => Ok(Self {
                index: i - 1,
                count: n,
            }),
            _ => Err("two numbers I/N with 1 ≤ I ≤ N are needed, as in 3/8".into()),
        }
    }
}

/// A format of morphologies, by its name or an extension.
fn morphology_format(name: &str) -> Result<formats::Format, String> {
    let named = formats::Format::ALL.into_iter().find(|f| f.name() == name);
    named
        .or_else(|| formats::Format::of_extension(name))
        .ok_or_else(|| "use swc, asc, h5 or nml".into())
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if number >= 1 => Ok(number),
        _ => Err("a whole number from 1 on is needed".into()),
    }
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("a number above 0 is needed".into()),
    }
}

fn poisson(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if (0.0..0.5).contains(&number) => Ok(number),
        _ => Err("a number from 0 to below 0.5 is needed".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_partition() {
        let all: Vec<usize> = (0..10).collect();
        let mut seen: Vec<usize> = (1..=3)
            .flat_map(|i| Shard::of(format!("{i}/3").parse().expect("a shard"), all.clone()))
            .collect();
        seen.sort_unstable();
        assert_eq!(seen, all);
        for wrong in ["0/3", "4/3", "1", "a/b", "1/0"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn types_have_names_and_numbers() {
        let of = |word: &str| word.parse::<Types>().map(|t| t.0);
        assert_eq!(of("Axon"), Ok(vec![NeuriteKind(2)]));
        assert_eq!(of("custom_9"), Ok(vec![NeuriteKind(9)]));
        assert_eq!(of("4"), of("apical"));
        assert_eq!(of("dendrite").map(|k| k.len()), Ok(2));
        assert!(of("branch").is_err());
    }
}
