//! The vertices that faces name.
//!
//! Blocks of faces hold indices only. What needs more of the corners (their type, their position) gets
//! the blocks of vertices that a group of faces names made again, so that memory does not grow with
//! the level. Patches are refined in the order of the tracing, so a group of faces names few blocks
//! beside its own. **Why not** keep the attributes of all vertices: at level 64 a cell of 20,000 points
//! has 300 million.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::{WriteError, agree, split};
use crate::{FaceLabel, Faces, Surface, SurfaceVertex};

/// Where the blocks of vertices of a surface begin.
pub(crate) struct VertexBlocks<'s> {
    surface: &'s dyn Surface,
    /// The first vertex of each block, then the number of all.
    starts: Vec<usize>,
}

/// The blocks of vertices that some faces name, in order, each with its first vertex.
pub(crate) struct Corners(Vec<(usize, Vec<SurfaceVertex>)>);

impl<'s> VertexBlocks<'s> {
    /// Counts the vertices of all blocks: one pass over the surface.
    ///
    /// # Errors
    /// A vertex is not finite; the blocks hold less or more than was announced.
    pub(crate) fn find(surface: &'s dyn Surface) -> Result<Self, WriteError> {
        let blocks: Vec<(usize, Option<usize>)> = (0..surface.vertex_blocks())
            .into_par_iter()
            .map(|block| {
                let mut vertices = Vec::new();
                surface.vertices(block, &mut vertices);
                let lost = vertices.iter().position(|v| !v.position.is_finite());
                (vertices.len(), lost)
            })
            .collect();
        let mut starts = vec![0];
        let mut next = 0;
        for (count, lost) in blocks {
            if let Some(lost) = lost {
                return Err(WriteError::NotFinite(next + lost));
            }
            next += count;
            starts.push(next);
        }
        agree("vertices", surface.vertex_count(), next)?;
        Ok(Self { surface, starts })
    }

    /// The first vertex of a block.
    pub(crate) fn start(&self, block: usize) -> usize {
        self.starts[block]
    }

    /// The vertices that faces name, with all others of their blocks.
    pub(crate) fn corners(&self, faces: &Faces) -> Corners {
        let mut blocks = BTreeSet::new();
        let mut last = 0..0;
        let triangles = faces.triangles.as_flattened();
        for &corner in triangles.iter().chain(faces.quads.as_flattened()) {
            let corner = corner as usize;
            if !last.contains(&corner) {
                let block = self.starts.partition_point(|&start| start <= corner) - 1;
                blocks.insert(block);
                last = self.starts[block]..self.starts[block + 1];
            }
        }
        let made = blocks.into_iter().map(|block| {
            let range = self.starts[block]..self.starts[block + 1];
            let mut vertices = Vec::with_capacity(range.len());
            self.surface.vertices(block, &mut vertices);
            (range.start, vertices)
        });
        Corners(made.collect())
    }
}

impl Corners {
    /// A vertex that one of the faces names.
    pub(crate) fn vertex(&self, index: u32) -> &SurfaceVertex {
        let index = index as usize;
        let block = self.0.partition_point(|&(start, _)| start <= index) - 1;
        let (start, vertices) = &self.0[block];
        &vertices[index - start]
    }

    /// The label of a triangle.
    pub(crate) fn label(&self, triangle: [u32; 3]) -> FaceLabel {
        FaceLabel::of(triangle.map(|corner| self.vertex(corner)))
    }
}

/// All triangles of some faces: first the triangles, then the halves of quads.
pub(crate) fn triangles(faces: &Faces) -> impl Iterator<Item = [u32; 3]> {
    let halves = faces.quads.iter().flat_map(split);
    faces.triangles.iter().copied().chain(halves)
}
