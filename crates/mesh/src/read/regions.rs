//! Types and sections of vertices, from those of the faces around them.
//!
//! A face takes them from a corner on the soma, or else from that of the highest section ([`FaceLabel`]). So a vertex
//! has those of the lowest section among its faces that is not the soma's; where sections are unknown, of the highest
//! type.

use std::cmp::Reverse;

#[cfg(doc)]
use crate::FaceLabel;
use crate::SurfaceVertex;

/// What a file says of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Region {
    pub(super) section: Option<i32>,
    pub(super) kind: i32,
}

impl Region {
    /// A vertex has the region of the highest rank.
    fn rank(&self) -> (bool, Reverse<i32>, i32) {
        let section = self.section.unwrap_or(0);
        (section > 0, Reverse(section.max(0)), self.kind)
    }
}

/// What is known of each vertex so far.
pub(super) struct Regions(Vec<Option<Region>>);

impl Regions {
    pub(super) fn of(vertices: usize) -> Self {
        Self(vec![None; vertices])
    }

    /// Takes note of a face at a vertex; one of no region says nothing.
    pub(super) fn add(&mut self, vertex: u32, region: Option<Region>) {
        if let Some(known) = self.0.get_mut(vertex as usize) {
            *known = [*known, region]
                .into_iter()
                .flatten()
                .max_by_key(Region::rank);
        }
    }

    /// The attributes of a vertex.
    pub(super) fn vertex(&self, index: usize) -> SurfaceVertex {
        let region = self.0.get(index).copied().flatten();
        SurfaceVertex {
            kind: region.map_or(0, |region| region.kind),
            section: region.and_then(|region| region.section).unwrap_or(0),
            ..SurfaceVertex::default()
        }
    }
}
