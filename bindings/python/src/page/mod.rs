//! Cells as one HTML page: `neurotess html`, of cells in memory.

mod shown;

use std::io::Write;
use std::path::PathBuf;

use glam::DVec3;
use neurotess::coloring::ColorBy;
use neurotess::drawing::{self, PageContent, PageError, PageValues, Picked, Quiet};
use neurotess::mesh::{CoarseMesh, Role};
use neurotess::morphology::SectionId;
use neurotess::options::Picture;
use neurotess::output::{Existing, write_whole};
use neurotess::web::{self, MAX_PAGE_BYTES, WebError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::cell::Cell;
use crate::circuit::Circuit;
use crate::errors;
use crate::options::draw_options;
use crate::picture::{GivenSeries, GivenValues, own_numbers, picked_dict, undrawn};
use crate::work::{Stop, detached, stoppable};
use shown::{Placed, Shown};

/// Adds what makes pages to the module.
pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("WIDGET", web::widget_script())?;
    module.add_class::<Page>()?;
    module.add_function(wrap_pyfunction!(page, module)?)
}

/// A circuit, and population and row of the nodes that are shown.
type GivenNodes<'py> = (PyRef<'py, Circuit>, Vec<(u32, u32)>);

/// Why there is no page.
enum Unmade {
    /// A cell has no mesh.
    Mesh(String),
    /// Options, and what a page cannot show.
    Page(PageError),
    /// More than people send.
    Large(usize),
}

/// A page, and what its host does not know of its cells.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Page {
    made: web::Page,
    /// Whether it holds values.
    #[pyo3(get)]
    has_values: bool,
    /// Times (ms) of the frames that are played.
    #[pyo3(get)]
    times: Vec<f64>,
    /// What there was to say.
    #[pyo3(get)]
    messages: Vec<String>,
    /// The cells at their places.
    placed: Vec<Placed>,
    /// By mesh, of each of its tracing points: section and the file's own number of its sample; none on somata.
    points: Vec<Vec<Option<(SectionId, i64)>>>,
}

#[pymethods]
impl Page {
    /// The page's text.
    #[getter]
    fn html(&self) -> &str {
        &self.made.html
    }

    /// What it can be colored by, with the entries of each legend; scales of numbers have none.
    #[getter]
    fn legends(&self) -> Vec<(&'static str, Vec<String>)> {
        let legends = self.made.legends.iter();
        legends
            .map(|(by, entries)| (name_of(*by), entries.clone()))
            .collect()
    }

    /// What is at a tracing point, by its color key; none if there is no such point.
    fn picked<'py>(
        &self,
        py: Python<'py>,
        key: usize,
        position: [f64; 3],
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let mut first = 0;
        for (cell, placed) in self.placed.iter().enumerate() {
            let points = &self.points[placed.cell];
            if let Some(point) = points.get(key - first) {
                let picked = Picked {
                    cell,
                    name: placed.name.clone(),
                    node: placed.node.map(|(_, id)| id),
                    section: point.map(|(section, _)| section),
                    sample: point.map(|(_, sample)| sample),
                    position: DVec3::from(position),
                };
                return picked_dict(py, picked).map(Some);
            }
            first += points.len();
        }
        Ok(None)
    }

    /// Writes it to a file, whole or not at all. `force`: also over one that exists.
    fn write(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<()> {
        let existing = match force {
            true => Existing::Replace,
            false => Existing::Refuse("use force=True, or another name"),
        };
        let html = self.made.html.as_bytes();
        let written = detached(py, || write_whole(&path, existing, |to| to.write_all(html)))?;
        written.map_err(|e| errors::output(&e))
    }
}

/// Makes a page of cells, or of nodes of a circuit. `force`: also a large one.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what a page is made of")]
fn page(
    py: Python<'_>,
    cells: Vec<PyRef<'_, Cell>>,
    circuit: Option<GivenNodes<'_>>,
    keywords: &Bound<'_, PyDict>,
    title: Option<String>,
    values: Option<GivenValues<'_>>,
    series: Option<GivenSeries<'_>>,
    force: bool,
) -> PyResult<Page> {
    let picture = draw_options(keywords)?.picture;
    let (own, _) = own_numbers(values, series)?;
    let mut shown = match circuit {
        Some((circuit, nodes)) => Shown::nodes(py, &circuit, nodes)?,
        None => Shown::alone(&cells),
    };
    let made = stoppable(py, None, &Stop::default(), move |stopped| {
        let options = picture.shape.generate();
        shown.cut(picture.colors.report.as_deref())?;
        let meshes = shown.meshes(&options, stopped)?;
        let unused = shown.unused_kinds(options.kinds.as_deref());
        let own = own.map(PageValues::Own);
        let mut page = Page::of(shown, &meshes, (&picture, title.as_deref()), own)?;
        page.messages
            .extend(unused.map(|unused| format!("{unused}: check types=")));
        match page.made.html.len() {
            bytes if bytes > MAX_PAGE_BYTES && !force => Err(Unmade::Large(bytes)),
            _ => Ok(page),
        }
    })?;
    made.map_err(|e| e.told(py))
}

impl Page {
    fn of(
        shown: Shown,
        meshes: &[CoarseMesh],
        (picture, title): (&Picture, Option<&str>),
        own: Option<PageValues>,
    ) -> Result<Self, Unmade> {
        let host = Quiet::default();
        let cells = shown.page_cells(meshes, picture.shape.factor());
        let nodes = shown.nodes_of();
        let content = PageContent {
            cells: &cells,
            circuit: shown.circuit.as_ref().map(|of| (&**of, &nodes[..])),
            title,
        };
        let made = drawing::page(&content, picture, own, &host).map_err(Unmade::Page)?;
        Ok(Self {
            made: made.page,
            has_values: made.has_values,
            times: made.times,
            messages: host.take_messages(),
            placed: shown.placed,
            points: meshes.iter().map(traced).collect(),
        })
    }
}

/// The name of what colors tell.
fn name_of(by: ColorBy) -> &'static str {
    match by {
        ColorBy::Type => "type",
        ColorBy::Neurite => "neurite",
        ColorBy::Section => "section",
        ColorBy::BranchOrder => "order",
        ColorBy::Radius => "radius",
        ColorBy::PathDistance => "depth",
        ColorBy::Neuron => "neuron",
    }
}

/// Section and sample of each tracing point; none on somata.
fn traced(mesh: &CoarseMesh) -> Vec<Option<(SectionId, i64)>> {
    let points = mesh.tracing.iter();
    let traced = points.map(|point| {
        let section = point.section.index().filter(|_| point.role != Role::Soma);
        section.map(|section| (SectionId(section as u32), i64::from(point.sample.0)))
    });
    traced.collect()
}

impl Unmade {
    fn told(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Mesh(message) => errors::mesh(py, &message),
            Self::Page(PageError::Draw(error)) => undrawn(py, &error),
            Self::Page(PageError::Page(WebError::Shader(fault))) => errors::bug(fault),
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
