//! The one file that knows `manifold-rust`: the exact **arrangement** of triangles, and how faces lie
//! around an edge of it.
//!
//! **Theory.** Triangles are cut along one another's surfaces in rational arithmetic, so that the pieces
//! meet in common edges and vertices only; space falls into **cells** (Q. Zhou, E. Grinspun, D. Zorin,
//! A. Jacobson, Mesh Arrangements for Solid Geometry, 2016). The triangles need not be closed: then cells
//! are known as far as the pieces reach, and that is all we ask for.
//!
//! **Why not** `Manifold::rebuild_solid`, which does it all: it wants the whole closed surface, and its
//! time grows with it; and it simplifies what it gives back, where we keep untouched faces to the bit.

use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use manifold_rust::linalg::Vec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::robust::cells::{ANTI, NORMAL, VertTables, build_cells, radial_fan};
use manifold_rust::robust::intersection_graph::{IntersectionGraph, build_graph, edge_key};

/// Triangles that meet in common edges and vertices only.
pub(crate) struct Arrangement {
    graph: IntersectionGraph,
    /// In the order of their sources.
    pub(crate) pieces: Vec<Piece>,
    /// Number of cells that pieces name.
    pub(crate) cells: usize,
}

/// A part of a triangle, or all of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// Which triangle it is of.
    pub(crate) source: u32,
    /// Vertices of the arrangement, turning as the triangle does.
    pub(crate) corners: [u32; 3],
    /// The cell that the normal points to, and the one behind.
    pub(crate) cells: [u32; 2],
}

/// A face at an edge: which, whether it runs from the edge's lower vertex to the higher, and its third
/// corner.
pub(crate) struct HalfFace {
    pub(crate) id: usize,
    pub(crate) rising: bool,
    pub(crate) apex: u32,
}

/// Arranges triangles. Those without an area are left out. The error is the text of a panic: bad input is
/// none of ours to trust this library with.
pub(crate) fn arrange(triangles: &[[DVec3; 3]]) -> Result<Arrangement, String> {
    let soup: Vec<[Vec3; 3]> = triangles
        .iter()
        .map(|corners| corners.map(|p| Vec3::new(p.x, p.y, p.z)))
        .collect();
    let (graph, complex) = guarded(|| {
        let graph = build_graph(&soup, &[]);
        let complex = build_cells(&graph);
        (graph, complex)
    })?;
    let pieces = graph
        .pieces
        .iter()
        .enumerate()
        .map(|(n, piece)| Piece {
            source: piece.tri as u32,
            corners: piece.vi,
            cells: [NORMAL, ANTI].map(|side| complex.cell(n, side) as u32),
        })
        .collect();
    Ok(Arrangement {
        pieces,
        cells: complex.num_cells,
        graph,
    })
}

impl Arrangement {
    /// Number of vertices.
    pub(crate) fn vertices(&self) -> usize {
        self.graph.verts_f64.len()
    }

    /// Where a vertex is, rounded to the nearest.
    pub(crate) fn position(&self, vertex: u32) -> DVec3 {
        let p = self.graph.verts_f64[vertex as usize];
        DVec3::new(p.x, p.y, p.z)
    }

    /// Faces around the edge from `low` to `high`, counter-clockwise seen from `high`: their ids.
    pub(crate) fn around(&self, low: u32, high: u32, faces: &[HalfFace]) -> Vec<usize> {
        let key = edge_key(low, high);
        let raw: Vec<_> = faces
            .iter()
            .map(|face| (key, face.id, face.rising, face.apex))
            .collect();
        let fan = guarded(|| radial_fan(low, high, &raw, VertTables::of(&self.graph)));
        let fan = fan.ok().flatten();
        fan.map_or_else(Vec::new, |(sorted, _)| {
            sorted.iter().map(|face| face.id).collect()
        })
    }
}

/// The convex hull of points, its corners and its faces, which look outwards; none if they have no extent in some
/// direction.
pub(crate) fn hull(points: &[DVec3]) -> Option<(Vec<DVec3>, Vec<[u32; 3]>)> {
    let points: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.x, p.y, p.z)).collect();
    let hull = guarded(|| Manifold::hull(&points).get_mesh_gl64(-1)).ok()?;
    let corners = hull.vert_properties.chunks_exact(hull.num_prop as usize);
    let corners = corners.map(|p| DVec3::new(p[0], p[1], p[2])).collect();
    let faces = hull.tri_verts.chunks_exact(3);
    let faces: Vec<[u32; 3]> = faces
        .map(|face| [face[0] as u32, face[1] as u32, face[2] as u32])
        .collect();
    (!faces.is_empty()).then_some((corners, faces))
}

/// The text of a panic as an error.
fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        text.or_else(|| panic.downcast_ref::<&str>().copied())
            .unwrap_or("it panicked")
            .to_owned()
    })
}
