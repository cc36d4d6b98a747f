//! When a file is replaced.

pub(crate) use neurotess::output::{Existing, Output, OutputError};

/// Only where the user says so.
pub(crate) fn existing(force: bool) -> Existing {
    match force {
        true => Existing::Replace,
        false => Existing::Refuse("use --force to replace it"),
    }
}
