//! The plan of a refinement: edges with their levels, and the numbers of all refined vertices.
//!
//! The vertices of the coarse mesh come first, then the inner ones of every edge in the edge's
//! direction, then the inner ones of every patch row by row. Memory grows with the coarse mesh
//! only, not with the level.

mod edges;
mod faces;

use std::ops::Range;

use neurotess_mesh::{CoarseMesh, PatchKind};
use rayon::prelude::*;

pub(crate) use crate::edge::Edge;
use crate::evaluate::Corners;
use crate::fours::{Fours, four};
use crate::level::{HIGHEST_LEVEL, bend, edge_levels};
use crate::{Caps, Lod, Path, RefineOptions};
use edges::find_edges;
pub(crate) use edges::side_of;
pub(crate) use faces::Numbers;

/// All edges of the patches that are shown, and the edges and inner vertices of each of these.
pub(crate) struct Plan {
    /// All, without.
    pub(crate) shown: Option<Vec<bool>>,
    pub(crate) edges: Vec<Edge>,
    pub(crate) patch_edges: Vec<[u32; 4]>,
    /// Number of the first inner vertex of each patch, as in [`Edge::first`].
    pub(crate) patch_first: Vec<u32>,
    pub(crate) vertices: u64,
    pub(crate) triangles: usize,
    pub(crate) quads: usize,
}

/// The grid of a patch: its columns and rows of cells, and the levels of its four sides.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Grid {
    pub(crate) nx: u32,
    pub(crate) ny: u32,
    pub(crate) levels: [u32; 4],
}

/// The first number of a range, and how many there are up to the next.
fn numbers(range: &Range<usize>, first: impl Fn(usize) -> u32) -> (u32, usize) {
    let start = first(range.start);
    (start, first(range.end).wrapping_sub(start) as usize)
}

/// Edges that are worth a thread.
const MIN_EDGES: usize = 4096;

impl Plan {
    /// `shown`: for each patch, or none where all are.
    pub(crate) fn new(
        mesh: &CoarseMesh,
        lod: &Lod<'_>,
        options: &RefineOptions,
        shown: Option<Vec<bool>>,
    ) -> Self {
        let (mut edges, patch_edges) = find_edges(mesh, shown.as_deref());
        edges.par_chunks_mut(MIN_EDGES).for_each(|edges| {
            let set = |edges: &mut [Edge], of: [u32; 4]| {
                let levels = four(|k| &edges[of[k] as usize]);
                let levels = edge_levels(mesh, lod, options.path, levels);
                for (edge, level) in of.into_iter().zip(levels) {
                    edges[edge as usize].level = level as u16;
                }
            };
            let mut waiting = Fours::<u32>::default();
            for edge in 0..edges.len() {
                if let Some(four) = waiting.add(edges[edge].kind as u32, edge as u32) {
                    set(edges, four);
                }
            }
            for four in waiting.rest() {
                set(edges, four);
            }
        });
        let mut next = mesh.vertices.len() as u64;
        for edge in &mut edges {
            edge.first = next as u32;
            next += u64::from(edge.level) - 1;
        }
        let mut plan = Self {
            shown,
            edges,
            patch_edges,
            patch_first: Vec::new(),
            vertices: 0,
            triangles: 0,
            quads: 0,
        };
        plan.patch_first.reserve(mesh.patches.len());
        for patch in 0..mesh.patches.len() {
            let grid = plan.grid(mesh, options, patch);
            plan.patch_first.push(next as u32);
            next += grid.inner_count();
            let (triangles, quads) = grid.face_counts(options.quads);
            plan.triangles += triangles;
            plan.quads += quads;
        }
        plan.vertices = next;
        plan
    }

    pub(crate) fn vertex_count(&self) -> usize {
        usize::try_from(self.vertices).unwrap_or(usize::MAX)
    }

    /// Number of the first inner vertex of some edges, and how many they have.
    pub(crate) fn numbers_of_edges(&self, edges: &Range<usize>) -> (u32, usize) {
        let first = |edge: usize| match self.edges.get(edge) {
            Some(edge) => edge.first,
            None => self.first_of_patch(0),
        };
        numbers(edges, first)
    }

    /// The same for patches.
    pub(crate) fn numbers_of_patches(&self, patches: &Range<usize>) -> (u32, usize) {
        numbers(patches, |patch| self.first_of_patch(patch))
    }

    fn first_of_patch(&self, patch: usize) -> u32 {
        let first = self.patch_first.get(patch).copied();
        first.unwrap_or(self.vertices as u32)
    }

    /// The grid of a patch. One that is hidden has no cells.
    #[inline(always)]
    pub(crate) fn grid(&self, mesh: &CoarseMesh, options: &RefineOptions, patch: usize) -> Grid {
        if self.shown.as_ref().is_some_and(|shown| !shown[patch]) {
            return Grid::default();
        }
        let [a, b, c, d] = self.patch_edges[patch];
        let level = |edge: u32| u32::from(self.edges[edge as usize].level);
        let levels = [level(a), level(b), level(c), level(d)];
        Grid::new(mesh.patches[patch].kind, options.caps, levels)
    }
}

/// The vertex of an edge of `level` parts that is nearest to vertex i of n parts. If level ≤ n,
/// every vertex of the edge is the nearest of some i.
fn snap(i: u32, n: u32, level: u32) -> u32 {
    if level == n {
        // Nearly always, and without the division.
        return i;
    }
    (2 * i * level + n) / (2 * n)
}

/// By patch: the greatest bound of the second derivative of its sides (µm), whatever the path.
pub(crate) fn patch_bends(mesh: &CoarseMesh) -> Vec<f32> {
    let (edges, patch_edges) = find_edges(mesh, None);
    let bends: Vec<f32> = edges
        .iter()
        .map(|edge| {
            let [a, b] = [edge.from, edge.to].map(|v| Corners::new(mesh, [v; 4]));
            // A bound for both paths: on a straight one the radius may bend more.
            let [curved, straight] =
                [Path::Hermite, Path::Linear].map(|path| bend(path, edge.kind, &a, &b).x);
            let bend = if straight > curved { straight } else { curved };
            if bend.is_nan() { f32::INFINITY } else { bend }
        })
        .collect();
    let greatest = |sides: &[u32; 4]| sides.iter().map(|&e| bends[e as usize]).fold(0.0, f32::max);
    patch_edges.iter().map(greatest).collect()
}

/// Columns, rows and triangles of a patch whose four sides have these levels.
pub fn patch_triangles(kind: PatchKind, caps: Caps, levels: [u32; 4]) -> (u32, u32, usize) {
    let grid = Grid::new(kind, caps, levels);
    (grid.nx, grid.ny, grid.face_counts(false).0)
}

impl Grid {
    #[inline(always)]
    fn new(kind: PatchKind, caps: Caps, levels: [u32; 4]) -> Self {
        let (mut nx, mut ny) = (levels[0].max(levels[2]), levels[1].max(levels[3]));
        if kind == PatchKind::Cap && caps == Caps::Round {
            // A half sphere turns by 180° where the ring's side turns by 90°.
            let finer = |n: u32| if n > 1 { (2 * n).min(HIGHEST_LEVEL) } else { 1 };
            (nx, ny) = (finer(nx.max(ny)), finer(nx.max(ny)));
        }
        Self { nx, ny, levels }
    }

    /// Whether no side is coarser.
    fn is_whole(&self) -> bool {
        self.levels == [self.nx, self.ny, self.nx, self.ny]
    }

    pub(crate) fn inner_count(&self) -> u64 {
        u64::from(self.nx.saturating_sub(1)) * u64::from(self.ny.saturating_sub(1))
    }

    /// Which of the inner vertices the one at column i of row j is.
    #[inline(always)]
    pub(crate) fn inner(&self, i: u32, j: u32) -> usize {
        ((j - 1) * (self.nx - 1) + i - 1) as usize
    }

    /// Numbers of triangles and quads. Every step of a side that snapping makes empty takes one
    /// triangle away.
    pub(crate) fn face_counts(&self, quads: bool) -> (usize, usize) {
        let [nx, ny] = [self.nx as usize, self.ny as usize];
        let steps: u32 = self.levels.iter().sum();
        let empty = 2 * (nx + ny) - steps as usize;
        let triangles = 2 * nx * ny - empty;
        if !quads {
            return (triangles, 0);
        }
        let steps = |side: usize, n: u32, place: u32| {
            snap(place, n, self.levels[side]) != snap(place + 1, n, self.levels[side])
        };
        let mut whole = 0;
        for j in 0..self.ny {
            for i in 0..self.nx {
                let kept = (j > 0 || steps(0, self.nx, i))
                    && (j + 1 < self.ny || steps(2, self.nx, i))
                    && (i > 0 || steps(3, self.ny, j))
                    && (i + 1 < self.nx || steps(1, self.ny, j));
                whole += usize::from(kept);
            }
        }
        (triangles - 2 * whole, whole)
    }
}
