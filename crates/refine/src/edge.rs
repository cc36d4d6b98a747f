//! Edges of the coarse mesh.

use crate::evaluate::EdgeKind;

/// An edge of the coarse mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// The vertices where it starts and ends: along the path, or from the lower index to the
    /// higher.
    pub(crate) from: u32,
    pub(crate) to: u32,
    pub(crate) kind: EdgeKind,
    pub(crate) level: u16,
    /// Number of its first inner vertex, of which surfaces that have more than 32 bits of them keep the low ones: such
    /// can be counted only.
    pub(crate) first: u32,
}

impl Edge {
    pub(crate) fn ends(&self) -> [u32; 2] {
        [self.from, self.to]
    }
}
