//! The surface as it is worked on.

use glam::{DVec3, Vec3};
use neurotess_mesh::{
    Faces, Forest, SurfaceMesh, SurfaceVertex, Topology, self_intersections_of, topology,
};

use crate::UnionError;

/// Triangles with what is known of where they come from. Vertices that no triangle names stay until
/// [`Work::finish`], so that numbers hold.
#[derive(Clone)]
pub(crate) struct Work {
    origin: DVec3,
    pub(crate) vertices: Vec<SurfaceVertex>,
    /// For each vertex, whether we made or moved it.
    pub(crate) fresh: Vec<bool>,
    /// For each vertex, whether a cut made it.
    pub(crate) seam: Vec<bool>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// For each triangle, the component of the input that it is of.
    pub(crate) parts: Vec<u32>,
    /// For each triangle, whether it is not one of the input; one with a vertex of ours is none either.
    pub(crate) changed: Vec<bool>,
}

impl Work {
    /// A copy of a mesh, its quads split along the diagonal from their first corner.
    pub(crate) fn new(mesh: &SurfaceMesh) -> Result<Self, UnionError> {
        let quads = mesh.faces.quads.iter();
        let halves = quads.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let triangles: Vec<[u32; 3]> = mesh.faces.triangles.iter().copied().chain(halves).collect();
        let count = mesh.vertices.len();
        if let Some(&vertex) = triangles.iter().flatten().find(|&&v| v as usize >= count) {
            return Err(UnionError::MissingVertex(vertex));
        }
        let finite = |vertex: &SurfaceVertex| vertex.position.is_finite();
        if let Some(vertex) = mesh.vertices.iter().position(|vertex| !finite(vertex)) {
            return Err(UnionError::NotFinite(vertex));
        }
        let parts = components(count, &triangles);
        Ok(Self {
            origin: mesh.origin,
            vertices: mesh.vertices.clone(),
            fresh: vec![false; count],
            seam: vec![false; count],
            changed: vec![false; triangles.len()],
            triangles,
            parts,
        })
    }

    /// The mesh, without vertices that no triangle names.
    pub(crate) fn finish(self) -> SurfaceMesh {
        let mut new = vec![u32::MAX; self.vertices.len()];
        for &corner in self.triangles.iter().flatten() {
            new[corner as usize] = 0;
        }
        let mut vertices = Vec::new();
        for (vertex, new) in self.vertices.iter().zip(&mut new) {
            if *new == 0 {
                *new = vertices.len() as u32;
                vertices.push(*vertex);
            }
        }
        let triangles = self.triangles.iter();
        let triangles = triangles.map(|face| face.map(|corner| new[corner as usize]));
        SurfaceMesh {
            origin: self.origin,
            vertices,
            faces: Faces {
                triangles: triangles.collect(),
                quads: Vec::new(),
            },
        }
    }

    /// Adds a vertex of ours; `seam`: whether a cut made it.
    pub(crate) fn push(&mut self, vertex: SurfaceVertex, seam: bool) -> u32 {
        self.vertices.push(vertex);
        self.fresh.push(true);
        self.seam.push(seam);
        self.vertices.len() as u32 - 1
    }

    pub(crate) fn position(&self, vertex: u32) -> Vec3 {
        self.vertices[vertex as usize].position
    }

    /// Positions of all vertices.
    pub(crate) fn positions(&self) -> Vec<Vec3> {
        self.vertices.iter().map(|vertex| vertex.position).collect()
    }

    /// The triangles as faces of the mesh crate.
    pub(crate) fn faces(&self) -> Faces {
        Faces {
            triangles: self.triangles.clone(),
            quads: Vec::new(),
        }
    }

    /// What is closed, and how many components and handles there are.
    pub(crate) fn shape(&self) -> Topology {
        topology(&self.positions(), &self.faces())
    }

    /// Corners of a triangle.
    pub(crate) fn corners(&self, face: u32) -> [DVec3; 3] {
        self.triangles[face as usize].map(|corner| self.position(corner).as_dvec3())
    }

    /// A position in the tracing's own coordinates (µm).
    pub(crate) fn place(&self, position: DVec3) -> DVec3 {
        self.origin + position
    }

    /// Whether a triangle has a vertex of ours.
    pub(crate) fn is_fresh(&self, face: &[u32; 3]) -> bool {
        face.iter().any(|&corner| self.fresh[corner as usize])
    }

    /// Whether a triangle is not of the input as it is.
    pub(crate) fn is_changed(&self, face: u32) -> bool {
        self.changed[face as usize] || self.is_fresh(&self.triangles[face as usize])
    }

    /// Triangles that are not of the input as they are, in order.
    pub(crate) fn changed_faces(&self) -> Vec<u32> {
        let faces = 0..self.triangles.len() as u32;
        faces.filter(|&face| self.is_changed(face)).collect()
    }

    /// Crossings of faces that are not of the input: the others' were all cut.
    pub(crate) fn crossings_of_changed(&self) -> Vec<[u32; 2]> {
        match self.changed_faces() {
            none if none.is_empty() => Vec::new(),
            changed => self_intersections_of(&self.positions(), &self.faces(), &changed),
        }
    }

    /// A set of vertices together with those up to `rings` edges away.
    pub(crate) fn widened(&self, mut vertices: Vec<bool>, rings: usize) -> Vec<bool> {
        for _ in 0..rings {
            let last = vertices.clone();
            for face in &self.triangles {
                if face.iter().any(|&corner| last[corner as usize]) {
                    face.iter()
                        .for_each(|&corner| vertices[corner as usize] = true);
                }
            }
        }
        vertices
    }

    /// Keeps those triangles for which `keep` holds.
    pub(crate) fn retain(&mut self, keep: impl Fn(usize) -> bool) {
        let mut next = 0;
        for face in 0..self.triangles.len() {
            if keep(face) {
                self.triangles[next] = self.triangles[face];
                self.parts[next] = self.parts[face];
                self.changed[next] = self.changed[face];
                next += 1;
            }
        }
        self.triangles.truncate(next);
        self.parts.truncate(next);
        self.changed.truncate(next);
    }
}

/// For each triangle the component that it is of, numbered in the order of their first triangles.
pub(crate) fn components(vertices: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut forest = Forest::new(vertices);
    for &[a, b, c] in triangles {
        forest.unite(a, b);
        forest.unite(b, c);
    }
    let mut number = vec![u32::MAX; vertices];
    let mut next = 0;
    let of = |&[a, _, _]: &[u32; 3]| {
        let number = &mut number[forest.root(a) as usize];
        if *number == u32::MAX {
            *number = next;
            next += 1;
        }
        *number
    };
    triangles.iter().map(of).collect()
}
