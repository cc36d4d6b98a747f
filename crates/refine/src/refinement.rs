//! The refined surface, evaluated block by block from the coarse mesh.

use std::collections::BTreeMap;

use glam::DVec3;
use neurotess_mesh::{CoarseMesh, Faces, PatchKind, Soundness, Surface, SurfaceVertex};

use crate::evaluate::{Corners, EdgeKind, PatchShape, SIDES};
use crate::fours::{Fours, four};
use crate::inner::{InnerEdges, coarse_vertex, inner_vertex, lateral_vertices, other_vertices};
use crate::plan::{Edge, Plan};
use crate::{CoarseSurface, Lod, RefineOptions};

/// A coarse mesh with levels: a [`Surface`] that holds no refined vertices. Its blocks are
/// evaluated when they are read, so that memory does not grow with the level.
pub struct Refinement<'m> {
    pub(crate) mesh: &'m CoarseMesh,
    pub(crate) options: RefineOptions,
    pub(crate) plan: Plan,
}

/// Coarse vertices, edges or patches in one block.
pub(crate) const BLOCK: usize = 1024;

impl<'m> Refinement<'m> {
    /// Plans the refinement of a closed mesh.
    ///
    /// Levels outside 1 to 64 are clamped. Missing [`Lod::point_levels`] are 1.
    pub fn new<'l>(mesh: &'m CoarseMesh, lod: impl Into<Lod<'l>>, options: &RefineOptions) -> Self {
        Self {
            mesh,
            options: *options,
            plan: Plan::new(mesh, &lod.into(), options, None),
        }
    }

    /// Plans the refinement of some patches: those that are `shown`; missing ones are hidden.
    ///
    /// Hidden patches have no faces and no inner vertices, and what only they touch is no edge. All else is as in the
    /// whole surface, equal to the bit: levels depend on edges alone. The vertices of the coarse mesh are all there.
    /// Such a surface is open, so it has no [`soundness`](Surface::soundness), and its volume means nothing.
    pub fn of_patches<'l>(
        mesh: &'m CoarseMesh,
        lod: impl Into<Lod<'l>>,
        options: &RefineOptions,
        shown: &[bool],
    ) -> Self {
        let mut shown = shown.to_vec();
        shown.resize(mesh.patches.len(), false);
        Self {
            mesh,
            options: *options,
            plan: Plan::new(mesh, &lod.into(), options, Some(shown)),
        }
    }

    /// Number of edges of the refined surface.
    pub fn edge_count(&self) -> usize {
        let sides = 3 * self.plan.triangles + 4 * self.plan.quads;
        // Every edge has two faces, but for those between patches of which one is hidden.
        let of_edges: usize = self.plan.edges.iter().map(|e| usize::from(e.level)).sum();
        let patches = 0..self.mesh.patches.len();
        let of_patch = |patch| self.patch_levels(patch).iter().sum::<u32>() as usize;
        let of_patches: usize = patches.map(of_patch).sum();
        (sides + 2 * of_edges - of_patches) / 2
    }

    /// Number of coarse edges by level, lowest first.
    pub fn level_histogram(&self) -> BTreeMap<u32, usize> {
        let mut histogram = BTreeMap::new();
        for edge in &self.plan.edges {
            *histogram.entry(u32::from(edge.level)).or_default() += 1;
        }
        histogram
    }

    /// Number of faces of one patch. The surface has them in the order of patches, triangles and
    /// quads in separate lists.
    pub fn patch_face_count(&self, patch: usize) -> usize {
        let grid = self.plan.grid(self.mesh, &self.options, patch);
        let (triangles, quads) = grid.face_counts(self.options.quads);
        triangles + quads
    }

    /// Levels of the four sides of a patch: the first and third are the sides along x at y = 0 and
    /// 1, the second and fourth those along y at x = 1 and 0. Those of a hidden patch are 0.
    pub fn patch_levels(&self, patch: usize) -> [u32; 4] {
        self.plan.grid(self.mesh, &self.options, patch).levels
    }

    /// Columns and rows of cells in the grid of a patch; none of a hidden one.
    pub fn patch_grid(&self, patch: usize) -> (u32, u32) {
        let grid = self.plan.grid(self.mesh, &self.options, patch);
        (grid.nx, grid.ny)
    }

    /// The vertex at column i and row j of a patch's grid. On a coarser side several columns or
    /// rows have the same vertex. The GPU must compute the same. Not for hidden patches.
    pub fn grid_vertex(&self, patch: usize, i: u32, j: u32) -> SurfaceVertex {
        let grid = self.plan.grid(self.mesh, &self.options, patch);
        let index = self.plan.vertex(self.mesh, patch, &grid, [i, j]);
        if let Some(inner) = index.checked_sub(self.plan.patch_first[patch]) {
            let (x, y) = (inner % (grid.nx - 1) + 1, inner / (grid.nx - 1) + 1);
            let of = (&self.shape(patch), &grid);
            return inner_vertex(self.mesh, &self.options, patch, of, [x, y]);
        }
        let on_edge = |&e: &u32| {
            let edge = &self.plan.edges[e as usize];
            let k = (index + 1).checked_sub(edge.first)?;
            (1..u32::from(edge.level))
                .contains(&k)
                .then(|| self.edge_vertex(edge, k))
        };
        let edges = &self.plan.patch_edges[patch];
        let found = edges.iter().find_map(on_edge);
        found.unwrap_or_else(|| {
            coarse_vertex(
                self.mesh,
                &self.options,
                &self.mesh.vertices[index as usize],
            )
        })
    }

    fn shape(&self, patch: usize) -> PatchShape {
        let corners = self.mesh.patches[patch].corners;
        let sides = [0, 1, 2, 3].map(|side: usize| {
            let edge = &self.plan.edges[self.plan.patch_edges[patch][side] as usize];
            (edge.kind, edge.from != corners[SIDES[side].0])
        });
        PatchShape::new(self.mesh, patch, sides)
    }

    /// Inner vertex k of an edge, 0 < k < level.
    fn edge_vertex(&self, edge: &Edge, k: u32) -> SurfaceVertex {
        let ends = Corners::of_edges(self.mesh, [edge.ends(); 4]);
        let inner = InnerEdges::new(self.mesh, &self.options, edge.kind, [edge; 4], &ends);
        inner.vertices(k)[0]
    }

    /// Puts the inner vertices of edges into `out`, those of each from a place on.
    pub(crate) fn edge_vertices(
        &self,
        edges: impl IntoIterator<Item = (u32, usize)>,
        out: &mut [SurfaceVertex],
    ) {
        let mut waiting = Fours::default();
        for (edge, start) in edges {
            let Edge { kind, level, .. } = self.plan.edges[edge as usize];
            if level > 1 {
                let key = u32::from(level) << 8 | kind as u32;
                if let Some(four) = waiting.add(key, (edge, start)) {
                    self.four_edges(four, out);
                }
            }
        }
        for four in waiting.rest() {
            self.four_edges(four, out);
        }
    }

    /// The same for four of one kind and level.
    fn four_edges(&self, things: [(u32, usize); 4], out: &mut [SurfaceVertex]) {
        let edges = four(|k| &self.plan.edges[things[k].0 as usize]);
        let starts = four(|k| things[k].1);
        // Each kind needs other things of corners.
        match edges[0].kind {
            EdgeKind::Ring => self.four_edges_of(EdgeKind::Ring, edges, starts, out),
            EdgeKind::Along => self.four_edges_of(EdgeKind::Along, edges, starts, out),
            kind => self.four_edges_of(kind, edges, starts, out),
        }
    }

    #[inline(always)]
    fn four_edges_of(
        &self,
        kind: EdgeKind,
        edges: [&Edge; 4],
        starts: [usize; 4],
        out: &mut [SurfaceVertex],
    ) {
        let ends = Corners::of_edges(self.mesh, four(|k| edges[k].ends()));
        let inner = InnerEdges::new(self.mesh, &self.options, kind, edges, &ends);
        for place in 0..usize::from(edges[0].level) - 1 {
            let vertices = inner.vertices(place as u32 + 1);
            put(out, four(|k| starts[k] + place), &vertices);
        }
    }

    /// Puts the inner vertices of patches into `out`, those of each from a place on.
    pub(crate) fn patch_vertices(
        &self,
        patches: impl IntoIterator<Item = (u32, usize)>,
        out: &mut [SurfaceVertex],
    ) {
        let mut waiting = Fours::default();
        for (of, start) in patches {
            let patch = of as usize;
            let grid = self.plan.grid(self.mesh, &self.options, patch);
            if grid.nx < 2 || grid.ny < 2 {
                continue;
            }
            if self.mesh.patches[patch].kind != PatchKind::Lateral {
                let of = (&self.shape(patch), &grid);
                other_vertices(self.mesh, &self.options, patch, of, |[i, j], vertex| {
                    out[start + grid.inner(i, j)] = vertex;
                });
            } else if let Some(four) = waiting.add(grid.nx << 16 | grid.ny, (of, start)) {
                self.four_patches(four, out);
            }
        }
        for four in waiting.rest() {
            self.four_patches(four, out);
        }
    }

    /// The same for four lateral ones with one grid.
    fn four_patches(&self, things: [(u32, usize); 4], out: &mut [SurfaceVertex]) {
        let patches = four(|k| things[k].0 as usize);
        let grid = self.plan.grid(self.mesh, &self.options, patches[0]);
        let put = |[i, j]: [u32; 2], vertices: [SurfaceVertex; 4]| {
            let place = grid.inner(i, j);
            put(out, four(|k| things[k].1 + place), &vertices);
        };
        lateral_vertices(self.mesh, &self.options, patches, &grid, put);
    }
}

/// Appends room for vertices.
fn room(out: &mut Vec<SurfaceVertex>, count: usize) -> &mut [SurfaceVertex] {
    let start = out.len();
    out.resize(start + count, SurfaceVertex::default());
    &mut out[start..]
}

#[inline(always)]
fn put(out: &mut [SurfaceVertex], places: [usize; 4], vertices: &[SurfaceVertex; 4]) {
    for k in 0..4 {
        out[places[k]] = vertices[k];
    }
}

impl Surface for Refinement<'_> {
    fn origin(&self) -> DVec3 {
        self.mesh.origin
    }

    fn soundness(&self) -> Option<Soundness> {
        // What is open has no volume.
        match self.plan.shown {
            Some(_) => None,
            None => CoarseSurface::new(self.mesh, true).soundness(),
        }
    }

    fn vertex_count(&self) -> usize {
        self.plan.vertex_count()
    }

    fn triangle_count(&self) -> usize {
        self.plan.triangles
    }

    fn quad_count(&self) -> usize {
        self.plan.quads
    }

    fn vertex_blocks(&self) -> usize {
        [
            self.mesh.vertices.len(),
            self.plan.edges.len(),
            self.mesh.patches.len(),
        ]
        .map(|n| n.div_ceil(BLOCK))
        .iter()
        .sum()
    }

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        let range = |block: usize, count: usize| block * BLOCK..((block + 1) * BLOCK).min(count);
        let (corners, edges) = (self.mesh.vertices.len(), self.plan.edges.len());
        let (corner_blocks, edge_blocks) = (corners.div_ceil(BLOCK), edges.div_ceil(BLOCK));
        if block < corner_blocks {
            let vertices = &self.mesh.vertices[range(block, corners)];
            out.extend(
                vertices
                    .iter()
                    .map(|vertex| coarse_vertex(self.mesh, &self.options, vertex)),
            );
        } else if block < corner_blocks + edge_blocks {
            let edges = range(block - corner_blocks, edges);
            let (first, count) = self.plan.numbers_of_edges(&edges);
            let out = room(out, count);
            let start = |e: usize| self.plan.edges[e].first.wrapping_sub(first) as usize;
            self.edge_vertices(edges.map(|e| (e as u32, start(e))), out);
        } else {
            let patches = range(block - corner_blocks - edge_blocks, self.mesh.patches.len());
            let (first, count) = self.plan.numbers_of_patches(&patches);
            let out = room(out, count);
            let start = |p: usize| self.plan.patch_first[p].wrapping_sub(first) as usize;
            self.patch_vertices(patches.map(|p| (p as u32, start(p))), out);
        }
    }

    fn face_blocks(&self) -> usize {
        self.mesh.patches.len().div_ceil(BLOCK)
    }

    fn faces(&self, block: usize, out: &mut Faces) {
        let end = ((block + 1) * BLOCK).min(self.mesh.patches.len());
        let mut rows = Vec::new();
        for patch in block * BLOCK..end {
            let numbers = self.plan.numbers(self.mesh, patch);
            let (mesh, options) = (self.mesh, &self.options);
            self.plan
                .faces(mesh, options, patch, &numbers, &mut rows, out);
        }
    }
}
