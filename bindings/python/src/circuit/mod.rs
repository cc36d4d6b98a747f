//! Circuits: tables of nodes, their morphologies, places and meshes.

mod recordings;

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DAffine3, DVec3};
use neurotess::circuit::{
    self as circuits, Attribute, CircuitError, NodeRef, Selection, SynapseSide,
};
use neurotess::circuit::{Elements, Instance, soma_center};
use neurotess::mesh::Placed;
use neurotess::recipe::{CellMesh, MeshOptions};
use numpy::PyArray2;
use pyo3::exceptions::{PyIndexError, PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, Pair};
use crate::cell::Cell;
use crate::errors;
use crate::surface::{Columns, Recipe, Surface, Unmade, Untaken, meshed, of_made, taken};
use crate::work::{Stop, detached, released, stoppable};
pub(crate) use recordings::Report;

/// Coarse meshes that are kept, for nodes that share a morphology.
const KEPT: usize = 64;

/// A circuit or a scene.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Circuit {
    pub(crate) circuit: Arc<circuits::Circuit>,
}

/// Coarse meshes by the template, in the cell's own coordinates.
type Meshes = Mutex<HashMap<u32, Arc<CellMesh>>>;

#[pymethods]
impl Circuit {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let opened = released(py, None, move || circuits::Circuit::open(path))?;
        let circuit = opened.map_err(|e| unreadable(py, &e))?;
        Ok(Self {
            circuit: Arc::new(circuit),
        })
    }

    #[getter]
    fn file(&self) -> &str {
        &self.circuit.file
    }

    #[getter]
    fn format(&self) -> &str {
        self.circuit.format
    }

    /// What was odd, and parts that could not be opened.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        let warnings = self.circuit.warnings.iter().map(ToString::to_string);
        let failures = self.circuit.failures.iter().map(ToString::to_string);
        warnings.chain(failures).collect()
    }

    #[getter]
    fn node_sets(&self) -> Vec<String> {
        self.circuit.node_sets.names().map(str::to_owned).collect()
    }

    #[getter]
    fn reports(&self) -> Vec<(String, PathBuf)> {
        let reports = self.circuit.reports.iter();
        reports
            .map(|(name, path)| (name.clone(), path.clone()))
            .collect()
    }

    /// A report or a file of spikes of the circuit: a file, or one by the circuit's name of it.
    fn recording(&self, py: Python<'_>, path: PathBuf) -> PyResult<Report> {
        let opened = detached(py, || self.circuit.open_recording(&path))?;
        opened.map(Report::of).map_err(|e| unreadable(py, &e))
    }

    /// What the ids of a report's elements are: `section`, `synapse` or `electrode`.
    fn elements(&self, path: PathBuf) -> &'static str {
        let declared = self.circuit.declared_report(&path);
        declared
            .map_or(Elements::Sections, |report| report.elements)
            .name()
    }

    /// Name, populations of sources and targets, and count of each population of edges.
    #[getter]
    fn edges(&self) -> Vec<(String, String, String, u64)> {
        let edges = self.circuit.edges.iter();
        edges
            .map(|e| (e.name.clone(), e.source.clone(), e.target.clone(), e.count))
            .collect()
    }

    /// Ids of sources and targets, positions (none where the file has none) and further numbers of a population
    /// of edges.
    fn synapses<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        side: Option<&str>,
        numbers: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let side = match side {
            None => None,
            Some("afferent") => Some(SynapseSide::Afferent),
            Some("efferent") => Some(SynapseSide::Efferent),
            Some(other) => {
                let wrong = format!("side: {other:?} is neither 'afferent' nor 'efferent'");
                return Err(PyValueError::new_err(wrong));
            }
        };
        let found = self.circuit.edges.iter().find(|edges| edges.name == name);
        let Some(edges) = found.cloned() else {
            return Err(PyValueError::new_err(format!("no edges {name:?}")));
        };
        let wanted = numbers.clone();
        let read = released(py, None, move || {
            let synapses = match side {
                Some(side) => edges.synapses_on(side)?,
                None => edges.synapses()?,
            };
            let numbers = wanted.iter().map(|name| edges.property(name));
            Ok((synapses, numbers.collect::<Result<Vec<_>, _>>()?))
        })?;
        let read: Result<_, CircuitError> = read;
        let (synapses, values) = read.map_err(|e| unreadable(py, &e))?;
        let columns = PyDict::new(py);
        columns.set_item("source", arrays::column(py, synapses.sources)?)?;
        columns.set_item("target", arrays::column(py, synapses.targets)?)?;
        let positions = synapses.positions.iter().map(DVec3::to_array).collect();
        columns.set_item("position", arrays::rows(py, positions)?)?;
        for (name, values) in numbers.iter().zip(values) {
            columns.set_item(name, arrays::column(py, values)?)?;
        }
        Ok(columns)
    }

    /// Name and type of each population.
    #[getter]
    fn populations(&self) -> Vec<(String, String, usize)> {
        let populations = self.circuit.populations.iter();
        populations
            .map(|p| (p.name.clone(), p.kind.clone(), p.len()))
            .collect()
    }

    /// The columns of a population: numbers as arrays, text as names and the place of each node's in them.
    fn columns<'py>(&self, py: Python<'py>, population: usize) -> PyResult<Bound<'py, PyDict>> {
        let missing = || PyIndexError::new_err("no such population");
        let p = self
            .circuit
            .populations
            .get(population)
            .ok_or_else(missing)?;
        let columns = PyDict::new(py);
        columns.set_item("node_id", arrays::column(py, p.ids.clone())?)?;
        let places: Vec<[f64; 3]> = p.positions.iter().map(DVec3::to_array).collect();
        columns.set_item("position", arrays::rows(py, places)?)?;
        let turns: Vec<[f64; 4]> = p.rotations.iter().map(|q| [q.w, q.x, q.y, q.z]).collect();
        columns.set_item("rotation", arrays::rows(py, turns)?)?;
        let template = |t: &Option<circuits::TemplateId>| t.map_or(-1, |t| i64::from(t.0));
        let templates = p.templates.iter().map(template).collect();
        columns.set_item("template", arrays::column::<i64>(py, templates)?)?;
        let attributes = PyDict::new(py);
        for (name, attribute) in &p.attributes {
            match attribute {
                Attribute::Numbers(values) => {
                    attributes.set_item(name, arrays::column(py, values.clone())?)?;
                }
                Attribute::Text { library, indices } => {
                    let places = indices.iter();
                    let code = |&i: &u32| i64::from(i as i32).max(-1);
                    let codes = arrays::column::<i64>(py, places.map(code).collect())?;
                    attributes.set_item(name, (library.clone(), codes))?;
                }
            }
        }
        columns.set_item("attributes", attributes)?;
        Ok(columns)
    }

    /// Paths of the morphologies.
    #[getter]
    fn templates(&self) -> Vec<PathBuf> {
        let templates = self.circuit.templates.iter();
        templates.map(|template| template.path.clone()).collect()
    }

    /// Population and row of the nodes with these ids: of one population, or of whichever has them.
    ///
    /// # Errors
    /// `KeyError` for an id that is not there, `ValueError` for one that several populations have.
    fn find(&self, population: Option<&str>, ids: Vec<u64>) -> PyResult<Vec<(u32, u32)>> {
        let populations = || self.circuit.populations.iter().zip(0..);
        let searched =
            || populations().filter(|(p, _)| population.is_none_or(|name| p.name == name));
        if let Some(name) = population.filter(|_| searched().next().is_none()) {
            let names: Vec<_> = populations().map(|(p, _)| p.name.as_str()).collect();
            let wrong = format!("no population '{name}': there are {}", names.join(", "));
            return Err(PyValueError::new_err(wrong));
        }
        let mut of_id: HashMap<u64, Vec<(u32, u32)>> = HashMap::new();
        for (population, index) in searched() {
            for (&id, row) in population.ids.iter().zip(0..) {
                of_id.entry(id).or_default().push((index, row));
            }
        }
        let mut found = Vec::with_capacity(ids.len());
        for id in ids {
            match of_id.get(&id) {
                Some(nodes) if nodes.iter().all(|node| node.0 == nodes[0].0) => found.extend(nodes),
                Some(nodes) => return Err(ambiguous(&self.circuit, id, nodes)),
                None => {
                    let of = population.map_or_else(String::new, |name| format!(" in '{name}'"));
                    return Err(PyKeyError::new_err(format!("no node {id}{of}")));
                }
            }
        }
        Ok(found)
    }

    /// Population and row of each selected node.
    #[expect(clippy::too_many_arguments, reason = "what selects cells")]
    fn select(
        &self,
        py: Python<'_>,
        nodes: Option<Vec<(u32, u32)>>,
        node_set: Option<String>,
        population: Option<String>,
        region: Option<([f64; 3], [f64; 3])>,
        sample: Option<usize>,
        sample_seed: u64,
    ) -> PyResult<Pair<u32, u32>> {
        let selection = Selection {
            population,
            ids: None,
            nodes: nodes.map(|nodes| nodes.into_iter().map(node_ref).collect()),
            node_set,
            region: region.map(|(a, b)| {
                let (a, b) = (DVec3::from(a), DVec3::from(b));
                (a.min(b), a.max(b))
            }),
            sample: sample.map(|count| (count, sample_seed)),
        };
        let nodes = detached(py, || self.circuit.select(&selection))?
            .map_err(|e| PyValueError::new_err(e.to_string()))?;
        let populations = nodes.iter().map(|node| node.population).collect();
        let rows = nodes.iter().map(|node| node.row).collect();
        Ok((arrays::column(py, populations)?, arrays::column(py, rows)?))
    }

    /// A morphology of the circuit, in its own coordinates.
    fn morphology(&self, py: Python<'_>, template: usize) -> PyResult<Cell> {
        let missing = || PyIndexError::new_err("no such morphology");
        let template = self.circuit.templates.get(template).ok_or_else(missing)?;
        let read = detached(py, || template.read().cloned())?;
        read.map(Cell::of_read).map_err(|e| errors::read(py, e))
    }

    /// Where the cell of a node is: rows of the matrix from the cell's coordinates to the circuit's.
    fn placement(&self, py: Python<'_>, population: u32, row: u32) -> PyResult<[[f64; 4]; 3]> {
        let instance = self.instance(population, row)?;
        let template = &self.circuit.templates[instance.template.index()];
        let read = detached(py, || template.read())?;
        let read = read.map_err(|e| errors::read(py, e))?;
        let at = instance.world_from_cell(soma_center(&read.morphology));
        let rows = at.matrix3.transpose();
        let row = |axis: usize| {
            let [x, y, z] = rows.col(axis).to_array();
            [x, y, z, at.translation[axis]]
        };
        Ok([row(0), row(1), row(2)])
    }

    /// Places of the synapses that a node gets, in the coordinates of its morphology.
    fn inputs(&self, py: Python<'_>, population: u32, row: u32) -> PyResult<Py<PyArray2<f64>>> {
        let instance = self.instance(population, row)?;
        let template = &self.circuit.templates[instance.template.index()];
        let read = detached(py, || template.read())?;
        let read = read.map_err(|e| errors::read(py, e))?;
        let at = instance.world_from_cell(soma_center(&read.morphology));
        let inputs = detached(py, || self.circuit.inputs(&[instance]))?;
        let inputs = inputs.map_err(|e| unreadable(py, &e))?;
        let cell_from_world = at.inverse();
        let places = inputs.iter().flatten();
        let places = places.map(|&place| cell_from_world.transform_point3(place).to_array());
        arrays::rows(py, places.collect())
    }

    /// Meshes cells of this circuit: the surface, what is known of its making, and the cell.
    fn mesher(&self, recipe: &Recipe) -> Mesher {
        Mesher {
            circuit: Arc::clone(&self.circuit),
            options: recipe.0.clone(),
            meshes: Arc::default(),
        }
    }
}

impl Circuit {
    fn instance(&self, population: u32, row: u32) -> PyResult<Instance> {
        instance(&self.circuit, population, row)
    }
}

/// Meshes of nodes in the circuit's coordinates; nodes that share a morphology share its coarse mesh.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Mesher {
    circuit: Arc<circuits::Circuit>,
    options: MeshOptions,
    meshes: Arc<Meshes>,
}

#[pymethods]
impl Mesher {
    fn mesh<'py>(
        &self,
        py: Python<'py>,
        population: u32,
        row: u32,
        threads: Option<usize>,
    ) -> PyResult<(Surface, Bound<'py, PyAny>, Cell)> {
        let instance = instance(&self.circuit, population, row)?;
        let template = instance.template;
        // Its errors have their own exception.
        let file = &self.circuit.templates[template.index()];
        let read = detached(py, || file.read())?.map_err(|e| errors::read(py, e))?;
        let (circuit, meshes) = (Arc::clone(&self.circuit), Arc::clone(&self.meshes));
        let options = self.options.clone();
        let made = stoppable(py, threads, &Stop::default(), move |stopped| {
            let read = circuit.templates[template.index()].read();
            let read = read.map_err(ToString::to_string)?;
            let mesh = kept(&meshes, template.0, || {
                let morphology = Arc::new(read.morphology.clone());
                meshed(morphology, &options, stopped)
            })?;
            let at = instance.world_from_cell(soma_center(&read.morphology));
            let (columns, report) = taken(&mesh, |surface| placed(surface, at, stopped))?;
            Ok((columns, report, Arc::clone(&mesh.morphology)))
        })?;
        let made: Result<_, Unmade> = made;
        let (made, morphology) = match made {
            Ok((columns, report, morphology)) => (Ok((columns, report)), Some(morphology)),
            Err(error) => (Err(error), None),
        };
        let (surface, report) = of_made(py, made)?;
        let morphology = morphology.ok_or_else(|| errors::bug("a mesh without a tracing"))?;
        Ok((surface, report, Cell::shared(&morphology, read)))
    }
}

fn placed(
    surface: &dyn neurotess::mesh::Surface,
    at: DAffine3,
    stopped: &AtomicBool,
) -> Result<Columns, Untaken> {
    Columns::of(&Placed::new(surface, at), stopped)
}

/// The mesh of a template: the one that is there, or one that is made.
fn kept(
    meshes: &Meshes,
    template: u32,
    make: impl FnOnce() -> Result<CellMesh, Unmade>,
) -> Result<Arc<CellMesh>, Unmade> {
    let lock = || meshes.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(mesh) = lock().get(&template) {
        return Ok(Arc::clone(mesh));
    }
    let mesh = Arc::new(make()?);
    let mut meshes = lock();
    if meshes.len() >= KEPT {
        meshes.clear();
    }
    meshes.insert(template, Arc::clone(&mesh));
    Ok(mesh)
}

pub(crate) fn node_ref((population, row): (u32, u32)) -> NodeRef {
    NodeRef { population, row }
}

/// An id that several populations have.
fn ambiguous(circuit: &circuits::Circuit, id: u64, nodes: &[(u32, u32)]) -> PyErr {
    let name =
        |&(population, _): &(u32, u32)| circuit.populations[population as usize].name.as_str();
    let mut names: Vec<_> = nodes.iter().map(name).collect();
    names.dedup();
    PyValueError::new_err(format!(
        "several populations have a node {id} ({}): give population=, rows of `Circuit.nodes`, or pairs like \
         ('{}', {id})",
        names.join(", "),
        names[0]
    ))
}

fn instance(circuit: &circuits::Circuit, population: u32, row: u32) -> PyResult<Instance> {
    let nodes = circuit.populations.get(population as usize);
    if nodes.is_none_or(|p| row as usize >= p.len()) {
        return Err(PyIndexError::new_err("no such node"));
    }
    let found = circuit.instances(&[NodeRef { population, row }], None);
    found.first().copied().ok_or_else(|| {
        PyValueError::new_err("the node has no place, or its morphology does not exist")
    })
}

/// A part of a circuit that cannot be read.
fn unreadable(py: Python<'_>, error: &CircuitError) -> PyErr {
    if let circuits::Fault::Io(e) = &error.fault {
        return errors::read_io(py, &error.file, e);
    }
    let fault = &error.fault;
    let message = match &error.key {
        Some(key) => format!("'{key}': {fault}"),
        None => fault.to_string(),
    };
    errors::read_of(py, &error.file, error.line.map(u64::from), &message)
}
