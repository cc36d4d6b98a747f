//! The whole judgment of a mesh, as `neurotess check` prints it.

use serde::Serialize;

use crate::{Quality, SurfaceMesh, genus_by_component, quality, search_self_intersections};

/// What a mesh is and what is wrong with it. Serialized under these names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Vertices, used or not.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Quads.
    pub quads: usize,
    /// Every edge has exactly two faces.
    pub closed: bool,
    /// No edge has more than two faces.
    pub edge_manifold: bool,
    /// The faces at every vertex form one fan.
    pub vertex_manifold: bool,
    /// Faces run through each edge that they share in opposite directions.
    pub oriented: bool,
    /// Parts that share no vertex.
    pub components: usize,
    /// Used vertices − edges + faces.
    pub euler: i64,
    /// Handles; none if the mesh is not closed or not manifold.
    pub genus: Option<i64>,
    /// Handles of each component, in the order of their lowest vertices; empty if the genus is none.
    pub handles: Vec<i64>,
    /// Enclosed volume (µm³), positive if the faces turn outwards.
    pub volume: f64,
    /// Area (µm²).
    pub area: f64,
    /// Faces that repeat a corner or have no area.
    pub degenerate_faces: usize,
    /// Pairs of faces that cross, adjacent faces aside.
    pub self_intersections: usize,
    /// Whether these are all: among thousands of pieces in one place not every pair is looked at.
    pub self_intersections_complete: bool,
    /// Shapes of the triangles, and gaps between them.
    pub quality: Quality,
}

/// Judges a mesh: [`topology`](crate::topology), [`measure`](crate::measure), [`quality`](crate::quality())
/// and [`search_self_intersections`](crate::search_self_intersections).
pub fn check(mesh: &SurfaceMesh) -> Report {
    let topology = mesh.topology();
    let measure = mesh.measure();
    let crossings = search_self_intersections(&mesh.positions(), &mesh.faces);
    let handles = || genus_by_component(mesh.vertices.len(), &mesh.faces);
    Report {
        vertices: topology.vertices,
        triangles: mesh.faces.triangles.len(),
        quads: mesh.faces.quads.len(),
        closed: topology.closed,
        edge_manifold: topology.edge_manifold,
        vertex_manifold: topology.vertex_manifold,
        oriented: topology.oriented,
        components: topology.components,
        euler: topology.euler,
        genus: topology.genus,
        handles: topology.genus.map(|_| handles()).unwrap_or_default(),
        volume: measure.volume,
        area: measure.area,
        degenerate_faces: topology.degenerate_faces,
        self_intersections: crossings.pairs.len(),
        self_intersections_complete: crossings.complete,
        quality: quality(mesh),
    }
}
