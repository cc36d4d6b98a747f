//! The extension module `neurotess._neurotess`: the library for Python, thin. What users see is in
//! `python/neurotess`, whose classes hold those of this module.
//!
//! ```text
//! python/neurotess: names, documentation, other packages ─▶ this: arrays, threads, errors ─▶ library
//! ```
//!
//! Heavy work runs without the interpreter's lock. Arrays own their memory, which was moved into them, and
//! are read-only: nothing that an array shows can end before it.
#![forbid(unsafe_code)]
#![expect(
    clippy::needless_pass_by_value,
    reason = "PyO3 hands over values of its own"
)]

mod arrays;
mod batch;
mod cell;
mod circuit;
mod command;
mod errors;
mod json;
mod neuroglancer;
mod options;
#[cfg(feature = "gpu")]
mod page;
#[cfg(feature = "render")]
mod picture;
mod surface;
mod work;

use pyo3::prelude::*;

/// What the package is made of.
#[pymodule]
#[pyo3(name = "_neurotess")]
fn neurotess_python(module: &Bound<'_, PyModule>) -> PyResult<()> {
    work::note_process();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("CAN_RENDER", cfg!(feature = "render"))?;
    module.add("CAN_PAGE", cfg!(feature = "gpu"))?;
    module.add_class::<cell::Cell>()?;
    module.add_class::<cell::Edits>()?;
    module.add_class::<surface::Recipe>()?;
    module.add_class::<work::Stop>()?;
    module.add_class::<surface::Surface>()?;
    module.add_class::<circuit::Circuit>()?;
    module.add_class::<circuit::Mesher>()?;
    module.add_class::<circuit::Report>()?;
    #[cfg(feature = "render")]
    picture::add_to(module)?;
    #[cfg(feature = "gpu")]
    page::add_to(module)?;
    module.add_function(wrap_pyfunction!(batch::mesh_all, module)?)?;
    module.add_function(wrap_pyfunction!(neuroglancer::neuroglancer, module)?)?;
    module.add_function(wrap_pyfunction!(cell::diff, module)?)?;
    module.add_function(wrap_pyfunction!(cell::allow_large, module)?)?;
    module.add_function(wrap_pyfunction!(command::main, module)?)
}
