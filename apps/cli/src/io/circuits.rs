//! Inputs that are circuits.

use std::path::{Path, PathBuf};

use neurotess::circuit::{Circuit, is_circuit};

use crate::report::{Failure, Reporter};

/// Inputs that are circuits, and the others.
pub(crate) fn partition(inputs: &[PathBuf]) -> (Vec<PathBuf>, Vec<PathBuf>) {
    inputs.iter().cloned().partition(|path| is_circuit(path))
}

/// Opens a circuit; reports parts that could not be opened, and warnings.
pub(crate) fn open(path: &Path, reporter: &Reporter) -> Result<Circuit, Failure> {
    let circuit = Circuit::open(path).map_err(|e| Failure(e.to_string()))?;
    for failure in &circuit.failures {
        reporter.failure(&Failure(failure.to_string()));
    }
    for warning in &circuit.warnings {
        reporter.warning(&warning.to_string());
    }
    Ok(circuit)
}
