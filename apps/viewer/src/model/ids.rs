//! Ids of open tracings and circuits.

use neurotess::circuit::NodeRef;
use serde::{Deserialize, Serialize};

/// Index of a tracing in [`Sources`](crate::model::sources::Sources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SourceId(pub u32);

/// Index of a circuit in [`Circuits`](crate::model::circuits::Circuits).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CircuitId(pub u32);

/// A node of an open circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CircuitNode {
    /// The circuit.
    pub circuit: CircuitId,
    /// The node in it.
    pub node: NodeRef,
}
