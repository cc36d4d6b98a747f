//! The refined surface, evaluated block by block from the coarse mesh.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use neurotess_mesh::{
    CoarseMesh, Faces, Patch, PatchKind, Role, Soundness, Surface, SurfaceVertex, TracingPoint,
};
use rayon::prelude::*;

use crate::evaluate::{
    Corner, EdgeCurve, EdgeKind, EdgeNormals, PatchRow, PatchRows, PatchShape, SIDES,
};
use crate::plan::{Edge, Grid, Plan};
use crate::{CoarseSurface, Lod, RefineOptions};

/// A coarse mesh with levels: a [`Surface`] that holds no refined vertices. Its blocks are
/// evaluated when they are read, so that memory does not grow with the level.
pub struct Refinement<'m> {
    mesh: &'m CoarseMesh,
    options: RefineOptions,
    plan: Plan,
}

/// Coarse vertices, edges or patches in one block.
const BLOCK: usize = 1024;

impl<'m> Refinement<'m> {
    /// Plans the refinement of a closed mesh.
    ///
    /// Levels outside 1 to 64 are clamped. Missing [`Lod::point_levels`] are 1.
    pub fn new<'l>(mesh: &'m CoarseMesh, lod: impl Into<Lod<'l>>, options: &RefineOptions) -> Self {
        Self {
            mesh,
            options: *options,
            plan: Plan::new(mesh, &lod.into(), options),
        }
    }

    /// Number of edges of the refined surface.
    pub fn edge_count(&self) -> usize {
        // The mesh is closed: every edge has two faces.
        (3 * self.plan.triangles + 4 * self.plan.quads) / 2
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
    /// 1, the second and fourth those along y at x = 1 and 0.
    pub fn patch_levels(&self, patch: usize) -> [u32; 4] {
        self.plan.patch_edges[patch].map(|e| u32::from(self.plan.edges[e as usize].level))
    }

    /// Columns and rows of cells in the grid of a patch.
    pub fn patch_grid(&self, patch: usize) -> (u32, u32) {
        let grid = self.plan.grid(self.mesh, &self.options, patch);
        (grid.nx, grid.ny)
    }

    /// The vertex at column i and row j of a patch's grid. On a coarser side several columns or
    /// rows have the same vertex. The GPU must compute the same.
    pub fn grid_vertex(&self, patch: usize, i: u32, j: u32) -> SurfaceVertex {
        let corners = self.mesh.patches[patch].corners;
        let grid = self.plan.grid(self.mesh, &self.options, patch);
        let index = self.plan.vertex(corners, patch, &grid, i, j);
        if let Some(inner) = index.checked_sub(self.plan.patch_first[patch]) {
            let (x, y) = (inner % (grid.nx - 1) + 1, inner / (grid.nx - 1) + 1);
            let inner = InnerVertices::new(self, patch);
            return inner.vertex(&inner.row(&inner.rows(), y), [x, y]);
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
        found.unwrap_or_else(|| self.coarse_vertex(index as usize))
    }

    /// Volume (µm³) and area (µm²) of the refined surface. Evaluates the whole surface, on all
    /// cores.
    pub fn volume_and_area(&self) -> (f64, f64) {
        let center = self
            .mesh
            .vertices
            .first()
            .map_or(Vec3::ZERO, |v| v.position);
        let blocks = self.mesh.patches.len().div_ceil(BLOCK);
        let sums: Vec<(f64, f64)> = (0..blocks)
            .into_par_iter()
            .map(|block| {
                let end = ((block + 1) * BLOCK).min(self.mesh.patches.len());
                let mut faces = Faces::default();
                let mut sum = (0.0, 0.0);
                let mut positions = Vec::new();
                let mut rows = Vec::new();
                for patch in block * BLOCK..end {
                    faces.triangles.clear();
                    faces.quads.clear();
                    let plan = &self.plan;
                    plan.faces(self.mesh, &self.options, patch, &mut rows, &mut faces);
                    self.measure_patch(patch, center, &faces, &mut positions, &mut sum);
                }
                sum
            })
            .collect();
        sums.iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
    }

    fn measure_patch(
        &self,
        patch: usize,
        center: Vec3,
        faces: &Faces,
        positions: &mut Vec<(u32, DVec3)>,
        sum: &mut (f64, f64),
    ) {
        let grid = self.plan.grid(self.mesh, &self.options, patch);
        let corners = self.mesh.patches[patch].corners;
        positions.clear();
        let mut add = |index: u32, p: Vec3| positions.push((index, (p - center).as_dvec3()));
        for v in corners {
            add(v, self.mesh.vertices[v as usize].position);
        }
        for e in self.plan.patch_edges[patch] {
            let edge = &self.plan.edges[e as usize];
            for k in 1..u32::from(edge.level) {
                add(edge.first + k - 1, self.edge_vertex(edge, k).position);
            }
        }
        let shape = self.shape(patch);
        let first = self.plan.patch_first[patch];
        for j in 1..grid.ny {
            for i in 1..grid.nx {
                let (x, y) = (i as f32 / grid.nx as f32, j as f32 / grid.ny as f32);
                let index = first + (j - 1) * (grid.nx - 1) + i - 1;
                add(index, shape.interior(&self.options, x, y).0);
            }
        }
        positions.sort_unstable_by_key(|&(index, _)| index);
        let at = |index: u32| {
            let found = positions.binary_search_by_key(&index, |&(i, _)| i);
            positions[found.expect("all vertices of the patch are listed")].1
        };
        let halves = faces
            .quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        for [a, b, c] in faces.triangles.iter().copied().chain(halves) {
            let [a, b, c] = [a, b, c].map(at);
            let cross = (b - a).cross(c - a);
            sum.0 += a.dot(cross) / 6.0;
            sum.1 += 0.5 * cross.length();
        }
    }

    fn shape(&self, patch: usize) -> PatchShape {
        let corners = self.mesh.patches[patch].corners;
        let sides = [0, 1, 2, 3].map(|side: usize| {
            let edge = &self.plan.edges[self.plan.patch_edges[patch][side] as usize];
            (edge.kind, edge.from != corners[SIDES[side].0])
        });
        let kind = self.mesh.patches[patch].kind;
        PatchShape {
            kind,
            corners: corners.map(|v| Corner::new(self.mesh, v)),
            sides,
        }
    }

    fn tracing(&self, vertex: u32) -> &TracingPoint {
        &self.mesh.tracing[self.mesh.vertices[vertex as usize].tracing as usize]
    }

    fn coarse_vertex(&self, index: usize) -> SurfaceVertex {
        let vertex = &self.mesh.vertices[index];
        let tracing = self.tracing(index as u32);
        attributed(vertex.position, vertex.normal, tracing, tracing.radius)
    }

    /// Inner vertex k of an edge, 0 < k < level.
    fn edge_vertex(&self, plan: &Edge, k: u32) -> SurfaceVertex {
        let ends = self.ends(plan);
        InnerEdge::new(self, plan, &ends).vertex(k)
    }

    /// Appends the inner vertices of an edge.
    fn edge_vertices(&self, plan: &Edge, out: &mut Vec<SurfaceVertex>) {
        let level = u32::from(plan.level);
        if level < 2 {
            return;
        }
        let ends = self.ends(plan);
        let inner = InnerEdge::new(self, plan, &ends);
        out.extend((1..level).map(|k| inner.vertex(k)));
    }

    fn ends(&self, plan: &Edge) -> [Corner; 2] {
        [plan.from, plan.to].map(|v| Corner::new(self.mesh, v))
    }

    fn patch_vertices(&self, patch: usize, out: &mut Vec<SurfaceVertex>) {
        let grid = self.plan.grid(self.mesh, &self.options, patch);
        if grid.nx < 2 || grid.ny < 2 {
            return;
        }
        let inner = InnerVertices::new(self, patch);
        let rows = inner.rows();
        for j in 1..grid.ny {
            let row = inner.row(&rows, j);
            out.extend((1..grid.nx).map(|i| inner.vertex(&row, [i, j])));
        }
    }
}

/// What the inner vertices of an edge have in common.
struct InnerEdge<'r> {
    curve: EdgeCurve<'r>,
    normals: EdgeNormals,
    level: u16,
    tracing: [&'r TracingPoint; 2],
    /// Whether all of it belongs to where it ends: what leads from a fork to a branch is the branch's.
    is_of_end: bool,
    /// That of the soma, which all vertices of its edges show, so that the color changes at the neurite's ring.
    soma: Option<&'r TracingPoint>,
}

impl<'r> InnerEdge<'r> {
    fn new(refinement: &'r Refinement<'_>, plan: &Edge, ends: &'r [Corner; 2]) -> Self {
        let [a, b] = ends;
        let tracing = [plan.from, plan.to].map(|v| refinement.tracing(v));
        let of_soma = |t: &&TracingPoint| plan.kind == EdgeKind::Soma && t.role == Role::Soma;
        Self {
            curve: EdgeCurve::new(plan.kind, a, b, refinement.options.path),
            normals: EdgeNormals::new(plan.kind, a, b),
            level: plan.level,
            tracing,
            is_of_end: match plan.kind {
                EdgeKind::Loft => true,
                EdgeKind::Along => tracing[0].role == Role::Joint,
                EdgeKind::Ring | EdgeKind::Soma => false,
            },
            soma: tracing.into_iter().find(of_soma),
        }
    }

    /// Vertex k, 0 < k < level.
    fn vertex(&self, k: u32) -> SurfaceVertex {
        let t = k as f32 / f32::from(self.level);
        let jet = self.curve.at(t);
        let normal = self.normals.at(jet.derivative, t);
        let [ta, tb] = self.tracing;
        let radius = self.curve.radius(t);
        let shown = if t < 0.5 && !self.is_of_end { ta } else { tb };
        attributed(jet.position, normal, self.soma.unwrap_or(shown), radius)
    }
}

/// What the inner vertices of a patch have in common.
struct InnerVertices<'r> {
    shape: PatchShape,
    grid: Grid,
    options: &'r RefineOptions,
    /// By corner.
    tracing: [&'r TracingPoint; 4],
    /// As of an [edge](InnerEdge::is_of_end).
    is_of_end: bool,
    /// That of the soma, which all vertices of its patches show.
    soma: Option<&'r TracingPoint>,
}

impl<'r> InnerVertices<'r> {
    fn new(refinement: &'r Refinement<'_>, patch: usize) -> Self {
        let Patch { corners, kind } = refinement.mesh.patches[patch];
        let tracing = corners.map(|v| refinement.tracing(v));
        let of_soma = |t: &&TracingPoint| kind == PatchKind::Soma && t.role == Role::Soma;
        Self {
            shape: refinement.shape(patch),
            grid: refinement
                .plan
                .grid(refinement.mesh, &refinement.options, patch),
            options: &refinement.options,
            tracing,
            is_of_end: match kind {
                PatchKind::Loft => true,
                PatchKind::Lateral => tracing[0].role == Role::Joint,
                PatchKind::Cap | PatchKind::Soma => false,
            },
            soma: tracing.into_iter().find(of_soma),
        }
    }

    fn rows(&self) -> PatchRows<'_> {
        self.shape.rows(self.options)
    }

    /// Points of row j of the grid.
    fn row<'s>(&self, rows: &PatchRows<'s>, j: u32) -> PatchRow<'s> {
        rows.at(j as f32 / self.grid.ny as f32)
    }

    /// The vertex at column i of row j.
    fn vertex(&self, row: &PatchRow<'_>, [i, j]: [u32; 2]) -> SurfaceVertex {
        let (x, y) = (
            i as f32 / self.grid.nx as f32,
            j as f32 / self.grid.ny as f32,
        );
        let (position, normal) = row.point(x);
        let is_second = y >= 0.5 || self.is_of_end;
        let shown = usize::from(is_second) * 2 + usize::from((x >= 0.5) != is_second);
        let radius = row.radius(x);
        let tracing = self.soma.unwrap_or(self.tracing[shown]);
        attributed(position, normal, tracing, radius)
    }
}

fn attributed(position: Vec3, normal: Vec3, tracing: &TracingPoint, radius: f32) -> SurfaceVertex {
    let TracingPoint {
        kind,
        sample,
        section,
        ..
    } = *tracing;
    SurfaceVertex {
        position,
        normal,
        kind: kind.0,
        point: sample.0,
        section: section.0,
        radius,
    }
}

impl Surface for Refinement<'_> {
    fn origin(&self) -> DVec3 {
        self.mesh.origin
    }

    fn soundness(&self) -> Option<Soundness> {
        CoarseSurface::new(self.mesh, true).soundness()
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
            out.extend(range(block, corners).map(|v| self.coarse_vertex(v)));
        } else if block < corner_blocks + edge_blocks {
            for edge in &self.plan.edges[range(block - corner_blocks, edges)] {
                self.edge_vertices(edge, out);
            }
        } else {
            for patch in range(block - corner_blocks - edge_blocks, self.mesh.patches.len()) {
                self.patch_vertices(patch, out);
            }
        }
    }

    fn face_blocks(&self) -> usize {
        self.mesh.patches.len().div_ceil(BLOCK)
    }

    fn faces(&self, block: usize, out: &mut Faces) {
        let end = ((block + 1) * BLOCK).min(self.mesh.patches.len());
        let mut rows = Vec::new();
        for patch in block * BLOCK..end {
            let plan = &self.plan;
            plan.faces(self.mesh, &self.options, patch, &mut rows, out);
        }
    }
}
