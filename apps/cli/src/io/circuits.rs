//! Inputs that are circuits.

use std::path::{Path, PathBuf};

use neurotess::circuit::{Circuit, Instance, NodeRef, is_circuit};

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

/// Instances of chosen nodes; warns of those that have no morphology or place.
pub(crate) fn instances(
    circuit: &Circuit,
    nodes: &[NodeRef],
    reporter: &Reporter,
) -> Vec<Instance> {
    let instances = circuit.instances(nodes, None);
    if instances.len() < nodes.len() {
        let without = nodes.len() - instances.len();
        let total = nodes.len();
        reporter.warning(&format!(
            "{}: {without} of {total} chosen cells have no morphology or place: left out",
            circuit.file
        ));
    }
    instances
}
