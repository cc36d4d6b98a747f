//! The types of faces, while a surface is made block by block.
//!
//! A face has its type from its corners ([`FaceLabel`](crate::FaceLabel)), which a block of faces only numbers. What
//! is kept of all vertices are runs with the same section and type: refined vertices follow the tracing, so runs are few:
//! in the sample cells at level 4 one for 33 to 134 vertices, which is 0.1 to 0.4 bytes a vertex instead of 40, and
//! at level 16 not many more runs.
//! **Why not** make the blocks of vertices again, as `write/corners.rs` does for labels with tracing points: making
//! them is the most of what writing costs.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use crate::SurfaceVertex;
use crate::label::section_of;

/// A section and a type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SectionType {
    pub(crate) section: i32,
    pub(crate) kind: i32,
}

/// A run within a group of vertices: its first vertex, and what all of it have.
type Run = (u32, SectionType);

/// Collects the types of vertices, group by group, on any thread.
#[derive(Default)]
pub(crate) struct TypesOfGroups(Mutex<BTreeMap<usize, (usize, Vec<Run>)>>);

impl TypesOfGroups {
    /// Adds the vertices of some blocks.
    pub(crate) fn add(&self, blocks: &Range<usize>, vertices: &[SurfaceVertex]) {
        let mut runs: Vec<Run> = Vec::new();
        for (n, vertex) in vertices.iter().enumerate() {
            let here = SectionType {
                section: vertex.section,
                kind: vertex.kind,
            };
            if runs.last().is_none_or(|&(_, last)| last != here) {
                runs.push((n as u32, here));
            }
        }
        let mut groups = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        groups.insert(blocks.start, (vertices.len(), runs));
    }

    /// The types of all vertices, once all blocks were added.
    pub(crate) fn finish(self) -> VertexTypes {
        let groups = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut types = VertexTypes::default();
        let mut first = 0;
        for (count, runs) in groups.into_values() {
            for (start, here) in runs {
                if types.types.last() != Some(&here) {
                    types.starts.push(first + start);
                    types.types.push(here);
                }
            }
            first += count as u32;
        }
        types
    }
}

/// Sections and types of all vertices of a surface.
#[derive(Default)]
pub(crate) struct VertexTypes {
    /// The first vertex of each run.
    starts: Vec<u32>,
    types: Vec<SectionType>,
}

impl VertexTypes {
    /// The types that vertices have.
    pub(crate) fn kinds(&self) -> BTreeSet<i32> {
        self.types.iter().map(|here| here.kind).collect()
    }

    /// For asking after many faces that lie together.
    pub(crate) fn ask(&self) -> FaceTypes<'_> {
        FaceTypes {
            all: self,
            recent: [const {
                (
                    0..0,
                    SectionType {
                        section: 0,
                        kind: 0,
                    },
                )
            }; RECENT],
            oldest: 0,
        }
    }
}

/// Runs that are looked into first: a patch and its sides are five.
const RECENT: usize = 5;

/// Tells the types of faces one after another.
pub(crate) struct FaceTypes<'t> {
    all: &'t VertexTypes,
    /// Runs that were found last.
    recent: [(Range<u32>, SectionType); RECENT],
    oldest: usize,
}

impl FaceTypes<'_> {
    /// The section and type of a triangle: those of its [`FaceLabel`](crate::FaceLabel), if sections have one type each,
    /// as all of ours do.
    pub(crate) fn triangle(&mut self, corners: [u32; 3]) -> SectionType {
        let [a, b, c] = corners.map(|corner| self.vertex(corner));
        if a.section == b.section && b == c {
            return b;
        }
        let shown = section_of([a, b, c].map(|corner| corner.section));
        let first = [a, b, c].into_iter().find(|at| at.section == shown);
        first.unwrap_or(a)
    }

    /// The section and type of a quad: of its two halves as of the corners of a triangle.
    pub(crate) fn quad(&mut self, [a, b, c, d]: [u32; 4]) -> SectionType {
        let [first, second] = [[a, b, c], [a, c, d]].map(|half| self.triangle(half));
        match section_of([first.section, second.section]) == first.section {
            true => first,
            false => second,
        }
    }

    fn vertex(&mut self, vertex: u32) -> SectionType {
        let mut recent = self.recent.iter();
        if let Some((_, here)) = recent.find(|(run, _)| run.contains(&vertex)) {
            return *here;
        }
        let VertexTypes { starts, types } = self.all;
        let next = starts.partition_point(|&start| start <= vertex);
        // Faces that name no vertex are found when they are read; here they have some type.
        let at = next.saturating_sub(1);
        let here = types.get(at).copied().unwrap_or_default();
        let start = starts.get(at).copied().unwrap_or_default();
        let end = starts.get(next).copied().unwrap_or(u32::MAX);
        self.recent[self.oldest] = (start..end, here);
        self.oldest = (self.oldest + 1) % RECENT;
        here
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FaceLabel;

    fn vertex(section: i32) -> SurfaceVertex {
        SurfaceVertex {
            section,
            kind: [1, 3, 2][section as usize % 3],
            point: section,
            ..SurfaceVertex::default()
        }
    }

    #[test]
    fn faces_have_the_types_of_their_labels() {
        let sections = [0, 0, 0, 1, 1, 2, 2, 2, 5, 5, 0, 1];
        let vertices = sections.map(vertex);
        let types = TypesOfGroups::default();
        // Groups come in any order.
        types.add(&(4..9), &vertices[7..]);
        types.add(&(0..4), &vertices[..7]);
        let types = types.finish();
        assert_eq!(types.starts, [0, 3, 5, 8, 10, 11]);
        let mut ask = types.ask();
        let count = vertices.len() as u32;
        for a in 0..count {
            for b in 0..count {
                for c in 0..count {
                    let label = FaceLabel::of([a, b, c].map(|n| &vertices[n as usize]));
                    let found = ask.triangle([a, b, c]);
                    assert_eq!((found.section, found.kind), (label.section, label.kind));
                }
            }
        }
        assert_eq!(ask.quad([8, 8, 9, 0]).kind, 1);
        assert_eq!(ask.quad([8, 0, 9, 8]).kind, 1);
        assert_eq!(ask.quad([8, 8, 9, 9]).kind, 2);
    }
}
