//! The edges of a coarse mesh, each once, and those of every patch.

use neurotess_mesh::{CoarseMesh, Patch, PatchKind, Role};

use super::Edge;
use crate::evaluate::{EdgeKind, SIDES};

/// Finds the edges of the patches that are shown, all without `shown`, and those of each of these patches. Counts
/// half-edges by their lower vertex: this needs no hashing, and sorts only the few edges of each vertex.
///
/// An edge is what the first of its patches says, be that shown or not: it is the same in every part of a mesh.
pub(super) fn find_edges(mesh: &CoarseMesh, shown: Option<&[bool]>) -> (Vec<Edge>, Vec<[u32; 4]>) {
    let Some(shown) = shown else {
        return find(mesh, |_| true, |_| true);
    };
    let mut touched = vec![false; mesh.vertices.len()];
    for (patch, _) in mesh.patches.iter().zip(shown).filter(|(_, shown)| **shown) {
        for corner in patch.corners {
            touched[corner as usize] = true;
        }
    }
    find(mesh, |patch| shown[patch], |v| touched[v as usize])
}

/// `is_touched`: whether a vertex is a corner of a patch that is shown.
fn find(
    mesh: &CoarseMesh,
    is_shown: impl Fn(usize) -> bool,
    is_touched: impl Fn(u32) -> bool,
) -> (Vec<Edge>, Vec<[u32; 4]>) {
    // Ends of a half-edge, the lower first, if its edge may be one of a patch that is shown.
    let ends = |patch: usize, side: usize| -> Option<(u32, u32)> {
        let corners = mesh.patches[patch].corners;
        let (a, b) = (corners[SIDES[side].0], corners[SIDES[side].1]);
        (is_touched(a) && is_touched(b)).then(|| (a.min(b), a.max(b)))
    };
    // Where the half-edges of each vertex begin; while they are filled in, where the next one of the vertex before goes.
    let mut start = vec![0_u32; mesh.vertices.len() + 2];
    for patch in 0..mesh.patches.len() {
        for side in 0..4 {
            if let Some((low, _)) = ends(patch, side) {
                start[low as usize + 2] += 1;
            }
        }
    }
    for i in 1..start.len() {
        start[i] += start[i - 1];
    }
    // The higher end, patch and side of each: in one number, which sorts faster than two.
    let mut half_edges = vec![0_u64; start[start.len() - 1] as usize];
    for patch in 0..mesh.patches.len() {
        for side in 0..4 {
            if let Some((low, high)) = ends(patch, side) {
                let slot = &mut start[low as usize + 1];
                half_edges[*slot as usize] = u64::from(high) << 32 | (4 * patch + side) as u64;
                *slot += 1;
            }
        }
    }
    // Most edges have two.
    let mut edges = Vec::with_capacity(half_edges.len() / 2);
    let mut patch_edges = vec![[0_u32; 4]; mesh.patches.len()];
    for v in 0..mesh.vertices.len() {
        let of_vertex = &mut half_edges[start[v] as usize..start[v + 1] as usize];
        of_vertex.sort_unstable();
        // The edge of the last half-edge: its higher end, which patch and side say what it is, and whether it is listed.
        let mut last = (u32::MAX, 0, 0, false);
        for &half_edge in of_vertex.iter() {
            let (high, half) = ((half_edge >> 32) as u32, half_edge as u32 as usize);
            let (patch, side) = (half / 4, half % 4);
            if high != last.0 {
                last = (high, patch, side, false);
            }
            if is_shown(patch) {
                if !last.3 {
                    edges.push(describe(mesh, last.1, last.2));
                    last.3 = true;
                }
                patch_edges[patch][side] = edges.len() as u32 - 1;
            }
        }
    }
    (edges, patch_edges)
}

/// Kind of a patch's side, and whether its edge runs against the patch's coordinate.
pub(crate) fn side_of(mesh: &CoarseMesh, patch: usize, side: usize) -> (EdgeKind, bool) {
    let edge = describe(mesh, patch, side);
    let start = mesh.patches[patch].corners[SIDES[side].0];
    (edge.kind, edge.from != start)
}

fn describe(mesh: &CoarseMesh, patch: usize, side: usize) -> Edge {
    let Patch { corners, kind } = mesh.patches[patch];
    let (a, b) = (corners[SIDES[side].0], corners[SIDES[side].1]);
    let tracing = |v: u32| mesh.vertices[v as usize].tracing;
    let role = |v: u32| mesh.tracing[tracing(v) as usize].role;
    let around = tracing(a) == tracing(b) && role(a) != Role::Soma;
    let edge_kind = match kind {
        _ if around => EdgeKind::Ring,
        PatchKind::Soma => EdgeKind::Soma,
        PatchKind::Loft if side % 2 == 1 => EdgeKind::Loft,
        // The side of a trunk's quad is as in the tube beside it, that of a soma's as in the soma.
        PatchKind::Loft if role(a) != Role::Ordinary || role(b) != Role::Ordinary => EdgeKind::Soma,
        PatchKind::Lateral | PatchKind::Cap | PatchKind::Loft => EdgeKind::Along,
    };
    // A path's rings are numbered along it, so a loft's side finds the direction of the tube beside it.
    let (from, to) = match (edge_kind, kind) {
        (EdgeKind::Loft, _) | (EdgeKind::Along, PatchKind::Lateral | PatchKind::Cap) => (a, b),
        _ => (a.min(b), a.max(b)),
    };
    let kind = edge_kind;
    Edge {
        from,
        to,
        kind,
        level: 1,
        first: 0,
    }
}
