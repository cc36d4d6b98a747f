//! Cells as one HTML page: `neurotess html`, of cells in memory.

use std::collections::HashMap;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use neurotess::circuit::{Instance, NodeRef, soma_center};
use neurotess::coloring::{
    self, ColorBy, ColorScheme, OwnColors, OwnSeries, OwnValues, Recording, rgb,
};
use neurotess::generate::{GenerateOptions, generate_stoppable};
use neurotess::mesh::CoarseMesh;
use neurotess::morphology::Morphology;
use neurotess::output::{Existing, write_whole};
use neurotess::render::color::{ColorMap, Palette, Rgb};
use neurotess::render::{Look, Placement};
use neurotess::web::{
    MAX_PAGE_BYTES, PageCell, PageMarkers, PageOptions, PageRecording, WebError, shared_page,
    usual_title,
};
use neurotess_cli::embed;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::cell::Cell;
use crate::circuit::{Circuit, node_ref};
use crate::errors;
use crate::picture::{GivenSeries, GivenValues, own_series, own_values};
use crate::surface::Recipe;
use crate::work::{Stop, stoppable};

/// What a page may be colored by, under the names that the command line has.
const COLOR_BY: [(&str, ColorBy); 7] = [
    ("type", ColorBy::Type),
    ("neurite", ColorBy::Neurite),
    ("section", ColorBy::Section),
    ("order", ColorBy::BranchOrder),
    ("radius", ColorBy::Radius),
    ("depth", ColorBy::PathDistance),
    ("neuron", ColorBy::Neuron),
];

/// The keywords of a page, as Python has them. What is none has its default.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Keywords {
    title: Option<String>,
    color_by: Option<String>,
    palette: Option<String>,
    set_color: Vec<(String, String)>,
    colormap: Option<String>,
    range: Option<[f32; 2]>,
    background: Option<String>,
    least_width: Option<f32>,
}

/// A circuit, and population and row of the nodes that are shown.
type GivenNodes<'py> = (PyRef<'py, Circuit>, Vec<(u32, u32)>);

/// What a page begins with.
struct Colors {
    first: Option<ColorBy>,
    palette: Palette,
    own_colors: OwnColors,
    color_map: ColorMap,
    background: Option<Rgb>,
}

/// The cells of a page: each that is meshed once, and where which is shown under which name.
struct Shown {
    cells: Vec<Arc<Morphology>>,
    placements: Vec<(usize, Placement, String)>,
}

/// Numbers of one's own.
enum Own {
    Still(OwnValues),
    OverTime(OwnSeries),
}

impl Own {
    /// Numbers as a page plays them; `range`: those at the ends of the scale, if they are not the least and the greatest.
    fn recording(
        self,
        cells: &[coloring::Cell<'_>],
        range: Option<[f32; 2]>,
    ) -> Result<PageRecording, Unmade> {
        match self {
            Self::Still(values) => Ok(PageRecording::still(cells, &values, range)),
            Self::OverTime(series) => {
                let own: Vec<usize> = (0..cells.len()).collect();
                let recording = Recording::of_series(series, cells, &own);
                embed::page_recording(&recording, None, range, cells.len())
                    .map_err(|e| Unmade::Values(e.to_string()))
            }
        }
    }
}

/// Why there is no page.
enum Unmade {
    /// A cell has no mesh.
    Mesh(String),
    /// Cells that a page cannot show.
    Page(WebError),
    /// Numbers that cannot be shown.
    Values(String),
    /// More than people send.
    Large(usize),
}

/// Makes a page of cells, or of nodes of a circuit, and writes it to `path` if there is one. `force`: also over a file
/// that exists, and a large one.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what a page is made of")]
pub(crate) fn page(
    py: Python<'_>,
    cells: Vec<PyRef<'_, Cell>>,
    circuit: Option<GivenNodes<'_>>,
    recipe: &Recipe,
    keywords: Keywords,
    values: Option<GivenValues<'_>>,
    series: Option<GivenSeries<'_>>,
    path: Option<PathBuf>,
    force: bool,
) -> PyResult<Option<String>> {
    let colors = Colors::of(&keywords).map_err(|e| errors::option(py, &e))?;
    let values = values.map(own_values).transpose()?;
    let series = series.map(own_series).transpose()?;
    let own = match (series, values) {
        (Some((series, _)), _) => Some(Own::OverTime(series)),
        (None, values) => values.map(Own::Still),
    };
    let shown = match circuit {
        Some((circuit, nodes)) => Shown::nodes(py, &circuit, nodes)?,
        None => Shown::alone(&cells),
    };
    let options = recipe.0.generate.clone();
    let made = stoppable(py, None, &Stop::default(), move |stopped| {
        let meshes = shown.meshes(&options, stopped)?;
        let factor = options.radius_factor;
        let html = shown.page(&meshes, factor, &keywords, colors, own)?;
        match html.len() > MAX_PAGE_BYTES && !force {
            true => Err(Unmade::Large(html.len())),
            false => Ok(html),
        }
    })?;
    let html = made.map_err(|e| e.told(py))?;
    let Some(path) = path else {
        return Ok(Some(html));
    };
    let existing = match force {
        true => Existing::Replace,
        false => Existing::Refuse("use force=True, or another name"),
    };
    let written = py.detach(|| write_whole(&path, existing, |to| to.write_all(html.as_bytes())));
    written.map_err(|e| errors::output(&e))?;
    Ok(None)
}

impl Colors {
    /// # Errors
    /// A word that is none, in the words that errors of options are read from.
    fn of(keywords: &Keywords) -> Result<Self, String> {
        let wrong = |option: &str, value: &str, needed: &str| {
            format!("invalid value '{value}' for '{option}': {needed}")
        };
        let palette = keywords
            .palette
            .as_deref()
            .map(|text| embed::palette(text).map_err(|needed| wrong("palette", text, &needed)));
        let palette = palette.transpose()?.unwrap_or_default();
        let mut own_colors = palette.own_colors;
        for (name, color) in &keywords.set_color {
            let color = rgb(color);
            let color = color.map_err(|needed| wrong("palette", name, &needed))?;
            own_colors.set_named(name, color);
        }
        let map = keywords.colormap.as_deref().map(|name| {
            let maps = ColorMap::ALL.map(ColorMap::name);
            name.parse::<ColorMap>()
                .map_err(|_| unknown("colormap", name, &maps))
        });
        let background = keywords
            .background
            .as_deref()
            .map(|color| rgb(color).map_err(|needed| wrong("background", color, &needed)));
        Ok(Self {
            first: first(keywords.color_by.as_deref())?,
            palette: palette.base.unwrap_or_default(),
            own_colors,
            color_map: map.transpose()?.unwrap_or_default(),
            background: background.transpose()?,
        })
    }
}

/// What a page begins with; none: with values, or by type.
fn first(word: Option<&str>) -> Result<Option<ColorBy>, String> {
    let Some(word) = word.filter(|&word| word != "value") else {
        return Ok(None);
    };
    let found = COLOR_BY.iter().find(|(name, _)| *name == word);
    let mut words: Vec<&str> = COLOR_BY.iter().map(|&(name, _)| name).collect();
    words.push("value");
    found
        .map(|&(_, by)| Some(by))
        .ok_or_else(|| unknown("color_by", word, &words))
}

fn unknown(option: &str, given: &str, words: &[&str]) -> String {
    let words = words.join(", ");
    format!("invalid value '{given}' for '{option}' [possible values: {words}]")
}

impl Shown {
    /// Cells in their own coordinates.
    fn alone(cells: &[PyRef<'_, Cell>]) -> Self {
        let cells: Vec<_> = cells.iter().map(|c| Arc::clone(&c.morphology)).collect();
        let named = cells.iter().enumerate();
        let placements = named.map(|(k, cell)| (k, Placement::default(), cell.name.clone()));
        Self {
            placements: placements.collect(),
            cells,
        }
    }

    /// Nodes of a circuit at their places; each morphology once.
    ///
    /// # Errors
    /// A morphology that cannot be read; no node has one.
    fn nodes(py: Python<'_>, circuit: &Circuit, nodes: Vec<(u32, u32)>) -> PyResult<Self> {
        let circuit = &circuit.circuit;
        let nodes: Vec<NodeRef> = nodes.into_iter().map(node_ref).collect();
        let instances = circuit.instances(&nodes, None);
        if instances.is_empty() {
            let nothing = "no chosen cell has a morphology and a place: choose others";
            return Err(PyValueError::new_err(nothing));
        }
        let mut shown = Self {
            cells: Vec::new(),
            placements: Vec::with_capacity(instances.len()),
        };
        let mut of_template = HashMap::new();
        for instance in &instances {
            let cell = match of_template.get(&instance.template.index()) {
                Some(&cell) => cell,
                None => {
                    let template = &circuit.templates[instance.template.index()];
                    let read = py.detach(|| template.read());
                    let read = read.map_err(|e| errors::read(py, e))?;
                    shown.cells.push(Arc::new(read.morphology.clone()));
                    of_template.insert(instance.template.index(), shown.cells.len() - 1);
                    shown.cells.len() - 1
                }
            };
            let population = &circuit.populations[instance.node.population as usize];
            let name = format!("{} {}", population.name, instance.id);
            let placement = placement(instance, &shown.cells[cell]);
            shown.placements.push((cell, placement, name));
        }
        Ok(shown)
    }

    fn meshes(
        &self,
        options: &GenerateOptions,
        stopped: &AtomicBool,
    ) -> Result<Vec<CoarseMesh>, Unmade> {
        let mesh = |cell: &Arc<Morphology>| {
            let generated = generate_stoppable(cell, options, || 0.0, stopped);
            let generated = generated.map_err(|e| Unmade::Mesh(format!("{}: {e}", cell.name)))?;
            Ok(generated.mesh)
        };
        self.cells.par_iter().map(mesh).collect()
    }

    fn page(
        &self,
        meshes: &[CoarseMesh],
        radius_factor: f64,
        keywords: &Keywords,
        colors: Colors,
        own: Option<Own>,
    ) -> Result<String, Unmade> {
        let placed = self.placements.iter();
        let cells: Vec<PageCell<'_>> = placed
            .map(|(cell, placement, name)| PageCell {
                cell: coloring::Cell {
                    name,
                    morphology: &self.cells[*cell],
                    mesh: &meshes[*cell],
                    radius_factor,
                },
                placement: *placement,
            })
            .collect();
        let colored: Vec<_> = cells.iter().map(|page| page.cell).collect();
        let recording = own.map(|own| own.recording(&colored, keywords.range));
        let recording = recording.transpose()?;
        let scheme = ColorScheme {
            palette: colors.palette,
            own_colors: colors.own_colors.clone(),
            background: None,
            scale: colors.color_map.scale(),
            range: keywords.range.filter(|_| recording.is_none()),
        };
        let names: Vec<&str> = colored.iter().map(|cell| cell.name).collect();
        let title = keywords.title.clone();
        let options = PageOptions {
            title: title.unwrap_or_else(|| usual_title(&names)),
            background: colors.background,
            palette: colors.palette,
            own_colors: colors.own_colors,
            color_map: colors.color_map,
            scheme: None,
            least_width: (keywords.least_width)
                .unwrap_or_else(|| Look::usual_least_width(cells.len())),
        };
        let none = PageMarkers::default();
        let recording = recording.as_ref();
        let made = shared_page(&cells, &scheme, colors.first, recording, &none, &options);
        made.map(|page| page.html).map_err(Unmade::Page)
    }
}

fn placement(instance: &Instance, cell: &Morphology) -> Placement {
    Placement {
        rotation: instance.rotation,
        scale: instance.scale,
        translation: instance.world_from_cell(soma_center(cell)).translation,
    }
}

impl Unmade {
    fn told(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Mesh(message) => errors::mesh(py, &message),
            Self::Values(message) => PyValueError::new_err(message),
            Self::Page(WebError::Shader(fault)) => errors::bug(fault),
            Self::Page(error) => PyValueError::new_err(error.to_string()),
            Self::Large(bytes) => {
                let size = bytes as f64 / 1e6;
                PyValueError::new_err(format!(
                    "the page would have {size:.1} MB: leave out cells, or use force=True"
                ))
            }
        }
    }
}
