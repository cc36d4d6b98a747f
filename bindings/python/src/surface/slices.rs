//! The arrays of a mesh as a surface again, without copying them.

use glam::{DVec3, Vec3};
use neurotess::mesh::{Faces, Surface, SurfaceVertex, VertexAttribute};

use super::columns::Columns;

/// Vertices or faces in a block.
const BLOCK: usize = 1 << 14;

/// What arrays show, in the coordinates of the tracing.
pub(super) struct Slices<'a> {
    pub(super) origin: DVec3,
    pub(super) vertices: &'a [[f64; 3]],
    pub(super) normals: &'a [[f32; 3]],
    pub(super) types: &'a [i32],
    pub(super) points: &'a [i32],
    pub(super) sections: &'a [i32],
    pub(super) radii: &'a [f32],
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) quads: &'a [[u32; 4]],
    /// Numbers of one's own.
    pub(super) own: Vec<VertexAttribute<'a>>,
}

impl Slices<'_> {
    /// Whether all attributes have a value for each vertex, and faces have no others.
    pub(super) fn agree(&self) -> bool {
        let count = self.vertices.len();
        let lengths = [
            self.normals.len(),
            self.types.len(),
            self.points.len(),
            self.sections.len(),
            self.radii.len(),
        ];
        let corners = self.triangles.as_flattened().iter();
        let mut corners = corners.chain(self.quads.as_flattened());
        lengths.iter().all(|&length| length == count)
            && corners.all(|&corner| (corner as usize) < count)
    }

    /// Copies all of them.
    pub(super) fn to_columns(&self) -> Columns {
        Columns {
            origin: self.origin,
            vertices: self.vertices.to_vec(),
            normals: self.normals.to_vec(),
            types: self.types.to_vec(),
            points: self.points.to_vec(),
            sections: self.sections.to_vec(),
            radii: self.radii.to_vec(),
            faces: Faces {
                triangles: self.triangles.to_vec(),
                quads: self.quads.to_vec(),
            },
        }
    }

    fn vertex(&self, index: usize) -> SurfaceVertex {
        SurfaceVertex {
            position: (DVec3::from(self.vertices[index]) - self.origin).as_vec3(),
            normal: Vec3::from(self.normals[index]),
            kind: self.types[index],
            point: self.points[index],
            section: self.sections[index],
            radius: self.radii[index],
        }
    }
}

impl Surface for Slices<'_> {
    fn origin(&self) -> DVec3 {
        self.origin
    }

    fn attributes(&self) -> &[VertexAttribute<'_>] {
        &self.own
    }

    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    fn quad_count(&self) -> usize {
        self.quads.len()
    }

    fn vertex_blocks(&self) -> usize {
        self.vertices.len().div_ceil(BLOCK)
    }

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        let first = block * BLOCK;
        let end = self.vertices.len().min(first + BLOCK);
        out.extend((first..end).map(|index| self.vertex(index)));
    }

    fn face_blocks(&self) -> usize {
        self.triangles.len().max(self.quads.len()).div_ceil(BLOCK)
    }

    fn faces(&self, block: usize, out: &mut Faces) {
        let of = |length: usize| length.min(block * BLOCK)..length.min((block + 1) * BLOCK);
        let triangles = &self.triangles[of(self.triangles.len())];
        out.triangles.extend_from_slice(triangles);
        out.quads
            .extend_from_slice(&self.quads[of(self.quads.len())]);
    }
}
