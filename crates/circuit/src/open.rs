//! Which kind of circuit a file or a folder is.

use std::path::Path;

use crate::{Circuit, CircuitError, sonata};

impl Circuit {
    /// Opens a circuit by a configuration (SONATA: the circuit's or the simulation's) or by the folder
    /// that has one. Morphologies are not read yet.
    ///
    /// # Errors
    /// What is wrong with the configuration, or with all populations. What is wrong with one of
    /// several is in [`Circuit::failures`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, CircuitError> {
        let path = path.as_ref();
        if path.is_dir() {
            return sonata::open(&sonata::find(path)?);
        }
        sonata::open(path)
    }
}

/// Whether a file, or a folder, is a circuit: a folder is one if it has the configuration of one.
pub fn is_circuit(path: &Path) -> bool {
    if path.is_dir() {
        return sonata::find(path).is_ok();
    }
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    extension.eq_ignore_ascii_case("json") && sonata::names_circuit(path)
}
