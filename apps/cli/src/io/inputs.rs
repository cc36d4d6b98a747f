//! What is said of inputs.

use std::collections::BTreeMap;

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

/// Sums warnings up: how many cells have one of each code.
pub(crate) fn tell_warnings(counts: &BTreeMap<&'static str, usize>, reporter: &Reporter) {
    if counts.is_empty() {
        return;
    }
    let causes: Vec<String> = counts
        .iter()
        .map(|(code, n)| format!("{code} {n}"))
        .collect();
    let hint = if reporter.verbose() {
        ""
    } else {
        " (-v tells all)"
    };
    reporter.warning(&format!("cells concerned: {}{hint}", causes.join(", ")));
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self(error.to_string())
    }
}
