//! `neurotess html`: its options.

use std::path::PathBuf;

use clap::Args;

use crate::commands::render::{
    ColorBy, PaletteArg, PaletteParser, RenderArgs, RgbArg, SetColor, color_maps, range,
};
use crate::options::cells::CellArgs;
use crate::options::markers::MarkerArgs;
use crate::options::radius::RadiusArgs;
use crate::options::rings::RingArgs;
use crate::options::soma::SomaArg;
use crate::options::time::Time;
use crate::options::types::Types;
use neurotess::render::color::ColorMap;

/// `neurotess html`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess html cell.swc -o cell.html
  neurotess html a.swc b.asc -o both.html --color-by neuron
  neurotess html cell.swc -o cell.html --color-by depth --colormap magma --background black
  neurotess html cell.swc -o cell.html --values calcium.csv --points spines.csv
  neurotess html circuit/ -o fires.html --nodes 0-4 --report voltage.h5 --time 0:100:0.5

The page opens from a folder or an e-mail and asks nothing of any server.")]
pub(crate) struct HtmlArgs {
    /// Morphology files, folders (searched recursively) or globs, all in one page; or one circuit
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// The page, - for standard output
    #[arg(short, long, value_name = "OUT.html")]
    pub(crate) out: PathBuf,
    /// Replace a file that exists, and write pages of more than 2 MB
    #[arg(long)]
    pub(crate) force: bool,
    /// Title of the page [default: the names of the inputs]
    #[arg(long, value_name = "TEXT")]
    pub(crate) title: Option<String>,
    /// What colors tell at first [default: type; value, if there is a --report or --values]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Colors")]
    pub(crate) color_by: Option<ColorBy>,
    /// Values of a simulation: a SONATA report, or a file of spikes
    #[arg(long, value_name = "FILE", help_heading = "Colors")]
    pub(crate) report: Option<PathBuf>,
    /// Values of your own for one cell: a table (CSV, TSV) whose first column is sample or section, the
    /// others values; several columns are named by their times (ms)
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "report",
        help_heading = "Colors"
    )]
    pub(crate) values: Option<PathBuf>,
    /// Time (ms) in the report, or FROM:TO:STEP [default: all of it, in at most 200 steps]
    #[arg(
        long,
        value_name = "MS",
        requires = "report",
        allow_hyphen_values = true,
        help_heading = "Colors"
    )]
    pub(crate) time: Option<Time>,
    /// Numbers at both ends of the color map [default: the least and the greatest]
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, allow_hyphen_values = true, help_heading = "Colors")]
    pub(crate) range: Option<[f32; 2]>,
    /// Colors of types and of things told apart: a name, or a file with colors of your own
    #[arg(long, default_value = "neurom", value_name = "NAME|FILE", value_parser = PaletteParser, help_heading = "Colors")]
    pub(crate) palette: PaletteArg,
    /// Color of a type or of anything else in the legend, as in axon=#ff8800; repeatable
    #[arg(long, value_name = "NAME=COLOR", help_heading = "Colors")]
    pub(crate) set_color: Vec<SetColor>,
    /// Colors of numbers
    #[arg(long, default_value = "viridis", value_name = "NAME", value_parser = color_maps(), help_heading = "Colors")]
    pub(crate) colormap: ColorMap,
    /// Color behind everything [default: light or dark, as the reader's system is]
    #[arg(long, value_name = "COLOR", help_heading = "Colors")]
    pub(crate) background: Option<RgbArg>,
    /// Draw neurites at least this many pixels wide [default: 1.5, of more than 50 neurons 0]
    #[arg(long, value_name = "PX", value_parser = crate::options::numbers::not_negative, allow_negative_numbers = true)]
    pub(crate) least_width: Option<f64>,
    /// Take radii times this factor
    #[arg(long, value_name = "FACTOR", value_parser = crate::options::numbers::radius_factor, allow_negative_numbers = true)]
    pub(crate) radius_factor: Option<f64>,
    #[command(flatten)]
    pub(crate) radius: RadiusArgs,
    /// How the soma is made
    #[arg(long, value_enum, default_value_t = SomaArg::Fem, value_name = "METHOD", help_heading = "Soma")]
    pub(crate) soma: SomaArg,
    #[command(flatten)]
    pub(crate) rings: RingArgs,
    /// Keep only these: axon, basal, apical, dendrite (both), undefined, custom_N, SWC numbers
    #[arg(long, value_delimiter = ',', value_name = "TYPE,…")]
    pub(crate) types: Vec<Types>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) markers: MarkerArgs,
    #[command(flatten)]
    pub(crate) cells: CellArgs,
}

impl HtmlArgs {
    /// The same for what reads and colors scenes.
    pub(crate) fn render_args(&self) -> RenderArgs {
        let mut args = RenderArgs::of(&self.inputs);
        args.color_by = self.color_by;
        args.report.clone_from(&self.report);
        args.time = self.time;
        args.range = self.range;
        args.palette = self.palette.clone();
        args.set_color = self.set_color.clone();
        args.colormap = self.colormap;
        args.background = self.background;
        args.least_width = self.least_width;
        args.radius_factor = self.radius_factor;
        args.soma = self.soma;
        args.types = self.types.clone();
        args.strict = self.strict;
        args.radius = self.radius;
        args.rings = self.rings.clone();
        args.markers = self.markers.clone();
        args.cells = self.cells.clone();
        args
    }
}
