//! Reports and spikes of simulations.

use std::path::PathBuf;
use std::sync::Arc;

use neurotess::circuit::{RecordingFile, ReportPopulation};
use numpy::PyArray2;
use numpy::ndarray::Array2;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::unreadable;
use crate::arrays::{self, Pair};
use crate::errors::bug;
use crate::work::{detached, released};

/// A file of values over time, or of spikes.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Report {
    file: Arc<RecordingFile>,
}

impl Report {
    pub(super) fn of(file: RecordingFile) -> Self {
        Self {
            file: Arc::new(file),
        }
    }
}

#[pymethods]
impl Report {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let opened = detached(py, || RecordingFile::open(path))?;
        opened.map(Self::of).map_err(|e| unreadable(py, &e))
    }

    #[getter]
    fn is_of_spikes(&self) -> bool {
        matches!(*self.file, RecordingFile::Spikes(_))
    }

    /// What is odd in it.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        let warnings = self.file.warnings().iter();
        warnings.map(ToString::to_string).collect()
    }

    /// Names of the populations.
    #[getter]
    fn populations(&self) -> Vec<String> {
        match &*self.file {
            RecordingFile::Report(report) => {
                report.populations.iter().map(|p| p.name.clone()).collect()
            }
            RecordingFile::Spikes(spikes) => {
                spikes.populations.iter().map(|p| p.name.clone()).collect()
            }
        }
    }

    /// Times (ms) and ids of the nodes that fire.
    fn spikes(&self, py: Python<'_>, population: usize) -> PyResult<Pair<f64, u64>> {
        let RecordingFile::Spikes(spikes) = &*self.file else {
            return Err(PyValueError::new_err("this is no file of spikes"));
        };
        let missing = || PyIndexError::new_err("no such population");
        let spikes = spikes.populations.get(population).ok_or_else(missing)?;
        Ok((
            arrays::column(py, spikes.times.clone())?,
            arrays::column(py, spikes.nodes.clone())?,
        ))
    }

    /// Times, units, nodes and the compartments of each.
    fn layout<'py>(&self, py: Python<'py>, population: usize) -> PyResult<Bound<'py, PyDict>> {
        let p = self.population(population)?;
        let layout = PyDict::new(py);
        layout.set_item("start", p.time.start)?;
        layout.set_item("step", p.time.step)?;
        layout.set_item("frames", p.time.frames)?;
        layout.set_item("units", &p.units)?;
        layout.set_item("node_ids", arrays::column(py, p.nodes.clone())?)?;
        let ends = (0..p.nodes.len()).map(|index| p.compartment_range(index).end);
        let offsets = std::iter::once(0).chain(ends).collect();
        layout.set_item("offsets", arrays::column::<u64>(py, offsets)?)?;
        Ok(layout)
    }

    /// The section (0: the soma) and the place along it of each compartment of a node.
    fn compartments(
        &self,
        py: Python<'_>,
        population: usize,
        index: usize,
    ) -> PyResult<Pair<u64, f32>> {
        let p = self.population(population)?;
        if index >= p.nodes.len() {
            return Err(PyIndexError::new_err("no such node"));
        }
        let found = detached(py, || p.compartments(index))?;
        let found = found.map_err(|e| unreadable(py, &e))?;
        let sections = found.iter().map(|c| c.section).collect();
        let along = found.iter().map(|c| c.along).collect();
        Ok((arrays::column(py, sections)?, arrays::column(py, along)?))
    }

    /// Values of some compartments, or of all, in frames that follow one another: a row for each frame.
    fn values(
        &self,
        py: Python<'_>,
        population: usize,
        frames: (u64, u64),
        compartments: Option<Vec<u64>>,
    ) -> PyResult<Py<PyArray2<f32>>> {
        let p = self.population(population)?;
        let (from, to) = frames;
        let outside = |&compartment: &u64| compartment >= p.compartment_count();
        if from > to || to > p.time.frames || compartments.iter().flatten().any(outside) {
            return Err(PyIndexError::new_err("no such frame or compartment"));
        }
        let wanted = compartments.unwrap_or_else(|| (0..p.compartment_count()).collect());
        let (file, columns) = (Arc::clone(&self.file), wanted.len());
        let read = released(py, None, move || {
            let RecordingFile::Report(report) = &*file else {
                return Ok(Vec::new());
            };
            let p = &report.populations[population];
            let mut values = Vec::with_capacity((to - from) as usize * wanted.len());
            for frame in from..to {
                values.extend(p.values(frame, &wanted)?);
            }
            Ok(values)
        })?;
        let values = read.map_err(|e| unreadable(py, &e))?;
        let rows = Array2::from_shape_vec(((to - from) as usize, columns), values);
        let rows = rows.map_err(bug)?;
        Ok(PyArray2::from_owned_array(py, rows).unbind())
    }
}

impl Report {
    fn population(&self, index: usize) -> PyResult<&ReportPopulation> {
        let RecordingFile::Report(report) = &*self.file else {
            return Err(PyValueError::new_err("this is a file of spikes"));
        };
        let missing = || PyIndexError::new_err("no such population");
        report.populations.get(index).ok_or_else(missing)
    }
}
