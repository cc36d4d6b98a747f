//! `neurotess render`: its options.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use neurotess::coloring::OwnColors;
use neurotess::picture::color::{ColorMap, Palette, Rgb};
use neurotess::picture::{Look, MAX_BUDGET};

use super::palette::{PaletteArg, PaletteParser, SetColor};
use super::times::{MOST, times};
use super::values::{Fit, LightArg, RgbArg, Triple};
use crate::options::cache::CacheArgs;
use crate::options::cells::CellArgs;
use crate::options::gpu::GpuArgs;
use crate::options::markers::MarkerArgs;
use crate::options::meshes::MeshArgs;
use crate::options::radius::RadiusArgs;
use crate::options::rings::RingArgs;
use crate::options::size::Size;
use crate::options::soma::SomaArg;
use crate::options::time::Time;
use crate::options::types::Types;
use crate::report::usage;

/// `neurotess render`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess render cell.swc -o cell.png
  neurotess render cell.swc -o cell.png --color-by depth --colormap magma --scale-bar
  neurotess render cell.swc -o close.png --eye 0,20,80 --target 0,20,0 --wireframe --level 3
  neurotess render a.swc b.swc -o both.png --color-by neuron --transparent
  neurotess render cell.swc -o own.png --palette mine.toml --set-color axon=#ff8800
  neurotess render cell.swc -o turn.png --turntable --frames 120
  neurotess render circuit/ -o circuit.png --node-set Layer5 --view iso
  neurotess render circuit/ -o all.png --lod exploration --budget 1000000
  neurotess render circuit/ -o fires.png --report voltage.h5 --time 14.5 --range=-80,30
  neurotess render circuit/ -o inputs.png --nodes 7 --synapses --marker-color-by conductance
  neurotess render circuit/ -o region.png --mesh region.obj,opacity=0.2,fit
  neurotess render circuit/ -o film.png --report voltage.h5 --time 0:100:0.5")]
pub(crate) struct RenderArgs {
    /// Morphology files, folders (searched recursively) or globs, all in one picture; or one
    /// circuit, or one session of neurotess view, in its own view and look
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// The picture, - for standard output; of a series NAME_0000.png and so on
    #[arg(short, long, value_name = "OUT.png")]
    pub(crate) out: PathBuf,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) force: bool,
    /// Width and height (pixels), up to 32768
    #[arg(
        long,
        default_value = "1280x960",
        value_name = "WxH",
        help_heading = "Picture"
    )]
    pub(crate) size: Size,
    /// Samples of a pixel, 1 to 64: smoother edges; 1, 4, 16, 36 and 64 are there
    #[arg(long, default_value_t = 16, value_name = "N", help_heading = "Picture",
          allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) samples: u32,
    /// Color behind everything: a name (white, black, gray), RRGGBB or RGB [default: that of the
    /// palette's file, or white]
    #[arg(long, value_name = "COLOR", help_heading = "Picture")]
    pub(crate) background: Option<RgbArg>,
    /// Leave the background out
    #[arg(long, conflicts_with = "background", help_heading = "Picture")]
    pub(crate) transparent: bool,
    /// What colors tell [default: type; what a scene says; value, if there is a --report]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Colors")]
    pub(crate) color_by: Option<ColorBy>,
    /// Cells of a circuit by an attribute, like layer, mtype, population or group
    #[arg(long, value_name = "NAME", conflicts_with_all = ["color_by", "report"],
          help_heading = "Colors")]
    pub(crate) color_by_attribute: Option<String>,
    /// Values of a simulation: a SONATA report, or a file of spikes
    #[arg(long, value_name = "FILE", help_heading = "Colors")]
    pub(crate) report: Option<PathBuf>,
    /// Time (ms) in the report [default: its first]; FROM:TO:STEP, TO left out, makes a series of
    /// pictures
    #[arg(
        long,
        value_name = "MS",
        requires = "report",
        allow_hyphen_values = true,
        help_heading = "Colors"
    )]
    pub(crate) time: Option<Time>,
    /// Numbers at both ends of the color map [default: the least and the greatest of all pictures]
    #[arg(long, value_name = "LOW,HIGH", value_parser = range,
          allow_hyphen_values = true, help_heading = "Colors")]
    pub(crate) range: Option<[f32; 2]>,
    /// Colors of types and of things told apart: a name, or a file with colors of your own
    #[arg(
        long,
        default_value = "neurom",
        value_name = "NAME|FILE",
        value_parser = PaletteParser,
        help_heading = "Colors"
    )]
    pub(crate) palette: PaletteArg,
    /// Color of a type (axon, basal, custom_7, …) or of anything else in the legend, before that of the
    /// palette, as in axon=#ff8800; repeatable
    #[arg(long, value_name = "NAME=COLOR", help_heading = "Colors")]
    pub(crate) set_color: Vec<SetColor>,
    /// Colors of numbers
    #[arg(
        long,
        default_value = "viridis",
        value_name = "NAME",
        value_parser = color_maps(),
        help_heading = "Colors"
    )]
    pub(crate) colormap: ColorMap,
    /// Colors of numbers instead of a color map: of programs that have their own.
    #[arg(skip)]
    pub(crate) scale: Option<Vec<Rgb>>,
    /// Times (ms) of all pictures instead of `--time`: of programs that have their own.
    #[arg(skip)]
    pub(crate) times: Option<Vec<f64>>,
    /// Leave out the end of the color map that is as light or as dark as the background. Without it
    /// that end has edges
    #[arg(long, help_heading = "Colors")]
    pub(crate) trim_colormap: bool,
    /// Draw no legend
    #[arg(long, help_heading = "Colors")]
    pub(crate) no_legend: bool,
    /// Draw a scale bar, of this length (µm) or one that fits
    #[arg(long, value_name = "UM", num_args = 0..=1, default_missing_value = "fit",
          help_heading = "Picture")]
    pub(crate) scale_bar: Option<Fit>,
    /// Show the directions of x, y and z in a corner
    #[arg(long, help_heading = "Picture")]
    pub(crate) axes: bool,
    /// Draw neurites at least this wide, so that thin ones can be seen; the legend says so. In pixels of
    /// pictures whose shorter side has up to 960; proportionally more in larger ones. 0: as wide as they are
    /// [default: 1.5, of more than 50 neurons 0]
    #[arg(long, value_name = "PX", value_parser = crate::options::numbers::not_negative,
          allow_negative_numbers = true, help_heading = "Picture")]
    pub(crate) least_width: Option<f64>,
    /// Draw neurites with their radii times this factor, so that thin ones can be seen in a figure; the
    /// legend says so
    #[arg(long, value_name = "FACTOR", value_parser = crate::options::numbers::radius_factor,
          allow_negative_numbers = true, help_heading = "Picture")]
    pub(crate) radius_factor: Option<f64>,
    #[command(flatten)]
    pub(crate) radius: RadiusArgs,
    /// How vertices are made [default: adaptive; homogeneous where --level is given]
    #[arg(long, value_enum, value_name = "MODE", help_heading = "Refinement")]
    pub(crate) lod: Option<LodMode>,
    /// Subdivisions per coarse edge everywhere, 1 to 64, instead of --pixels
    #[arg(long, value_name = "N", help_heading = "Refinement", conflicts_with = "pixels",
          allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) level: Option<u32>,
    /// Farthest that the surface may be from the level-64 one (pixels) [default: 0.25, with
    /// --wireframe 1]
    #[arg(long, value_name = "P", value_parser = crate::options::numbers::positive,
          allow_negative_numbers = true, help_heading = "Refinement")]
    pub(crate) pixels: Option<f64>,
    /// Most triangles of --lod exploration, for those that show most [default: 100000]
    #[arg(long, value_name = "N", help_heading = "Refinement",
          value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_BUDGET)))]
    pub(crate) budget: Option<u32>,
    /// Look from this side; the camera fits the scene
    #[arg(long, value_enum, default_value_t = ViewSide::Front, value_name = "SIDE",
          help_heading = "Camera")]
    pub(crate) view: ViewSide,
    /// Of a session: look from the view that the window saved under this name
    #[arg(long, value_name = "NAME", conflicts_with_all = ["view", "eye"], help_heading = "Camera")]
    pub(crate) saved_view: Option<String>,
    /// Position of the eye (µm)
    #[arg(
        long,
        value_name = "X,Y,Z",
        requires = "target",
        conflicts_with = "view",
        allow_hyphen_values = true,
        help_heading = "Camera"
    )]
    pub(crate) eye: Option<Triple>,
    /// What the eye looks at (µm)
    #[arg(
        long,
        value_name = "X,Y,Z",
        requires = "eye",
        allow_hyphen_values = true,
        help_heading = "Camera"
    )]
    pub(crate) target: Option<Triple>,
    /// What is upwards in the picture
    #[arg(
        long,
        value_name = "X,Y,Z",
        default_value = "0,1,0",
        requires = "eye",
        allow_hyphen_values = true,
        help_heading = "Camera"
    )]
    pub(crate) up: Triple,
    /// Vertical angle of view (degrees)
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 20.0,
        help_heading = "Camera"
    )]
    pub(crate) fov: f64,
    /// Look without perspective: lengths are true at all depths. The picture is this high (µm), or
    /// fits the scene; with --eye, it shows what --fov shows at the target
    #[arg(long, value_name = "UM", num_args = 0..=1, default_missing_value = "fit",
          help_heading = "Camera")]
    pub(crate) orthographic: Option<Fit>,
    /// Go once around the scene, in --frames pictures
    #[arg(long, help_heading = "Camera")]
    pub(crate) turntable: bool,
    /// Number of pictures of --turntable [default: 36] or of --time FROM:TO: OUT_0000.png and so on
    #[arg(long, value_name = "N", help_heading = "Camera",
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST)))]
    pub(crate) frames: Option<u32>,
    /// Show the triangles by thin lines
    #[arg(long, help_heading = "Look")]
    pub(crate) wireframe: bool,
    /// soft, flat (bare colors), or where the light comes from: right, up, towards you
    #[arg(
        long,
        default_value = "soft",
        value_name = "LIGHT",
        allow_hyphen_values = true,
        help_heading = "Look"
    )]
    pub(crate) light: LightArg,
    /// Radius (µm) within which corners darken one another; 0: not at all [default: what fits]
    #[arg(long, value_name = "UM", num_args = 0..=1, default_missing_value = "fit",
          help_heading = "Look")]
    pub(crate) ao: Option<Fit>,
    /// How the soma is made
    #[arg(long, value_enum, default_value_t = SomaArg::Fem, value_name = "METHOD",
          help_heading = "Soma")]
    pub(crate) soma: SomaArg,
    #[command(flatten)]
    pub(crate) rings: RingArgs,
    /// Keep only these: axon, basal, apical, dendrite (both), undefined, custom_N, SWC numbers
    #[arg(long, value_delimiter = ',', value_name = "TYPE,…")]
    pub(crate) types: Vec<Types>,
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Write what the picture cost to this file (JSON)
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) markers: MarkerArgs,
    #[command(flatten)]
    pub(crate) meshes: MeshArgs,
    #[command(flatten)]
    pub(crate) cache: CacheArgs,
    #[command(flatten)]
    pub(crate) cells: CellArgs,
}

/// The options alone.
#[cfg(feature = "gpu")]
#[derive(Debug, clap::Parser)]
struct Alone {
    #[command(flatten)]
    args: RenderArgs,
}

impl RenderArgs {
    /// The usual options for these inputs.
    #[cfg(feature = "gpu")]
    pub(crate) fn of(inputs: &[PathBuf]) -> Self {
        let words = ["render", "-o", "-", "--"].map(std::ffi::OsString::from);
        let inputs = inputs.iter().map(|input| input.clone().into_os_string());
        let parsed = <Alone as clap::Parser>::try_parse_from(words.into_iter().chain(inputs));
        parsed.expect("it needs inputs and an output only").args
    }

    /// The palette of all that has no color of its own.
    pub(crate) fn base_palette(&self) -> Palette {
        self.palette.0.base.unwrap_or_default()
    }

    /// Colors of one's own: those of the file, and over them those of the options.
    pub(crate) fn own_colors(&self) -> OwnColors {
        let mut own = self.palette.0.own_colors.clone();
        for set in &self.set_color {
            own.set_named(&set.name, set.color);
        }
        own
    }

    /// The background: that of the options, that of the palette, or white; none if it is left out.
    pub(crate) fn background(&self) -> Option<Rgb> {
        let option = self.background.map(|color| color.0);
        let color = option.or(self.palette.0.background);
        (!self.transparent).then_some(color.unwrap_or([255; 3]))
    }

    /// Least width (pixels of this picture) of neurites, of which there are so many; 0: as wide as they are.
    pub(crate) fn least_width(&self, neurons: usize) -> f32 {
        let width = self.least_width.map(|width| width as f32);
        let width = width.unwrap_or_else(|| Look::usual_least_width(neurons));
        Look::width_at(width, self.size.0)
    }

    /// Factor on the radii of neurites.
    pub(crate) fn radius_factor(&self) -> f64 {
        self.radius_factor.unwrap_or(1.0)
    }

    /// Greatest error (pixels): one that cannot be seen; with a wireframe a larger one, so that its
    /// lines do not run together.
    pub(crate) fn error(&self) -> f64 {
        self.pixels
            .unwrap_or(if self.wireframe { 1.0 } else { 0.25 })
    }

    /// Number of pictures of a series; none: one picture.
    ///
    /// # Errors
    /// Wrong usage: `--frames` without a series, or a series in time that has no number of pictures
    /// or too many.
    pub(crate) fn series(&self) -> anyhow::Result<Option<u32>> {
        if let Some(times) = &self.times {
            return match u32::try_from(times.len()) {
                Ok(count) if count <= MOST => Ok(Some(count)),
                _ => usage(format!("{} times are more than {MOST}", times.len())),
            };
        }
        match self.time {
            Some(Time::Series(..)) => {
                Ok(times(self.time, self.frames)?.map(|times| times.len() as u32))
            }
            _ if self.turntable => Ok(Some(self.frames.unwrap_or(36))),
            _ if self.frames.is_some() => {
                usage("--frames is for --turntable, and for --time FROM:TO")
            }
            _ => Ok(None),
        }
    }

    /// Colors of numbers.
    pub(crate) fn color_scale(&self, background: Option<Rgb>) -> Vec<Rgb> {
        match (&self.scale, background.filter(|_| self.trim_colormap)) {
            (Some(own), _) => own.clone(),
            (None, Some(background)) => self.colormap.scale_before(background),
            (None, None) => self.colormap.scale(),
        }
    }

    /// Whether cells are colored by numbers.
    pub(crate) fn is_number(&self) -> bool {
        let by = [ColorBy::BranchOrder, ColorBy::Radius, ColorBy::PathDistance];
        let number = self.color_by.is_some_and(|what| by.contains(&what));
        number || self.report.is_some() || self.color_by_attribute.is_some()
    }
}

/// Color maps by name; shells complete them.
pub(crate) fn color_maps() -> impl TypedValueParser<Value = ColorMap> {
    let names = ColorMap::ALL.map(ColorMap::name);
    PossibleValuesParser::new(names).try_map(|name| name.parse::<ColorMap>())
}

pub(crate) fn range(text: &str) -> Result<[f32; 2], String> {
    let ends: Option<Vec<f32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match ends.as_deref() {
        Some(&[low, high]) if low.is_finite() && high.is_finite() && low < high => Ok([low, high]),
        _ => Err("two numbers are needed, the lower first, as in -80,30".into()),
    }
}

/// `--color-by`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorBy {
    /// SWC type
    Type,
    /// Every neurite its own
    Neurite,
    /// Neighboring sections differ
    Section,
    /// Number of forks from the neurite's start
    #[value(name = "order", alias = "branch-order")]
    BranchOrder,
    /// Radius (µm)
    Radius,
    /// Distance along the neurite from its start (µm)
    #[value(name = "depth", alias = "path-distance")]
    PathDistance,
    /// Every input its own, and every cell of a circuit
    Neuron,
    /// Values of a --report
    Value,
}

/// `--lod`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LodMode {
    /// As it is drawn, as fine as --pixels asks for
    Adaptive,
    /// As it is drawn, at --level everywhere
    Homogeneous,
    /// Refined beforehand, whole in the adapter's memory
    Prerefined,
    /// As the viewer draws while the camera moves: any scene within --budget triangles
    Exploration,
    /// As the viewer draws at rest: adaptive, within half a pixel
    Static,
}

/// `--view`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ViewSide {
    /// Along −z, y upwards
    Front,
    /// Along +z
    Back,
    /// Along +x
    Left,
    /// Along −x
    Right,
    /// Along −y
    Top,
    /// Along +y
    Bottom,
    /// From the right, above and before
    Iso,
}
