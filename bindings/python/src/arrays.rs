//! Arrays of NumPy that own what was made in Rust: memory is moved into them, not copied.

use numpy::ndarray::Array2;
use numpy::{Element, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::bug;

/// Two arrays with a value each for the same things.
pub(crate) type Pair<A, B> = (Py<PyArray1<A>>, Py<PyArray1<B>>);

/// A read-only array of one dimension.
pub(crate) fn column<T: Element>(py: Python<'_>, values: Vec<T>) -> PyResult<Py<PyArray1<T>>> {
    let array = PyArray1::from_vec(py, values);
    lock(array.as_any())?;
    Ok(array.unbind())
}

/// A read-only array of rows.
pub(crate) fn rows<T: Element, const N: usize>(
    py: Python<'_>,
    values: Vec<[T; N]>,
) -> PyResult<Py<PyArray2<T>>> {
    let shape = (values.len(), N);
    let values = Array2::from_shape_vec(shape, values.into_flattened()).map_err(bug)?;
    let array = PyArray2::from_owned_array(py, values);
    lock(array.as_any())?;
    Ok(array.unbind())
}

/// Makes an array read-only: others may look at the same memory, and what is known of it stays true.
fn lock(array: &Bound<'_, PyAny>) -> PyResult<()> {
    let arguments = PyDict::new(array.py());
    arguments.set_item("write", false)?;
    array.call_method("setflags", (), Some(&arguments))?;
    Ok(())
}
