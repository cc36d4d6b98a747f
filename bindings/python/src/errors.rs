//! Errors as Python's exceptions. The classes are those of `neurotess._errors`.

use std::fmt::Display;

use neurotess::formats::{Fault, ReadError};
use neurotess::output::OutputError;
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;

/// A file that cannot be read.
pub(crate) fn read(py: Python<'_>, error: &ReadError) -> PyErr {
    let number = match &error.fault {
        Fault::Io(e) => e.raw_os_error(),
        _ => None,
    };
    let message = error.fault.to_string();
    made(py, "read_error", (&error.file, error.line, message, number))
}

/// A file that the system does not give.
pub(crate) fn read_io(py: Python<'_>, file: &str, error: &std::io::Error) -> PyErr {
    let message = format!("cannot be read ({error}): check the path and its permissions");
    made(
        py,
        "read_error",
        (file, None::<u64>, message, error.raw_os_error()),
    )
}

/// A file of another kind that cannot be read; `place` is the file, perhaps with a line.
pub(crate) fn read_of(py: Python<'_>, file: &str, line: Option<u64>, message: &str) -> PyErr {
    made(py, "read_error", (file, line, message, None::<i32>))
}

/// A cell that cannot be meshed as the options ask.
pub(crate) fn mesh(py: Python<'_>, message: &str) -> PyErr {
    made(py, "MeshError", (message,))
}

/// Something that cannot be drawn.
#[cfg(feature = "render")]
pub(crate) fn render(py: Python<'_>, message: &str) -> PyErr {
    made(py, "RenderError", (message,))
}

/// Options that are wrong, in the words of the command line.
pub(crate) fn option(py: Python<'_>, message: &str) -> PyErr {
    made(py, "option_error", (message,))
}

/// An option of a picture or an edit that is wrong.
pub(crate) fn draw_option(py: Python<'_>, error: &neurotess::options::OptionError) -> PyErr {
    use neurotess::options::OptionError;
    match error {
        OptionError::Value {
            name,
            value,
            needed,
        } => made(py, "value_error", (name, value, needed)),
        other => option(py, &other.to_string()),
    }
}

/// A warning of ours.
///
/// # Errors
/// It is one that the user wants to be an error.
#[cfg(feature = "render")]
pub(crate) fn warn(py: Python<'_>, message: &str) -> PyResult<()> {
    let category = py
        .import("neurotess._errors")?
        .getattr("NeurotessWarning")?;
    let message = std::ffi::CString::new(message).map_err(bug)?;
    PyErr::warn(py, &category, &message, 2)
}

/// A file that cannot be written.
pub(crate) fn output(error: &OutputError) -> PyErr {
    match error {
        OutputError::Exists { path, .. } => {
            pyo3::exceptions::PyFileExistsError::new_err(format!("{} exists", path.display()))
        }
        other => PyOSError::new_err(other.to_string()),
    }
}

/// What should not happen.
pub(crate) fn bug(error: impl Display) -> PyErr {
    PyRuntimeError::new_err(format!(
        "a bug of neurotess ({error}): please report it with what you did"
    ))
}

/// Calls a class or function of `neurotess._errors` that gives an exception.
fn made<'py>(py: Python<'py>, name: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py
        .import("neurotess._errors")
        .and_then(|module| module.getattr(name)?.call1(arguments));
    made.map_or_else(|e| e, PyErr::from_value)
}
