//! Colors of pictures, by the options.

use std::path::Path;

use anyhow::Context;
use neurotess::coloring::{
    self, Cell, ClosestColors, ColorScheme, Coloring, DECAY, Film, MarkerSet, MeshValues,
    OwnNumbers, Recording, by_attribute, by_values,
};
use neurotess::generate::unused_kinds;
use neurotess::morphology::NeuriteKind;
use neurotess::picture::VisibleKey;
use neurotess::picture::color::ColorTable;
use neurotess::picture::overlay::Legend;

use super::args::{ColorBy, RenderArgs};
use super::cells::MeshedCell;
use super::circuit_instances::CircuitInstances;
use super::color_check;
use super::markers;
use super::meshes::{MeshKeys, SceneMeshes};
use super::times::{self, time_text};
use crate::report::Reporter;

/// Colors of all pictures.
pub(crate) struct PictureColors {
    /// Coloring of the first picture.
    pub(crate) coloring: Coloring,
    /// Synapses or points beside the cells.
    pub(crate) markers: Option<MarkerSet>,
    /// By mesh beside the cells: what its color is looked up by.
    pub(crate) mesh_keys: Vec<MeshKeys>,
    /// The recording of a series over time, whose pictures differ in values.
    series: Option<RecordedSeries>,
    /// Number of neurons in the picture.
    neurons: usize,
    /// Least width (pixels of the picture; 0: none) and factor on the radii of neurites, which the legend tells.
    widths: (f32, f64),
    /// The colors of the legend that are closest to one another.
    pub(crate) closest: Option<ClosestColors>,
}

/// A recording, and the time (ms) of each picture.
struct RecordedSeries {
    recording: Recording,
    times: Vec<f64>,
    range: [f32; 2],
}

impl PictureColors {
    /// Color table and legend of a picture. In a series only the values differ.
    pub(crate) fn picture(&self, number: usize) -> anyhow::Result<(ColorTable, Legend)> {
        let Coloring { table, .. } = &self.coloring;
        let legend = self.legend(number);
        let time = |series: &RecordedSeries| series.times.get(number).copied();
        let Some((series, time)) = self.series.as_ref().and_then(|f| Some((f, time(f)?))) else {
            return Ok((table.clone(), legend));
        };
        let frame = series.recording.at(time, DECAY, &|_| true).map_err(whole)?;
        let table = ColorTable {
            scale: table.scale.clone(),
            categories: table.categories.clone(),
            values: frame.values(series.range),
        };
        Ok((table, legend))
    }

    /// Adds the colors and names of meshes, and numbers of their vertices. `told`: cells have such numbers, too, which the
    /// legend tells.
    ///
    /// # Errors
    /// The numbers are not of these meshes, or stand beside those of a recording.
    pub(crate) fn add_meshes(
        &mut self,
        meshes: &SceneMeshes,
        values: Option<(&MeshValues, bool)>,
        args: &RenderArgs,
    ) -> anyhow::Result<()> {
        let mut of_vertices = Vec::new();
        if let Some((values, told)) = values {
            meshes.check(values)?;
            if self.series.is_some() {
                anyhow::bail!("values of meshes are not shown beside a recording");
            }
            of_vertices = self.coloring.add_mesh_values(values, &scheme(args), told);
        }
        let plain = meshes.colors(values.map(|(values, _)| values));
        let mut whole = self.coloring.add_meshes(&plain).into_iter();
        of_vertices.resize(meshes.len(), None);
        let keys = of_vertices.into_iter().map(|keys| match keys {
            Some(keys) => Some(MeshKeys::OfVertices(keys)),
            None => whole.next().map(MeshKeys::Whole),
        });
        self.mesh_keys = keys.flatten().collect();
        Ok(())
    }

    /// The widths of neurites become those of these options.
    pub(crate) fn set_widths(&mut self, args: &RenderArgs) {
        let least = match self.neurons {
            0 => 0.0,
            neurons => args.least_width(neurons),
        };
        self.widths = (least, args.radius_factor());
    }

    /// Least width (pixels) of neurites; 0: as wide as they are.
    pub(crate) fn least_width(&self) -> f32 {
        self.widths.0
    }

    /// Whether pictures show one recording at several times.
    pub(crate) fn is_series(&self) -> bool {
        self.series
            .as_ref()
            .is_some_and(|series| series.times.len() > 1)
    }

    /// Legend of a picture.
    pub(crate) fn legend(&self, number: usize) -> Legend {
        let legend = self.coloring.legend.clone();
        let (least, factor) = self.widths;
        let legend = legend.with_widths(least, factor);
        let series = self.series.as_ref();
        match series.and_then(|series| Some((series, *series.times.get(number)?))) {
            Some((series, time)) => legend.noted(&time_text(&series.times, time)),
            None => legend,
        }
    }

    /// A film of the series.
    pub(crate) fn film(&self, keys: &[VisibleKey]) -> Option<Film> {
        let series = self.series.as_ref()?;
        Some(Film::new(keys, &series.recording, series.range, DECAY))
    }

    /// What the keys of the film are colored by in a picture of the series.
    pub(crate) fn film_values(&self, film: &Film, number: usize) -> anyhow::Result<Vec<f32>> {
        let series = self.series.as_ref();
        let timed = series.and_then(|series| Some((series, *series.times.get(number)?)));
        let (series, time) = timed.context("there is no such picture")?;
        film.values(&series.recording, time).map_err(whole)
    }
}

/// Colors of cells: by the options, or by numbers of one's `own`. `instances`: those of a circuit; `of_cells`: the cell
/// that each instance shows.
///
/// # Errors
/// A report is invalid.
pub(crate) fn of_pictures(
    cells: &[&MeshedCell],
    (instances, of_cells): (Option<&CircuitInstances>, &[usize]),
    args: &RenderArgs,
    own: Option<OwnNumbers>,
    reporter: &Reporter,
) -> anyhow::Result<PictureColors> {
    tell_unused_types(cells.iter().copied(), args, reporter);
    let scheme = scheme(args);
    let names: Vec<String> = cells.iter().map(|cell| stem(&cell.file)).collect();
    let cells: Vec<Cell<'_>> = cells
        .iter()
        .zip(&names)
        .map(|(cell, name)| Cell {
            name,
            morphology: &cell.morphology,
            mesh: &cell.mesh,
            radius_factor: args.radius_factor(),
        })
        .collect();
    let (values, series) = match own {
        Some(OwnNumbers::Still(values)) => (Some(values), None),
        Some(OwnNumbers::OverTime(series)) => (None, Some(series)),
        None => (None, None),
    };
    let mut colored = match (&args.report, series, instances) {
        (_, Some(series), _) => {
            let recording = Recording::of_series(series, &cells, of_cells);
            over_time(recording, args, &scheme, reporter)?
        }
        (Some(report), _, Some(instances)) => {
            let nodes = instances.with_cells(of_cells);
            let recording =
                Recording::open(report, &instances.circuit, &cells, &nodes).map_err(whole)?;
            over_time(recording, args, &scheme, reporter)?
        }
        _ => {
            let coloring = match (values, instances) {
                (Some(values), _) => Some(by_values(&cells, &values, &scheme)),
                (None, Some(instances)) => of_circuit(&cells, instances, args, &scheme)?,
                (None, None) => None,
            };
            // Values have been handled: arguments were checked, so that they come with a report.
            let by = args.color_by.and_then(by).unwrap_or_default();
            let by_tracing = || coloring::coloring(&cells, by, &scheme);
            let coloring = coloring.unwrap_or_else(by_tracing);
            PictureColors {
                closest: None,
                coloring,
                markers: None,
                mesh_keys: Vec::new(),
                series: None,
                neurons: 0,
                widths: (0.0, 1.0),
            }
        }
    };
    colored.neurons = of_cells.len();
    colored.set_widths(args);
    let nodes = instances.map(CircuitInstances::refs).unwrap_or_default();
    let drawn = instances.map(|instances| (&instances.circuit, &nodes[..]));
    colored.markers = markers::read(&args.markers, drawn, &scheme, reporter)?;
    if let Some(markers) = &mut colored.markers {
        colored.coloring.add_markers(markers);
    }
    if colored.series.is_none() {
        colored.closest = color_check::check(&colored.coloring, args, reporter);
    }
    Ok(colored)
}

/// The colors that the options ask for.
fn scheme(args: &RenderArgs) -> ColorScheme {
    let background = args.background();
    ColorScheme {
        palette: args.base_palette(),
        own_colors: args.own_colors(),
        background,
        scale: args.color_scale(background),
        range: args.range,
    }
}

/// Warns of types that are asked for and that no cell has.
pub(crate) fn tell_unused_types<'c>(
    cells: impl Iterator<Item = &'c MeshedCell>,
    args: &RenderArgs,
    reporter: &Reporter,
) {
    let kinds = args.types.iter().flat_map(|types| types.0.clone());
    let kinds: Vec<NeuriteKind> = kinds.collect();
    let kinds = (!kinds.is_empty()).then_some(&kinds[..]);
    if let Some(unused) = unused_kinds(cells.map(|cell| &cell.morphology), kinds) {
        reporter.warning(&format!("{unused}: check --types"));
    }
}

/// Colors of whole cells of a circuit, if the options ask for them.
fn of_circuit(
    cells: &[Cell<'_>],
    instances: &CircuitInstances,
    args: &RenderArgs,
    scheme: &ColorScheme,
) -> anyhow::Result<Option<Coloring>> {
    let neurons = instances.nodes();
    match (&args.color_by_attribute, args.color_by) {
        (Some(attribute), _) => {
            let named = |e| anyhow::anyhow!("{}: {e}", instances.circuit.file);
            let coloring = by_attribute(cells, &neurons, attribute, scheme);
            coloring.map(Some).map_err(named)
        }
        (None, Some(ColorBy::Neuron)) => {
            Ok(Some(coloring::each(cells, &instances.names(), scheme)))
        }
        (None, None) => Ok(coloring::given(cells, &neurons, scheme)),
        (None, Some(_)) => Ok(None),
    }
}

/// Colors by values of a recording: at one time, or over a series.
fn over_time(
    recording: Recording,
    args: &RenderArgs,
    scheme: &ColorScheme,
    reporter: &Reporter,
) -> anyhow::Result<PictureColors> {
    for warning in &recording.warnings {
        reporter.warning(warning);
    }
    let without = recording.without();
    if without > 0 {
        let (all, file) = (recording.places(), &recording.file);
        reporter.warning(&format!(
            "{file}: no values for {without} of {all} cells: drawn gray"
        ));
    }
    if let Some(unknown) = recording.unknown_sections() {
        reporter.warning(&format!("{}: {unknown}", recording.file));
    }
    if args.time.is_none() && args.times.is_none() && recording.is_of_spikes() {
        let file = &recording.file;
        anyhow::bail!("{file}: spikes flash at a time: choose one with --time");
    }
    let times = match &args.times {
        Some(times) => times.clone(),
        None => times::times(args.time, args.frames)?.unwrap_or_else(|| vec![recording.time.start]),
    };
    let range = match args.range {
        Some(range) => range,
        None => {
            let times = times.iter().copied();
            recording.range_at(times, &|_| true).map_err(whole)?
        }
    };
    let coloring = recording.coloring(range, scheme);
    color_check::check(&coloring, args, reporter);
    let series = Some(RecordedSeries {
        recording,
        times,
        range,
    });
    let mut colored = PictureColors {
        coloring,
        markers: None,
        mesh_keys: Vec::new(),
        series,
        neurons: 0,
        widths: (0.0, 1.0),
        closest: None,
    };
    let (table, legend) = colored.picture(0)?;
    (colored.coloring.table, colored.coloring.legend) = (table, legend);
    Ok(colored)
}

/// An error with the message only: with its source, the message would be printed twice.
fn whole(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow::anyhow!("{error}")
}

pub(crate) fn stem(file: &str) -> String {
    let stem = Path::new(file).file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

/// What colors tell; none for values.
pub(crate) fn by(what: ColorBy) -> Option<coloring::ColorBy> {
    Some(match what {
        ColorBy::Value => return None,
        ColorBy::Type => coloring::ColorBy::Type,
        ColorBy::Neurite => coloring::ColorBy::Neurite,
        ColorBy::Section => coloring::ColorBy::Section,
        ColorBy::BranchOrder => coloring::ColorBy::BranchOrder,
        ColorBy::Radius => coloring::ColorBy::Radius,
        ColorBy::PathDistance => coloring::ColorBy::PathDistance,
        ColorBy::Neuron => coloring::ColorBy::Neuron,
    })
}
