//! Paths along the tracing of a cell. Ends are indices of points; none is the soma.

use neurotess::morphology::Morphology;
use neurotess::morphology::paths::{self, Location, Path};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;

/// The location of an end.
fn location(cell: &Morphology, end: Option<u32>) -> PyResult<Location> {
    let location = end.map_or(Location::Soma(0), Location::of_point);
    match (location.is_on(cell), end) {
        (true, _) => Ok(location),
        (false, None) => Err(PyValueError::new_err("the cell has no soma: give a point")),
        (false, Some(point)) => Err(PyIndexError::new_err(format!(
            "there is no point {point}: the cell has {}",
            cell.points.len()
        ))),
    }
}

/// Length (µm) of the path between two ends; infinite if they are not connected.
pub(super) fn length(cell: &Morphology, [from, to]: [Option<u32>; 2]) -> PyResult<f64> {
    let path = Path::between(cell, location(cell, from)?, location(cell, to)?);
    Ok(path.map_or(f64::INFINITY, |path| path.length))
}

/// Length (µm) of the path from an end to each point; infinite where there is none.
pub(super) fn distances(cell: &Morphology, from: Option<u32>) -> PyResult<Vec<f64>> {
    let distances = paths::path_distances(cell, location(cell, from)?);
    let known = distances.into_iter().map(|d| d.unwrap_or(f64::INFINITY));
    Ok(known.collect())
}
