//! What is said of inputs.

use neurotess::batch::{InputError, Inputs};

use crate::report::{Failure, Reporter, count};

/// Reports what was not found, and what was left out.
pub(crate) fn tell(inputs: &Inputs, reporter: &Reporter) {
    for not_found in &inputs.not_found {
        reporter.error(&not_found.to_string());
    }
    if inputs.others > 0 {
        reporter.note(&format!(
            "{} without a morphology (reports, nodes, …): skipped",
            count(inputs.others, "HDF5 file")
        ));
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self(error.to_string())
    }
}
