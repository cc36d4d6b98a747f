//! Tracings as inputs: which files of a folder they are, and what they hold.

use std::io;
use std::path::{Path, PathBuf};

use neurotess_formats::{self as formats, Format, ReadError, ReadOptions};

use crate::standard::{StandardInputError, is_standard, standard_input};

/// Extensions of morphologies that are looked for in folders.
pub const MORPHOLOGIES: [&str; 16] = [
    "swc",
    "eswc",
    "asc",
    "h5",
    "hdf5",
    "nml",
    "neuroml",
    "traces",
    "swc.gz",
    "eswc.gz",
    "asc.gz",
    "h5.gz",
    "hdf5.gz",
    "nml.gz",
    "neuroml.gz",
    "traces.gz",
];

/// Why an input was not read: `FILE:LINE: what: what to do`.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// What the reader says.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Standard input.
    #[error(transparent)]
    Standard(#[from] StandardInputError),
    /// It is no file that can be read.
    #[error("{}: cannot be read ({source}): check the path and its permissions", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// Reads the morphology of an input: of a file, or `-` for standard input, whose format the content tells unless `format`
/// is given.
///
/// # Errors
/// With file, line, what is wrong and what to do.
pub fn read(
    path: &Path,
    format: Option<Format>,
    options: &ReadOptions,
) -> Result<formats::Read, InputError> {
    if !is_standard(path) {
        return Ok(formats::read(path, options)?);
    }
    let no_text = |head: &[u8]| head.contains(&0) && !head.starts_with(b"\x89HDF");
    let bytes = standard_input(no_text)?;
    Ok(formats::read_bytes(bytes, "-", format, options)?)
}

/// An error if an input cannot be read at all, before anything is said of its output.
///
/// # Errors
/// There is no such file, or it must not be read.
pub fn readable(path: &Path) -> Result<(), InputError> {
    if is_standard(path) {
        return Ok(());
    }
    let read = formats::regular(&formats::file_of(path));
    read.map_err(|source| InputError::Unreadable {
        file: path.to_path_buf(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_is_looked_for_packed_or_not() {
        let packed = formats::EXTENSIONS.map(|extension| format!("{extension}.gz"));
        let all: Vec<&str> = formats::EXTENSIONS
            .into_iter()
            .chain(packed.iter().map(String::as_str))
            .collect();
        assert_eq!(all, MORPHOLOGIES);
    }
}
