//! `neurotess bench`: its options.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use neurotess::render::{DEFAULT_BUDGET, MAX_BUDGET};

use neurotess::options::words::Size;

/// `neurotess bench`
#[derive(Args, Debug)]
pub(crate) struct BenchArgs {
    #[command(subcommand)]
    pub(crate) name: Bench,
}

/// The benchmarks.
#[derive(Debug, Subcommand)]
pub(crate) enum Bench {
    /// Three ways to draw refined neurons: stored, homogeneous on the fly, adaptive on the fly
    Refinement(RefinementArgs),
    /// Exploration within a budget beside adaptive refinement, in ever larger scenes
    Exploration(ExplorationArgs),
    /// Further pictures of a recording from a fixed camera: drawn anew, and colored anew
    Static(StaticArgs),
    /// A circuit from cold start to the first picture, with and without its cache
    Opening(OpeningArgs),
    /// A flight past distinct neurons that do not fit the adapter's memory, beside the same with all there
    Streaming(StreamingArgs),
    /// What the adapter is able to do: nothing is timed
    Adapter(AdapterArgs),
}

/// `neurotess bench adapter`
#[derive(Args, Debug)]
pub(crate) struct AdapterArgs {
    /// Adapter: a part of its name [default: NEUROTESS_ADAPTER, or the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

/// `neurotess bench streaming`
#[derive(Args, Debug)]
pub(crate) struct StreamingArgs {
    /// Neurons, all distinct
    #[arg(long, value_name = "N", default_value_t = 1000,
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) neurons: u32,
    /// Points of a neuron, about
    #[arg(long, value_name = "N", default_value_t = 1000,
          value_parser = clap::value_parser!(u32).range(50..=500_000))]
    pub(crate) points: u32,
    /// Share of the neurons' bytes that the adapter may hold
    #[arg(long, value_name = "SHARE", default_value_t = 0.3, value_parser = crate::options::numbers::positive)]
    pub(crate) share: f64,
    /// Most triangles of a frame
    #[arg(long, value_name = "N", default_value_t = DEFAULT_BUDGET,
          value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_BUDGET)))]
    pub(crate) budget: u32,
    /// Width and height (pixels)
    #[arg(long, value_name = "WxH", default_value = "1280x960")]
    pub(crate) size: Size,
    /// Frames of the flight
    #[arg(long, value_name = "N", default_value_t = 100,
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) frames: u32,
    /// Adapter to draw with: a part of its name [default: NEUROTESS_ADAPTER, or the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

/// `neurotess bench opening`
#[derive(Args, Debug)]
pub(crate) struct OpeningArgs {
    /// Neurons of the circuit
    #[arg(long, value_name = "N", default_value_t = 10_000,
          value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub(crate) neurons: u32,
    /// Distinct tracings of the circuit
    #[arg(long, value_name = "M", default_value_t = 100,
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) morphologies: u32,
    /// Points of a tracing, about
    #[arg(long, value_name = "N", default_value_t = 5_000,
          value_parser = clap::value_parser!(u32).range(50..=500_000))]
    pub(crate) points: u32,
    /// Width and height (pixels)
    #[arg(long, value_name = "WxH", default_value = "1280x960")]
    pub(crate) size: Size,
    /// Adapter to draw with: a part of its name [default: NEUROTESS_ADAPTER, or the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

/// `neurotess bench static`
#[derive(Args, Debug)]
pub(crate) struct StaticArgs {
    /// Neurons of each scene; all are seen by the camera that shows the first as a whole
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "100,1000,10000",
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) neurons: Vec<u32>,
    /// Distinct neurons: scenes of more show them several times
    #[arg(long, value_name = "N", default_value_t = 30,
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) distinct: u32,
    /// Points of a neuron, about: each has a value
    #[arg(long, value_name = "N", default_value_t = 300,
          value_parser = clap::value_parser!(u32).range(50..=500_000))]
    pub(crate) points: u32,
    /// Most triangles of a picture
    #[arg(long, value_name = "N", default_value_t = DEFAULT_BUDGET,
          value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_BUDGET)))]
    pub(crate) budget: u32,
    /// Width and height (pixels)
    #[arg(long, value_name = "WxH", default_value = "1280x820")]
    pub(crate) size: Size,
    /// Samples of a pixel: 1, 4, 16, 36 or 64
    #[arg(long, value_name = "N", default_value_t = 16)]
    pub(crate) samples: u32,
    /// Pictures that are timed of each scene, colored anew; the median counts
    #[arg(long, value_name = "N", default_value_t = 20,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) frames: u32,
    /// Pictures that are timed of each scene, drawn anew
    #[arg(long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) drawn: u32,
    /// Adapter to draw with: a part of its name [default: NEUROTESS_ADAPTER, or the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

/// `neurotess bench exploration`
#[derive(Args, Debug)]
pub(crate) struct ExplorationArgs {
    /// Neurons of each scene
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1,10,100,1000,10000,100000,1000000",
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) neurons: Vec<u32>,
    /// Distinct neurons: scenes of more show them several times
    #[arg(long, value_name = "N", default_value_t = 30,
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) distinct: u32,
    /// Points of a neuron, about
    #[arg(long, value_name = "N", default_value_t = 1000,
          value_parser = clap::value_parser!(u32).range(50..=500_000))]
    pub(crate) points: u32,
    /// Most triangles of a frame
    #[arg(long, value_name = "N", default_value_t = DEFAULT_BUDGET,
          value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_BUDGET)))]
    pub(crate) budget: u32,
    /// Largest scene that is refined adaptively too, for comparison
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub(crate) compare: u32,
    /// Width and height (pixels)
    #[arg(long, value_name = "WxH", default_value = "1280x960")]
    pub(crate) size: Size,
    /// Frames that are timed of each, while the camera turns; the median counts
    #[arg(long, value_name = "N", default_value_t = 7,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) frames: u32,
    /// Adapter to draw with: a part of its name [default: NEUROTESS_ADAPTER, or the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

/// `neurotess bench refinement`
#[derive(Args, Debug)]
pub(crate) struct RefinementArgs {
    /// Neurons of each scene
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1,10,30,100",
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) neurons: Vec<u32>,
    /// Levels, 1 to 64
    #[arg(long, value_name = "L,…", value_delimiter = ',', default_value = "1,2,3,4,5,6",
          value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) levels: Vec<u32>,
    /// Scenes in which only adaptive refinement is timed, to see it grow
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "100,1000,10000",
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) grow: Vec<u32>,
    /// Distinct neurons: scenes of more show them several times
    #[arg(long, value_name = "N", default_value_t = 30,
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) distinct: u32,
    /// Points of a neuron, about
    #[arg(long, value_name = "N", default_value_t = 1000,
          value_parser = clap::value_parser!(u32).range(50..=500_000))]
    pub(crate) points: u32,
    /// Width and height (pixels)
    #[arg(long, value_name = "WxH", default_value = "600x600")]
    pub(crate) size: Size,
    /// Error (pixels) of adaptive refinement by error
    #[arg(long, value_name = "P", default_value_t = 0.5, value_parser = crate::options::numbers::positive)]
    pub(crate) pixels: f64,
    /// Frames that are timed of each; the median counts
    #[arg(long, value_name = "N", default_value_t = 5,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) frames: u32,
    /// Seconds of a frame after which it is not repeated
    #[arg(long, value_name = "S", default_value_t = 4.0, value_parser = crate::options::numbers::positive)]
    pub(crate) patience: f64,
    /// Most memory (MiB) of stored surfaces: what needs more is left out
    #[arg(long, value_name = "MIB", default_value_t = 2048)]
    pub(crate) memory: u64,
    /// Adapter to draw with: a part of its name [default: NEUROTESS_ADAPTER, or the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Folder for refinement.json and refinement.svg
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) force: bool,
}
