//! A surface as one array for each attribute.

use glam::DVec3;
use neurotess::mesh::{Faces, Surface, SurfaceVertex};
use rayon::prelude::*;

/// Arrays of a surface. Positions are in the coordinates of the tracing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    pub(super) origin: DVec3,
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) types: Vec<i32>,
    pub(super) points: Vec<i32>,
    pub(super) sections: Vec<i32>,
    pub(super) radii: Vec<f32>,
    pub(super) faces: Faces,
}

impl Columns {
    /// Collects all blocks of a surface, of which as many are made at a time as there are threads.
    pub(crate) fn of(surface: &dyn Surface) -> Self {
        let count = surface.vertex_count();
        let mut columns = Self {
            origin: surface.origin(),
            vertices: Vec::with_capacity(count),
            normals: Vec::with_capacity(count),
            types: Vec::with_capacity(count),
            points: Vec::with_capacity(count),
            sections: Vec::with_capacity(count),
            radii: Vec::with_capacity(count),
            faces: Faces {
                triangles: Vec::with_capacity(surface.triangle_count()),
                quads: Vec::with_capacity(surface.quad_count()),
            },
        };
        let at_once = rayon::current_num_threads();
        let mut made: Vec<Vec<SurfaceVertex>> = vec![Vec::new(); at_once];
        in_groups(surface.vertex_blocks(), at_once, |blocks| {
            let blocks: Vec<usize> = blocks.collect();
            made.par_iter_mut().zip(&blocks).for_each(|(out, &block)| {
                out.clear();
                surface.vertices(block, out);
            });
            made.iter().take(blocks.len()).for_each(|v| columns.push(v));
        });
        let mut made = vec![Faces::default(); at_once];
        in_groups(surface.face_blocks(), at_once, |blocks| {
            let blocks: Vec<usize> = blocks.collect();
            made.par_iter_mut().zip(&blocks).for_each(|(out, &block)| {
                out.triangles.clear();
                out.quads.clear();
                surface.faces(block, out);
            });
            for Faces { triangles, quads } in made.iter().take(blocks.len()) {
                columns.faces.triangles.extend_from_slice(triangles);
                columns.faces.quads.extend_from_slice(quads);
            }
        });
        columns
    }

    /// Vertices and triangles that come from elsewhere: there are no attributes.
    pub(super) fn of_arrays(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        let count = vertices.len();
        Self {
            origin: DVec3::ZERO,
            vertices: vertices.to_vec(),
            normals: vec![[0.0; 3]; count],
            types: vec![0; count],
            points: vec![-1; count],
            sections: vec![-1; count],
            radii: vec![0.0; count],
            faces: Faces {
                triangles: triangles.to_vec(),
                quads: Vec::new(),
            },
        }
    }

    fn push(&mut self, vertices: &[SurfaceVertex]) {
        let origin = self.origin;
        let at = |v: &SurfaceVertex| (origin + v.position.as_dvec3()).to_array();
        self.vertices.extend(vertices.iter().map(at));
        let normals = vertices.iter().map(|v| v.normal.to_array());
        self.normals.extend(normals);
        self.types.extend(vertices.iter().map(|v| v.kind));
        self.points.extend(vertices.iter().map(|v| v.point));
        self.sections.extend(vertices.iter().map(|v| v.section));
        self.radii.extend(vertices.iter().map(|v| v.radius));
    }
}

/// Ranges of `size` numbers below `count`, the last one shorter.
fn in_groups(count: usize, size: usize, mut work: impl FnMut(std::ops::Range<usize>)) {
    for first in (0..count).step_by(size.max(1)) {
        work(first..count.min(first + size.max(1)));
    }
}
