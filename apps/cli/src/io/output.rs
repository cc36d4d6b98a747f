//! Outputs: files, which are replaced only with --force, and standard output.

use std::path::Path;

use crate::report::Reporter;
use neurotess::batch::standard;
pub(crate) use neurotess::batch::standard::is_standard;
pub(crate) use neurotess::output::{Existing, Output, OutputError};

/// Whether existing files may be replaced.
pub(crate) fn existing(force: bool) -> Existing {
    match force {
        true => Existing::Replace,
        false => Existing::Refuse("use --force to replace it"),
    }
}

/// Reserves standard output for OUT, if OUT is `-`.
///
/// # Errors
/// Wrong usage: JSON is to be printed there too.
pub(crate) fn reserve_standard(out: &Path, reporter: &Reporter) -> anyhow::Result<()> {
    match is_standard(out) {
        true => reporter.leave_output(),
        false => Ok(()),
    }
}

/// An error if the file exists and must not be replaced.
pub(crate) fn check(out: &Path, force: bool) -> Result<(), OutputError> {
    match is_standard(out) {
        true => Ok(()),
        false => existing(force).check(out),
    }
}

/// Begins an output: a file, or standard output.
pub(crate) fn begin(out: &Path, force: bool) -> Result<Output, OutputError> {
    standard::begin(out, existing(force))
}
