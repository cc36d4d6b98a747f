//! Colors of pictures, by the options.

use std::path::Path;

use neurotess_color::{
    self as coloring, Cell, ClosestColors, ColorScheme, Coloring, DECAY, Film, MarkerSet,
    MeshValues, OwnNumbers, Recording, by_attribute, by_values,
};
use neurotess_generate::unused_kinds;
use neurotess_picture::VisibleKey;
use neurotess_picture::color::ColorTable;
use neurotess_picture::overlay::Legend;

use neurotess_options::words::ColorWhat;

mod check;
mod times;

use crate::error::DrawError;
use crate::host::Host;
use crate::meshed::MeshedCell;
use crate::options::DrawOptions;
use crate::scene::CircuitInstances;
use crate::scene::markers::read_markers;
use crate::scene::meshes::{MeshKeys, SceneMeshes};
use times::time_text;

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
    pub(crate) fn picture(&self, number: usize) -> Result<(ColorTable, Legend), DrawError> {
        let Coloring { table, .. } = &self.coloring;
        let legend = self.legend(number);
        let time = |series: &RecordedSeries| series.times.get(number).copied();
        let Some((series, time)) = self.series.as_ref().and_then(|f| Some((f, time(f)?))) else {
            return Ok((table.clone(), legend));
        };
        let frame = series
            .recording
            .at(time, DECAY, &|_| true)
            .map_err(DrawError::failed)?;
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
        asked: &DrawOptions,
    ) -> Result<(), DrawError> {
        let mut of_vertices = Vec::new();
        if let Some((values, told)) = values {
            meshes.check(values)?;
            if self.series.is_some() {
                return Err(DrawError::Failed(
                    "values of meshes are not shown beside a recording".into(),
                ));
            }
            of_vertices = self.coloring.add_mesh_values(values, &scheme(asked), told);
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
    pub(crate) fn set_widths(&mut self, asked: &DrawOptions) {
        let least = match self.neurons {
            0 => 0.0,
            neurons => asked.picture.look.width(neurons),
        };
        self.widths = (least, asked.picture.shape.factor());
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

    /// Time (ms) of a picture of a recording.
    pub(crate) fn time(&self, number: usize) -> Option<f64> {
        self.series.as_ref()?.times.get(number).copied()
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
    pub(crate) fn film_values(&self, film: &Film, number: usize) -> Result<Vec<f32>, DrawError> {
        let series = self.series.as_ref();
        let timed = series.and_then(|series| Some((series, *series.times.get(number)?)));
        let (series, time) =
            timed.ok_or_else(|| DrawError::Failed("there is no such picture".into()))?;
        film.values(&series.recording, time)
            .map_err(DrawError::failed)
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
    asked: &DrawOptions,
    own: Option<OwnNumbers>,
    host: &dyn Host,
) -> Result<PictureColors, DrawError> {
    tell_unused_types(cells, asked, host);
    let scheme = scheme(asked);
    let picture = &asked.picture;
    let names: Vec<String> = cells.iter().map(|cell| stem(&cell.file)).collect();
    let cells: Vec<Cell<'_>> = cells
        .iter()
        .zip(&names)
        .map(|(cell, name)| Cell {
            name,
            morphology: &cell.morphology,
            mesh: &cell.mesh,
            radius_factor: picture.shape.factor(),
        })
        .collect();
    let (values, series) = match own {
        Some(OwnNumbers::Still(values)) => (Some(values), None),
        Some(OwnNumbers::OverTime(series)) => (None, Some(series)),
        None => (None, None),
    };
    let mut colored = match (&picture.colors.report, series, instances) {
        (_, Some(series), _) => {
            let recording = Recording::of_series(series, &cells, of_cells);
            over_time(recording, asked, &scheme, host)?
        }
        (Some(report), _, Some(instances)) => {
            let nodes = instances.with_cells(of_cells);
            let recording = Recording::open(report, &instances.circuit, &cells, &nodes)
                .map_err(DrawError::failed)?;
            over_time(recording, asked, &scheme, host)?
        }
        _ => {
            let coloring = match (values, instances) {
                (Some(values), _) => Some(by_values(&cells, &values, &scheme)),
                (None, Some(instances)) => of_circuit(&cells, instances, asked, &scheme)?,
                (None, None) => None,
            };
            // Values have been handled: arguments were checked, so that they come with a report.
            let by = picture.colors.color_by.and_then(ColorWhat::by);
            let by = by.unwrap_or_default();
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
    colored.set_widths(asked);
    let nodes = instances.map(CircuitInstances::refs).unwrap_or_default();
    let drawn = instances.map(|instances| (&instances.circuit, &nodes[..]));
    colored.markers = read_markers(&picture.markers, drawn, &scheme, host)?;
    if let Some(markers) = &mut colored.markers {
        colored.coloring.add_markers(markers);
    }
    if colored.series.is_none() {
        colored.closest = check::check(&colored.coloring, picture, host);
    }
    Ok(colored)
}

/// The colors that the options ask for.
fn scheme(asked: &DrawOptions) -> ColorScheme {
    asked.picture.scheme(asked.scale.as_deref())
}

/// Warns of types that are asked for and that no cell has.
pub fn tell_unused_types(cells: &[&MeshedCell], asked: &DrawOptions, host: &dyn Host) {
    let kinds = asked.picture.shape.kinds();
    let cells = cells.iter().map(|cell| &cell.morphology);
    if let Some(unused) = unused_kinds(cells, kinds.as_deref()) {
        host.warning(&format!("{unused}: check --types"));
    }
}

/// Colors of whole cells of a circuit, if the options ask for them.
fn of_circuit(
    cells: &[Cell<'_>],
    instances: &CircuitInstances,
    asked: &DrawOptions,
    scheme: &ColorScheme,
) -> Result<Option<Coloring>, DrawError> {
    let colors = &asked.picture.colors;
    let neurons = instances.nodes();
    match (&colors.color_by_attribute, colors.color_by) {
        (Some(attribute), _) => {
            let named = |e| DrawError::Failed(format!("{}: {e}", instances.circuit.file));
            let coloring = by_attribute(cells, &neurons, attribute, scheme);
            coloring.map(Some).map_err(named)
        }
        (None, Some(ColorWhat::Neuron)) => {
            Ok(Some(coloring::each(cells, &instances.names(), scheme)))
        }
        (None, None) => Ok(coloring::given(cells, &neurons, scheme)),
        (None, Some(_)) => Ok(None),
    }
}

/// Colors by values of a recording: at one time, or over a series.
fn over_time(
    recording: Recording,
    asked: &DrawOptions,
    scheme: &ColorScheme,
    host: &dyn Host,
) -> Result<PictureColors, DrawError> {
    for warning in &recording.warnings {
        host.warning(warning);
    }
    let without = recording.without();
    if without > 0 {
        let (all, file) = (recording.places(), &recording.file);
        host.warning(&format!(
            "{file}: no values for {without} of {all} cells: drawn gray"
        ));
    }
    if let Some(unknown) = recording.unknown_sections() {
        host.warning(&format!("{}: {unknown}", recording.file));
    }
    let times = asked.picture.camera.all_times()?;
    if times.is_none() && recording.is_of_spikes() {
        let file = &recording.file;
        return Err(DrawError::Failed(format!(
            "{file}: spikes flash at a time: choose one with --time"
        )));
    }
    let times = times.unwrap_or_else(|| vec![recording.time.start]);
    let range = match asked.picture.colors.range {
        Some(range) => range,
        None => {
            let times = times.iter().copied();
            recording
                .range_at(times, &|_| true)
                .map_err(DrawError::failed)?
        }
    };
    let coloring = recording.coloring(range, scheme);
    check::check(&coloring, &asked.picture, host);
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

/// The name of a file without its folder and extension.
pub fn stem(file: &str) -> String {
    let stem = Path::new(file).file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}
