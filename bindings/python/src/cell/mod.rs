//! A traced cell.

mod columns;
mod edits;
mod numbers;
mod paths;
mod state;
mod table;

use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

use neurotess::formats::swc::SampleNumbers;
use neurotess::formats::{self, Format, Read, ReadError, ReadOptions, Warning};
use neurotess::morphology::{
    Measures, Morphology, Program, exposed_areas, shape, soma_area_volume,
};
use neurotess::output::{Existing, Output};
use neurotess::synth;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict};

use crate::work::{detached, released};
use crate::{arrays, errors, json};
pub(crate) use edits::{Edits, diff};
use numbers::Column;

/// A morphology and its arrays, which are made when they are first asked for.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Cell {
    pub(crate) morphology: Arc<Morphology>,
    format: String,
    warnings: Vec<Told>,
    points: PyOnceLock<Py<PyArray2<f64>>>,
    radii: PyOnceLock<Py<PyArray1<f64>>>,
    types: PyOnceLock<Py<PyArray1<i32>>>,
    parents: PyOnceLock<Py<PyArray1<i64>>>,
    samples: PyOnceLock<Py<PyArray1<i64>>>,
}

/// A warning of the reader.
#[derive(Clone)]
struct Told {
    code: String,
    message: String,
    line: Option<u64>,
    count: u64,
}

impl From<Warning> for Told {
    fn from(warning: Warning) -> Self {
        Self {
            code: warning.code.into(),
            message: warning.message,
            line: warning.line,
            count: warning.count,
        }
    }
}

impl Cell {
    /// A cell with what its reader said of it.
    fn new(morphology: Arc<Morphology>, format: &str, warnings: Vec<Told>) -> Self {
        Self {
            morphology,
            format: format.into(),
            warnings,
            points: PyOnceLock::new(),
            radii: PyOnceLock::new(),
            types: PyOnceLock::new(),
            parents: PyOnceLock::new(),
            samples: PyOnceLock::new(),
        }
    }

    /// A cell that is somewhere already.
    pub(crate) fn shared(morphology: &Arc<Morphology>, read: &Read) -> Self {
        let warnings = read.warnings.iter().cloned().map(Told::from).collect();
        Self::new(Arc::clone(morphology), read.format, warnings)
    }

    /// What a reader gave.
    pub(crate) fn of_read(read: Read) -> Self {
        let warnings = read.warnings.into_iter().map(Told::from).collect();
        Self::new(Arc::new(read.morphology), read.format, warnings)
    }

    /// The result of a reader.
    fn of_result(py: Python<'_>, read: Result<Read, ReadError>) -> PyResult<Self> {
        read.map(Self::of_read).map_err(|e| errors::read(py, &e))
    }
}

#[pymethods]
impl Cell {
    #[staticmethod]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        strict: bool,
        zero_for_bad_radii: bool,
    ) -> PyResult<Self> {
        let options = ReadOptions {
            strict,
            zero_for_bad_radii,
            ..ReadOptions::default()
        };
        // Small files take less time than a thread.
        let read = detached(py, || formats::read(path, &options))?;
        Self::of_result(py, read)
    }

    #[staticmethod]
    fn read_bytes(
        py: Python<'_>,
        bytes: Vec<u8>,
        name: String,
        format: Option<String>,
        strict: bool,
    ) -> PyResult<Self> {
        let format = format.map(|name| format_named(&name)).transpose()?;
        let options = reading(strict);
        let read = detached(py, || formats::read_bytes(bytes, &name, format, &options))?;
        Self::of_result(py, read)
    }

    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "the columns of a table")]
    fn from_columns(
        py: Python<'_>,
        ids: PyReadonlyArray1<'_, i64>,
        types: PyReadonlyArray1<'_, i64>,
        x: PyReadonlyArray1<'_, f64>,
        y: PyReadonlyArray1<'_, f64>,
        z: PyReadonlyArray1<'_, f64>,
        radii: PyReadonlyArray1<'_, f64>,
        parents: PyReadonlyArray1<'_, i64>,
        name: String,
        strict: bool,
    ) -> PyResult<Self> {
        let columns = table::Columns {
            integers: [ids.as_slice()?, types.as_slice()?, parents.as_slice()?],
            numbers: [
                x.as_slice()?,
                y.as_slice()?,
                z.as_slice()?,
                radii.as_slice()?,
            ],
        };
        let read = detached(py, || columns.read(&name, &reading(strict)))?;
        Self::of_result(py, read)
    }

    #[staticmethod]
    fn grow(
        py: Python<'_>,
        kind: &str,
        seed: u64,
        points: Option<usize>,
        may_cross: bool,
    ) -> PyResult<Self> {
        let kind = kind
            .parse()
            .map_err(|e: synth::UnknownKind| PyValueError::new_err(e.to_string()))?;
        let options = synth::Options {
            kind,
            seed,
            points,
            may_cross,
        };
        let grown = released(py, None, move || synth::grow(&options))?;
        Ok(Self::new(Arc::new(grown), "synth", Vec::new()))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.morphology.name
    }

    #[getter]
    fn header(&self) -> Vec<String> {
        self.morphology.header.clone()
    }

    #[getter]
    fn format(&self) -> &str {
        &self.format
    }

    /// Code, message, line and count of each.
    #[getter]
    fn warnings(&self) -> Vec<(&str, &str, Option<u64>, u64)> {
        let warnings = self.warnings.iter();
        warnings
            .map(|w| (w.code.as_str(), w.message.as_str(), w.line, w.count))
            .collect()
    }

    fn __len__(&self) -> usize {
        self.morphology.points.len()
    }

    #[getter]
    fn points(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        let made = || arrays::rows(py, columns::points(&self.morphology));
        Ok(self.points.get_or_try_init(py, made)?.clone_ref(py))
    }

    #[getter]
    fn radii(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        let made = || arrays::column(py, columns::radii(&self.morphology));
        Ok(self.radii.get_or_try_init(py, made)?.clone_ref(py))
    }

    #[getter]
    fn types(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i32>>> {
        let made = || arrays::column(py, columns::types(&self.morphology));
        Ok(self.types.get_or_try_init(py, made)?.clone_ref(py))
    }

    #[getter]
    fn parents(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i64>>> {
        let made = || arrays::column(py, columns::parents(&self.morphology));
        Ok(self.parents.get_or_try_init(py, made)?.clone_ref(py))
    }

    #[getter]
    fn samples(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i64>>> {
        let made = || arrays::column(py, self.morphology.sample_ids.clone());
        Ok(self.samples.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// See [`numbers::sample_labels`].
    fn sample_labels(&self, py: Python<'_>) -> PyResult<(Column<i64>, Vec<Column<i64>>)> {
        numbers::sample_labels(py, &self.morphology)
    }

    /// Places (µm) of spines that are not in the tree.
    #[getter]
    fn spines(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        let cell = &self.morphology;
        let spines = cell.spines.iter();
        let places = spines.map(|spine| (cell.origin + spine.as_dvec3()).to_array());
        arrays::rows(py, places.collect())
    }

    /// See [`numbers::neuron_places`].
    fn neuron_places<'py>(
        &self,
        py: Python<'py>,
        numbers: PyReadonlyArray1<'py, i64>,
        along: PyReadonlyArray1<'py, f32>,
    ) -> PyResult<(Column<i64>, Column<f32>)> {
        numbers::neuron_places(py, &self.morphology, numbers.as_slice()?, along.as_slice()?)
    }

    /// See [`numbers::neuron_numbers`].
    fn neuron_numbers<'py>(
        &self,
        py: Python<'py>,
        sections: PyReadonlyArray1<'py, i64>,
        along: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(Column<i64>, Column<f64>)> {
        numbers::neuron_numbers(
            py,
            &self.morphology,
            sections.as_slice()?,
            along.as_slice()?,
        )
    }

    /// Arrays with a value for each section.
    fn sections<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let cell = &*self.morphology;
        let of = |value: &dyn Fn(&neurotess::morphology::Section) -> i64| {
            arrays::column(py, cell.sections.iter().map(value).collect())
        };
        let parent = |s: &neurotess::morphology::Section| s.parent().map_or(-1, |p| i64::from(p.0));
        let wide = |values: Vec<u32>| values.into_iter().map(i64::from).collect();
        let sections = PyDict::new(py);
        sections.set_item("first", of(&|s| i64::from(s.first))?)?;
        sections.set_item("end", of(&|s| i64::from(s.end))?)?;
        sections.set_item("type", of(&|s| i64::from(s.kind.0))?)?;
        sections.set_item("parent", of(&parent)?)?;
        let neurites: Vec<i64> = wide(shape::neurites(cell));
        sections.set_item("neurite", arrays::column(py, neurites)?)?;
        for (name, program) in [
            ("neuron_section", Program::Neuron),
            ("morphio_section", Program::Morphio),
        ] {
            let numbers = numbers::section_numbers(cell, program);
            sections.set_item(name, arrays::column(py, numbers)?)?;
        }
        let orders: Vec<i64> = wide(shape::branch_orders(cell));
        sections.set_item("order", arrays::column(py, orders)?)?;
        sections.set_item("length", arrays::column(py, shape::section_lengths(cell))?)?;
        sections.set_item("area", arrays::column(py, shape::section_areas(cell))?)?;
        let volumes = shape::section_volumes(cell);
        sections.set_item("volume", arrays::column(py, volumes)?)?;
        sections.set_item(
            "path_length",
            arrays::column(py, shape::path_lengths(cell))?,
        )?;
        for (name, reach) in [
            ("local_angle", shape::LOCAL),
            ("remote_angle", shape::REMOTE),
        ] {
            let angles = shape::fork_angles(cell, reach).into_iter();
            let angles = angles.map(|angle| angle.unwrap_or(f64::NAN)).collect();
            sections.set_item(name, arrays::column::<f64>(py, angles)?)?;
        }
        Ok(sections)
    }

    /// What shows of the cones of each section (µm²).
    fn exposed_areas(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        let areas = detached(py, || exposed_areas(&self.morphology))?;
        arrays::column(py, areas)
    }

    /// A dictionary for each soma.
    fn somata<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let origin = self.morphology.origin;
        let one = |soma: &neurotess::morphology::Soma| {
            let (area, volume) = soma_area_volume(soma);
            let samples = soma.samples.iter();
            let at = |p: glam::Vec3| (origin + p.as_dvec3()).to_array();
            let points = samples.clone().map(|s| at(s.position)).collect();
            let radii = samples.clone().map(|s| f64::from(s.radius)).collect();
            let numbers = samples.map(|s| s.id).collect();
            let told = PyDict::new(py);
            told.set_item("kind", soma.kind.name())?;
            told.set_item("center", at(soma.center))?;
            told.set_item("radius", f64::from(soma.radius))?;
            told.set_item("area", area)?;
            told.set_item("volume", volume)?;
            told.set_item("points", arrays::rows(py, points)?)?;
            told.set_item("radii", arrays::column::<f64>(py, radii)?)?;
            told.set_item("samples", arrays::column::<i64>(py, numbers)?)?;
            Ok(told)
        };
        self.morphology.somata.iter().map(one).collect()
    }

    fn path_length(&self, py: Python<'_>, start: Option<u32>, end: Option<u32>) -> PyResult<f64> {
        detached(py, || paths::length(&self.morphology, [start, end]))?
    }

    fn path_distances(&self, py: Python<'_>, start: Option<u32>) -> PyResult<Py<PyArray1<f64>>> {
        let distances = detached(py, || paths::distances(&self.morphology, start))??;
        arrays::column(py, distances)
    }

    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let measures = detached(py, || Measures::of(&self.morphology))?;
        json::serialized(py, &measures)
    }

    /// Rows as SWC has them: numbers, types, positions, radii, numbers of the parents.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = detached(py, || table::rows(&self.morphology))?;
        let columns = PyDict::new(py);
        columns.set_item("id", arrays::column(py, table.ids)?)?;
        columns.set_item("type", arrays::column(py, table.types)?)?;
        columns.set_item("position", arrays::rows(py, table.positions)?)?;
        columns.set_item("radius", arrays::column(py, table.radii)?)?;
        columns.set_item("parent", arrays::column(py, table.parents)?)?;
        Ok(columns)
    }

    /// Writes a file, whole or not at all; tells what the format cannot hold.
    fn write(
        &self,
        py: Python<'_>,
        path: PathBuf,
        format: Option<String>,
        overwrite: bool,
        keep_ids: bool,
    ) -> PyResult<Vec<String>> {
        let numbers = match keep_ids {
            true => SampleNumbers::Kept,
            false => SampleNumbers::Ascending,
        };
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let format = match format {
            Some(name) => format_named(&name)?,
            None => format_named(&extension)?,
        };
        let existing = existing(overwrite);
        let lost = detached(py, || {
            let mut output = Output::create(&path, existing).map_err(|e| errors::output(&e))?;
            let lost = formats::write_numbered(&self.morphology, format, numbers, output.file());
            let lost = lost.map_err(|e| unwritten(format, e))?;
            output.finish().map_err(|e| errors::output(&e))?;
            PyResult::Ok(lost)
        })??;
        Ok(lost.iter().map(ToString::to_string).collect())
    }

    /// The bytes of a file.
    fn to_bytes<'py>(&self, py: Python<'py>, format: &str) -> PyResult<Bound<'py, PyBytes>> {
        let format = format_named(format)?;
        let bytes = detached(py, || {
            let mut file = Cursor::new(Vec::new());
            let written = formats::write(&self.morphology, format, &mut file);
            written
                .map(|_lost| file.into_inner())
                .map_err(|e| unwritten(format, e))
        })??;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.morphology == other.morphology
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let py = slf.py();
        let cell = slf.get();
        let state = detached(py, || {
            state::to_bytes(&cell.morphology, &cell.format, &cell.warnings)
        })?;
        let restore = py.get_type::<Self>().getattr("restore")?;
        Ok((restore, (PyBytes::new(py, &state),)))
    }

    #[staticmethod]
    fn restore(state: &[u8]) -> PyResult<Self> {
        let (morphology, format, warnings) = state::from_bytes(state)
            .ok_or_else(|| PyValueError::new_err("these bytes are no cell of this version"))?;
        Ok(Self::new(Arc::new(morphology), &format, warnings))
    }
}

/// From now on files may become as large as what they hold.
#[pyfunction]
pub(crate) fn allow_large() {
    formats::budget::allow_large();
}

/// What becomes of a file that is there.
pub(crate) fn existing(overwrite: bool) -> Existing {
    match overwrite {
        true => Existing::Replace,
        false => Existing::Refuse("use overwrite=True, or another name"),
    }
}

fn unwritten(format: Format, error: std::io::Error) -> PyErr {
    match error.kind() {
        std::io::ErrorKind::Unsupported => PyValueError::new_err(format!(
            "{} is read, not written: use swc, asc, h5 or nml",
            format.name()
        )),
        _ => error.into(),
    }
}

/// How files are read.
fn reading(strict: bool) -> ReadOptions {
    ReadOptions {
        strict,
        ..ReadOptions::default()
    }
}

/// A format by its name or an extension.
fn format_named(name: &str) -> PyResult<Format> {
    let plain = name.trim_start_matches('.');
    let named = Format::ALL.into_iter().find(|f| f.name() == plain);
    let found = named.or_else(|| Format::of_extension(plain));
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "'{name}' is no format of morphologies: use 'swc', 'asc', 'h5', 'nml', 'traces', 'xml' or 'json'"
        ))
    })
}
