//! The inner vertices of edges and patches, four edges or patches of a kind at once.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Patch, PatchKind, Role, SurfaceVertex, Vertex};

use crate::evaluate::{
    Corners, EdgeCurves, EdgeKind, EdgeNormals, F32x4, PatchShape, Points, Tubes, along_border,
    loft_border, shift,
};
use crate::fours::four;
use crate::plan::{Edge, Grid};
use crate::{PointNumbers, RefineOptions};

/// What a vertex shows of the cell: type, sample and section of its tracing point.
#[derive(Clone, Copy, Debug)]
struct Shown {
    kind: i32,
    point: i32,
    section: i32,
}

impl Shown {
    /// `index`: of the tracing point.
    #[inline(always)]
    fn new(mesh: &CoarseMesh, options: &RefineOptions, index: u32) -> Self {
        let point = &mesh.tracing[index as usize];
        Self {
            kind: point.kind.0,
            point: match options.numbers {
                PointNumbers::OfSamples => point.sample.0,
                PointNumbers::OfTracing => index as i32,
            },
            section: point.section.0,
        }
    }

    /// What the halves of an edge show.
    #[inline(always)]
    fn of_halves(
        mesh: &CoarseMesh,
        options: &RefineOptions,
        kind: EdgeKind,
        edge: &Edge,
    ) -> [Self; 2] {
        let [start, end] = [tracing(mesh, edge.from), tracing(mesh, edge.to)];
        let role = |index: u32| mesh.tracing[index as usize].role;
        let [near, far] = match kind {
            // What leads from a joint to a branch is the branch's.
            EdgeKind::Along if role(start) == Role::Joint => [end, end],
            // All of a soma's edge is the soma's, so that the color changes at the neurite's ring.
            EdgeKind::Soma if role(start) == Role::Soma => [start, start],
            EdgeKind::Soma if role(end) == Role::Soma => [end, end],
            EdgeKind::Ring | EdgeKind::Along | EdgeKind::Loft | EdgeKind::Soma => [start, end],
        };
        [
            Self::new(mesh, options, near),
            Self::new(mesh, options, far),
        ]
    }

    /// What the quarters of a patch show, in the order of its corners.
    #[inline]
    fn of_quarters(mesh: &CoarseMesh, options: &RefineOptions, patch: usize) -> [Self; 4] {
        let Patch { corners, kind } = mesh.patches[patch];
        let points = four(|k| tracing(mesh, corners[k]));
        let role = |index: u32| mesh.tracing[index as usize].role;
        let [_, _, c, d] = points;
        let of_end = [d, c, c, d];
        let quarters = match kind {
            PatchKind::Lateral if role(points[0]) == Role::Joint => of_end,
            PatchKind::Soma => {
                let soma = points.iter().find(|&&point| role(point) == Role::Soma);
                soma.map_or(points, |&soma| [soma; 4])
            }
            PatchKind::Lateral | PatchKind::Loft | PatchKind::Cap => points,
        };
        four(|k| Self::new(mesh, options, quarters[k]))
    }

    #[inline(always)]
    fn vertex(&self, position: Vec3, normal: Vec3, radius: f32) -> SurfaceVertex {
        let Self {
            kind,
            point,
            section,
        } = *self;
        SurfaceVertex {
            position,
            normal,
            kind,
            point,
            section,
            radius,
        }
    }
}

/// A vertex of the coarse mesh.
#[inline]
pub(crate) fn coarse_vertex(
    mesh: &CoarseMesh,
    options: &RefineOptions,
    vertex: &Vertex,
) -> SurfaceVertex {
    let radius = mesh.tracing[vertex.tracing as usize].radius;
    Shown::new(mesh, options, vertex.tracing).vertex(vertex.position, vertex.normal, radius)
}

/// Index of the tracing point of a vertex.
#[inline(always)]
fn tracing(mesh: &CoarseMesh, vertex: u32) -> u32 {
    mesh.vertices[vertex as usize].tracing
}

/// How far along the way of so many parts to a vertex what is shown becomes the vertex's.
#[inline(always)]
fn border_to(mesh: &CoarseMesh, vertex: u32, parts: u32) -> f32 {
    along_border(mesh.tracing[tracing(mesh, vertex) as usize].border, parts)
}

/// The x from which on the second corner of the trunk's side of a loft shows, of so many columns: where the tube beside it
/// has its border.
fn loft_middle(mesh: &CoarseMesh, patch: &Patch, columns: u32) -> f32 {
    match patch.corners {
        [a, b, ..] if a < b => border_to(mesh, b, columns),
        [a, ..] => 1.0 - border_to(mesh, a, columns),
    }
}

/// The vertices that are shown for four points.
#[inline(always)]
fn vertices(points: &Points, radii: F32x4, shown: [&Shown; 4]) -> [SurfaceVertex; 4] {
    let (positions, normals) = (points.position.each(), points.normal.each());
    let radii = radii.to_array();
    four(|k| shown[k].vertex(positions[k], normals[k], radii[k]))
}

/// Inner vertices of four edges of one kind and level.
pub(crate) struct InnerEdges<'c> {
    curves: EdgeCurves<'c>,
    normals: EdgeNormals,
    level: u16,
    /// What the two parts of each show, and from where on the second one does.
    shown: [[Shown; 2]; 4],
    border: [f32; 4],
}

impl<'c> InnerEdges<'c> {
    /// `kind`: that of all four.
    #[inline(always)]
    pub(crate) fn new(
        mesh: &CoarseMesh,
        options: &RefineOptions,
        kind: EdgeKind,
        edges: [&Edge; 4],
        [a, b]: &'c [Corners; 2],
    ) -> Self {
        let level = edges[0].level;
        let border = match kind {
            EdgeKind::Loft => {
                let border = loft_border([a, a, b, b], F32x4::ZERO) + shift(a, b, f32::from(level));
                border.to_array()
            }
            // Both ends of a ring's side show the same.
            _ => four(|k| border_to(mesh, edges[k].to, level.into())),
        };
        Self {
            curves: EdgeCurves::new(kind, a, b, options.path),
            normals: EdgeNormals::new(kind, a, b),
            level,
            border,
            shown: four(|k| Shown::of_halves(mesh, options, kind, edges[k])),
        }
    }

    /// Vertex k of each, 0 < k < level.
    #[inline(always)]
    pub(crate) fn vertices(&self, k: u32) -> [SurfaceVertex; 4] {
        let t = k as f32 / f32::from(self.level);
        let shown = four(|lane| &self.shown[lane][usize::from(t >= self.border[lane])]);
        let t = F32x4::splat(t);
        let jets = self.curves.at(t);
        let points = Points {
            position: jets.position,
            normal: self.normals.at(jets.derivative, t),
        };
        vertices(&points, self.curves.radius(t), shown)
    }
}

/// Index in [`Shown::of_quarters`] of a vertex at column i of row j; `borders`: the x and y from which on other corners show.
#[inline(always)]
fn quarter(grid: &Grid, i: u32, j: u32, borders: [f32; 2]) -> usize {
    let (x, y) = (i as f32 / grid.nx as f32, j as f32 / grid.ny as f32);
    match (x >= borders[0], y >= borders[1]) {
        (false, false) => 0,
        (true, false) => 1,
        (true, true) => 2,
        (false, true) => 3,
    }
}

/// Calls `put` with column i, row j and a vertex of each, for all that are inside four lateral patches with this grid.
#[inline(always)]
pub(crate) fn lateral_vertices(
    mesh: &CoarseMesh,
    options: &RefineOptions,
    patches: [usize; 4],
    grid: &Grid,
    mut put: impl FnMut([u32; 2], [SurfaceVertex; 4]),
) {
    let corners = Corners::of_patches(mesh, four(|k| mesh.patches[patches[k]].corners));
    let shown = four(|k| Shown::of_quarters(mesh, options, patches[k]));
    let tubes = Tubes::new(&corners, options.path);
    let borders = four(|k| border_to(mesh, mesh.patches[patches[k]].corners[2], grid.ny));
    for j in 1..grid.ny {
        let y = F32x4::splat(j as f32 / grid.ny as f32);
        let (row, radius) = (tubes.row(y), tubes.radius(y));
        for i in 1..grid.nx {
            let points = row.points(F32x4::splat(i as f32 / grid.nx as f32));
            let shown = four(|k| &shown[k][quarter(grid, i, j, [0.5, borders[k]])]);
            put([i, j], vertices(&points, radius, shown));
        }
    }
}

/// The same for a patch of another kind, with one vertex.
pub(crate) fn other_vertices(
    mesh: &CoarseMesh,
    options: &RefineOptions,
    patch: usize,
    (shape, grid): (&PatchShape, &Grid),
    mut put: impl FnMut([u32; 2], SurfaceVertex),
) {
    let shown = Shown::of_quarters(mesh, options, patch);
    let mut borders = [0.5; 4];
    let middle = match shape.kind {
        PatchKind::Loft => loft_middle(mesh, &mesh.patches[patch], grid.nx),
        _ => 0.5,
    };
    shape.for_each_inside(options, [grid.nx, grid.ny], |[i, j], points, radii| {
        if shape.kind == PatchKind::Loft && j == 1 {
            let x = four(|k| (i + k as u32) as f32 / grid.nx as f32);
            borders = shape.border(F32x4::from_array(x), grid.ny).to_array();
        }
        let of = four(|k| &shown[quarter(grid, i + k as u32, j, [middle, borders[k]])]);
        for (i, vertex) in (i..grid.nx).zip(vertices(&points, radii, of)) {
            put([i, j], vertex);
        }
    });
}

/// The vertex at column i of row j inside a patch.
pub(crate) fn inner_vertex(
    mesh: &CoarseMesh,
    options: &RefineOptions,
    patch: usize,
    (shape, grid): (&PatchShape, &Grid),
    [i, j]: [u32; 2],
) -> SurfaceVertex {
    let (x, y) = (i as f32 / grid.nx as f32, j as f32 / grid.ny as f32);
    let (position, normal) = shape.interior(options, x, y);
    let of = &mesh.patches[patch];
    let borders = match shape.kind {
        PatchKind::Loft => [
            loft_middle(mesh, of, grid.nx),
            shape.border(F32x4::splat(x), grid.ny).x,
        ],
        PatchKind::Lateral => [0.5, border_to(mesh, of.corners[2], grid.ny)],
        PatchKind::Cap | PatchKind::Soma => [0.5; 2],
    };
    let shown = Shown::of_quarters(mesh, options, patch)[quarter(grid, i, j, borders)];
    shown.vertex(position, normal, shape.radius(options, x, y))
}
