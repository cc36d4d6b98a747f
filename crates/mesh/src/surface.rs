//! Surfaces of triangles and quads, whole in memory or made block by block.

use glam::{DVec3, Vec3};

use crate::{Soundness, Stopped, Unit, Watch};

/// A vertex of a surface with the attributes that are exported.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceVertex {
    /// Position (µm, relative to the surface's origin).
    pub position: Vec3,
    /// Unit normal, outwards.
    pub normal: Vec3,
    /// SWC type.
    pub kind: i32,
    /// The file's own number of the tracing point.
    pub point: i32,
    /// Section: that of the morphology plus one; 0 for the soma.
    pub section: i32,
    /// Radius (µm) of the tracing there.
    pub radius: f32,
}

/// Faces, counter-clockwise seen from outside; indices count from the surface's first vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faces {
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Quads.
    pub quads: Vec<[u32; 4]>,
}

/// Numbers of one's own, for each vertex of a surface. PLY, VTU and GLB hold them, as 32-bit floating-point numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexAttribute<'a> {
    /// Its name: letters, digits and `_`. A GLB has it with `_` before, but for `COLOR_0`.
    pub name: &'a str,
    /// Numbers of a vertex: 1 to 4.
    pub components: usize,
    /// Those of all vertices, in their order.
    pub values: &'a [f32],
}

/// A part of the inside of a surface with walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// A point within it, in the coordinates of the tracing.
    pub seed: DVec3,
    /// SWC type of its membrane at the wall.
    pub kind: i32,
    /// Section of its membrane at the wall; 0 for a soma.
    pub section: i32,
}

/// A surface that is made block by block, so that a writer needs memory for one block and not for
/// all. Equal calls give equal blocks; blocks may be asked for in any order, from any thread.
pub trait Surface: Sync {
    /// What to add to every position to get the tracing's own coordinates (µm).
    fn origin(&self) -> DVec3;
    /// The unit of positions and radii, which files name where they can.
    fn unit(&self) -> Unit {
        Unit::Micrometer
    }
    /// Parts of the inside that walls keep apart ([`with_walls`](crate::with_walls)); formats that name them do.
    fn regions(&self) -> Vec<Region> {
        Vec::new()
    }
    /// What its vertices are checked against, for surfaces that know their tracing: what is unsound is not written.
    fn soundness(&self) -> Option<Soundness> {
        None
    }
    /// Numbers of one's own for its vertices.
    fn attributes(&self) -> &[VertexAttribute<'_>] {
        &[]
    }
    /// Number of vertices of all blocks.
    fn vertex_count(&self) -> usize;
    /// Number of triangles of all blocks.
    fn triangle_count(&self) -> usize;
    /// Number of quads of all blocks.
    fn quad_count(&self) -> usize;
    /// Number of blocks of vertices.
    fn vertex_blocks(&self) -> usize;
    /// Appends the vertices of one block to `out`.
    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>);
    /// Number of blocks of faces.
    fn face_blocks(&self) -> usize;
    /// Appends the faces of one block to `out`.
    fn faces(&self, block: usize, out: &mut Faces);
}

/// A surface whole in memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMesh {
    /// What to add to every position to get the tracing's own coordinates (µm).
    pub origin: DVec3,
    /// Vertices.
    pub vertices: Vec<SurfaceVertex>,
    /// Faces.
    pub faces: Faces,
}

/// Vertices or faces in one block of a [`SurfaceMesh`].
const BLOCK: usize = 1 << 16;

impl SurfaceMesh {
    /// Collects all blocks of a surface.
    pub fn collect(surface: &(impl Surface + ?Sized)) -> Self {
        Self::collect_watched(surface, &Watch::default()).unwrap_or_default()
    }

    /// [`collect`](Self::collect), which ends between two blocks, with nothing, once it is stopped.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn collect_watched(
        surface: &(impl Surface + ?Sized),
        watch: &Watch<'_>,
    ) -> Result<Self, Stopped> {
        let mut mesh = Self {
            origin: surface.origin(),
            ..Self::default()
        };
        mesh.vertices.reserve(surface.vertex_count());
        mesh.faces.triangles.reserve(surface.triangle_count());
        mesh.faces.quads.reserve(surface.quad_count());
        for block in 0..surface.vertex_blocks() {
            watch.check()?;
            surface.vertices(block, &mut mesh.vertices);
        }
        for block in 0..surface.face_blocks() {
            watch.check()?;
            surface.faces(block, &mut mesh.faces);
        }
        Ok(mesh)
    }
}

impl Surface for SurfaceMesh {
    fn origin(&self) -> DVec3 {
        self.origin
    }

    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn triangle_count(&self) -> usize {
        self.faces.triangles.len()
    }

    fn quad_count(&self) -> usize {
        self.faces.quads.len()
    }

    fn vertex_blocks(&self) -> usize {
        self.vertices.len().div_ceil(BLOCK)
    }

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        out.extend_from_slice(self.vertices.chunks(BLOCK).nth(block).unwrap_or_default());
    }

    fn face_blocks(&self) -> usize {
        self.faces
            .triangles
            .len()
            .max(self.faces.quads.len())
            .div_ceil(BLOCK)
    }

    fn faces(&self, block: usize, out: &mut Faces) {
        let Faces { triangles, quads } = &self.faces;
        out.triangles
            .extend_from_slice(triangles.chunks(BLOCK).nth(block).unwrap_or_default());
        out.quads
            .extend_from_slice(quads.chunks(BLOCK).nth(block).unwrap_or_default());
    }
}
