//! A tracing as it was read.

use std::path::{Path, PathBuf};

use neurotess_formats::{ReadError, ReadOptions};
use neurotess_morphology::Morphology;

/// A traced cell, what is to be said of its file, and where that is.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Tracing {
    /// The cell.
    pub morphology: Morphology,
    /// What was mended in the file, or is in doubt.
    pub warnings: Vec<neurotess_formats::Warning>,
    /// The file.
    pub file: PathBuf,
}

impl AsRef<Morphology> for Tracing {
    fn as_ref(&self) -> &Morphology {
        &self.morphology
    }
}

/// Reads a tracing, in any format that is built in.
///
/// # Errors
/// With file, line, what is wrong and what to do.
pub fn read(file: impl AsRef<Path>) -> Result<Tracing, ReadError> {
    read_with(file, &ReadOptions::default())
}

/// [`read`], which takes warnings as errors, mends radii, or leaves units alone, as options ask for it.
///
/// # Errors
/// As [`read`].
pub fn read_with(file: impl AsRef<Path>, options: &ReadOptions) -> Result<Tracing, ReadError> {
    let file = file.as_ref();
    let read = neurotess_formats::read(file, options)?;
    Ok(Tracing {
        morphology: read.morphology,
        warnings: read.warnings,
        file: file.to_owned(),
    })
}
