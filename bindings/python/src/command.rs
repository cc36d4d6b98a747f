//! The command `neurotess`, which comes with the package.

use std::ffi::OsString;

use pyo3::prelude::*;

use crate::work::detached;

/// Runs the command with these arguments, of which the first is its name; returns its exit code.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    detached(py, || neurotess_cli::main(arguments))
}
