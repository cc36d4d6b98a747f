//! What a reader of populations notes beside them: warnings, failures, templates, and nodes that make no sense.

use std::path::PathBuf;

use crate::template::TemplateId;
use crate::{CircuitError, Fault, Warning};

/// What else than the population a reader makes.
pub(crate) struct Notes<'a> {
    pub(crate) warnings: &'a mut Vec<Warning>,
    pub(crate) failures: &'a mut Vec<CircuitError>,
    /// Gives a morphology file its template.
    pub(crate) template: &'a mut dyn FnMut(PathBuf) -> TemplateId,
}

/// Nodes whose place or rotation makes no sense.
pub(crate) struct Broken<'a> {
    pub(crate) file: &'a str,
    pub(crate) rows: Vec<bool>,
}

impl Broken<'_> {
    /// Marks nodes, and tells of them as one failure.
    pub(crate) fn mark(
        &mut self,
        key: String,
        faulty: &[(usize, f64)],
        zero: bool,
        notes: &mut Notes,
    ) {
        for &(row, _) in faulty {
            self.rows[row] = true;
        }
        if let Some(&(row, value)) = faulty.first() {
            let (row, count) = (row as u64, faulty.len() as u64);
            let fault = if zero {
                Fault::ZeroQuaternion { row, count }
            } else {
                Fault::NotFinite { row, value, count }
            };
            notes
                .failures
                .push(CircuitError::new(self.file, key, fault));
        }
    }
}
