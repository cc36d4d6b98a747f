//! Mended and compared tracings.

use std::sync::Arc;

use glam::DVec3;
use neurotess::morphology::Difference;
use neurotess::options::EditRecipe;
use neurotess::options::groups::EditOptions;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{Cell, Told};
use crate::options::set_all;
use crate::work::released;
use crate::{errors, json};

/// How tracings are mended: options, checked.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Edits(EditRecipe);

#[pymethods]
impl Edits {
    #[new]
    fn new(py: Python<'_>, keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut edits = EditOptions::default();
        set_all(&mut edits, keywords)?;
        let recipe = EditRecipe::of(&edits);
        recipe.map(Self).map_err(|e| errors::option(py, &e))
    }

    /// Whether radii that are no numbers may be read, since they are mended.
    #[getter]
    fn mends_radii(&self) -> bool {
        self.0.mends_radii()
    }

    /// The mended cell, and a dictionary of what each edit changed. `synapses`: places (µm) of spines.
    fn apply<'py>(
        &self,
        py: Python<'py>,
        cell: &Cell,
        synapses: Option<Vec<[f64; 3]>>,
    ) -> PyResult<(Cell, Vec<Bound<'py, PyAny>>)> {
        let (recipe, morphology) = (self.0.clone(), Arc::clone(&cell.morphology));
        let synapses: Option<Vec<DVec3>> =
            synapses.map(|places| places.into_iter().map(DVec3::from).collect());
        let edited = released(py, None, move || {
            recipe.apply_to(&morphology, synapses.as_deref())
        })?;
        let edited = edited.map_err(PyValueError::new_err)?;
        let reports = edited.reports.iter();
        let reports: PyResult<_> = reports.map(|r| json::serialized(py, r)).collect();
        let stays = |told: &&Told| !self.0.settles(&told.code);
        let warnings = cell.warnings.iter().filter(stays).cloned().collect();
        let cell = Cell::new(Arc::new(edited.morphology), &cell.format, warnings);
        Ok((cell, reports?))
    }
}

/// What differs between two cells. `tolerance`: distances and differences of radii up to this one (µm) are none;
/// `samples`: how many are named of each kind of difference, all if it is none.
#[pyfunction]
pub(crate) fn diff<'py>(
    py: Python<'py>,
    first: &Cell,
    second: &Cell,
    tolerance: f64,
    samples: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    if !(tolerance >= 0.0 && tolerance.is_finite()) {
        let message = format!("tolerance={tolerance} is not a number from 0 on");
        return Err(PyValueError::new_err(message));
    }
    let cells = [&first.morphology, &second.morphology].map(Arc::clone);
    let difference = released(py, None, move || {
        let [first, second] = cells;
        Difference::naming(&first, &second, tolerance, samples.unwrap_or(usize::MAX))
    })?;
    json::serialized(py, &difference)
}
