//! `-` as a file: standard input, and standard output.

use std::io::{self, Read};
use std::path::Path;

use neurotess_output::{Existing, Output, OutputError};

/// Number of bytes that decide whether the rest is worth reading.
const HEAD: u64 = 1 << 16;

/// Most bytes of standard input.
const MOST: u64 = 1 << 32;

/// Why standard input was not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StandardInputError {
    /// It goes on and on.
    #[error("-: standard input has no end, or more than 4 GB: give a file")]
    Endless,
    /// The system would not read it.
    #[error("-: standard input cannot be read ({0}): check where it comes from")]
    Io(io::Error),
}

/// Whether a path is `-`.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// All of standard input; or only its beginning, if `useless` returns true for that.
///
/// # Errors
/// It cannot be read, or holds more than 4 GB.
pub fn standard_input(useless: impl Fn(&[u8]) -> bool) -> Result<Vec<u8>, StandardInputError> {
    let mut bytes = Vec::new();
    let mut input = io::stdin().lock();
    let mut read = input.by_ref().take(HEAD).read_to_end(&mut bytes);
    if read.is_ok() && !useless(&bytes) {
        read = input.take(MOST).read_to_end(&mut bytes);
    }
    match read {
        Ok(_) if (bytes.len() as u64) < MOST => Ok(bytes),
        Ok(_) => Err(StandardInputError::Endless),
        Err(e) => Err(StandardInputError::Io(e)),
    }
}

/// Begins an output: a file, or standard output.
///
/// # Errors
/// A file is in the way, or there is no place for it.
pub fn begin(out: &Path, existing: Existing) -> Result<Output, OutputError> {
    match is_standard(out) {
        true => Output::standard(),
        false => Output::create(out, existing),
    }
}
