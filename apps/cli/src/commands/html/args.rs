//! `neurotess html`: its options.

use std::path::PathBuf;

use clap::Args;
use neurotess::drawing::DrawOptions;
use neurotess::options::Picture;
use neurotess::options::groups::{CellSelection, ColorOptions, MarkerOptions, ShapeOptions};
use neurotess::options::words::{NotNegative, Time};

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
    /// Draw neurites at least this many pixels wide [default: 1.5, of more than 50 neurons 0]
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub(crate) least_width: Option<NotNegative>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) colors: ColorOptions,
    #[command(flatten)]
    pub(crate) shape: ShapeOptions,
    #[command(flatten)]
    pub(crate) markers: MarkerOptions,
    #[command(flatten)]
    pub(crate) cells: CellSelection,
}

impl HtmlArgs {
    /// The picture of which a page is another form.
    pub(crate) fn picture(&self) -> Picture {
        let mut picture = Picture::default();
        picture.colors = self.colors.clone();
        picture.camera.time = self.time;
        picture.look.least_width = self.least_width;
        picture.shape = self.shape.clone();
        picture.markers = self.markers.clone();
        picture.cells = self.cells.clone();
        picture
    }

    /// All that is asked for of what reads and meshes cells.
    pub(crate) fn options(&self) -> DrawOptions {
        let mut options = DrawOptions::from(self.picture());
        options.strict = self.strict;
        options
    }
}
