//! Numbers of a patch's vertices, and its faces.

use neurotess_mesh::{CoarseMesh, Faces, PatchKind};

use super::{Grid, Plan, snap};
use crate::RefineOptions;
use crate::evaluate::SIDES;

/// Numbers of a patch's corners, of the first inner vertices of its sides' edges and of its own first inner vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Numbers {
    pub(crate) corners: [u32; 4],
    pub(crate) edges: [u32; 4],
    pub(crate) inner: u32,
}

impl Plan {
    /// Number of the vertex at column i and row j of a patch's grid. Vertices on a side are those
    /// of its edge: where the edge has fewer, several columns share one.
    pub(crate) fn vertex(
        &self,
        mesh: &CoarseMesh,
        patch: usize,
        grid: &Grid,
        [i, j]: [u32; 2],
    ) -> u32 {
        let numbers = self.numbers(mesh, patch);
        let side = |side: usize| self.side(mesh, patch, grid, &numbers, side);
        match (i, j) {
            (i, 0) => side(0).number(i),
            (i, j) if j == grid.ny => side(2).number(i),
            (0, j) => side(3).number(j),
            (i, j) if i == grid.nx => side(1).number(j),
            (i, j) => numbers.inner.wrapping_add(grid.inner(i, j) as u32),
        }
    }

    /// The numbers that a patch's vertices have in the surface.
    #[inline(always)]
    pub(crate) fn numbers(&self, mesh: &CoarseMesh, patch: usize) -> Numbers {
        let [a, b, c, d] = self.patch_edges[patch];
        let first = |edge: u32| self.edges.get(edge as usize).map_or(0, |edge| edge.first);
        Numbers {
            corners: mesh.patches[patch].corners,
            edges: [first(a), first(b), first(c), first(d)],
            inner: self.patch_first[patch],
        }
    }

    #[inline(always)]
    fn side(
        &self,
        mesh: &CoarseMesh,
        patch: usize,
        grid: &Grid,
        numbers: &Numbers,
        side: usize,
    ) -> Side {
        let (start, end) = SIDES[side];
        let edge = &self.edges[self.patch_edges[patch][side] as usize];
        let first = numbers.edges[side];
        let level = grid.levels[side];
        let (before, step) = match edge.from == mesh.patches[patch].corners[start] {
            true => (first.wrapping_sub(1), 1),
            false => (first.wrapping_add(level - 1), u32::MAX),
        };
        Side {
            ends: [numbers.corners[start], numbers.corners[end]],
            level,
            steps: [grid.nx, grid.ny][side % 2],
            before,
            step,
        }
    }

    /// Appends the faces of a patch whose vertices have these numbers. `rows`: room for all of them, to be used again.
    pub(crate) fn faces(
        &self,
        mesh: &CoarseMesh,
        options: &RefineOptions,
        patch: usize,
        numbers: &Numbers,
        rows: &mut Vec<u32>,
        out: &mut Faces,
    ) {
        let grid = self.grid(mesh, options, patch);
        if grid.nx == 0 {
            return;
        }
        if grid.nx == 1 && grid.ny == 1 {
            cell(numbers.corners, false, options.quads, out);
            return;
        }
        // Up to four cells share a vertex: its number is found once.
        self.number(mesh, patch, &grid, numbers, rows);
        let fans = mesh.patches[patch].kind != PatchKind::Lateral;
        let width = grid.nx as usize + 1;
        let is_whole = !options.quads && grid.is_whole();
        let pairs = rows.chunks(width).zip(rows[width..].chunks(width));
        for (j, (row, next)) in (0..).zip(pairs) {
            let cells = row.windows(2).zip(next.windows(2));
            let cells = cells.map(|(near, far)| [near[0], near[1], far[1], far[0]]);
            // Diagonals run towards the patch's corners on round patches, and are parallel on others.
            let falling = |i: u32| fans && ((2 * i < grid.nx) != (2 * j < grid.ny));
            if !is_whole {
                for (i, quad) in (0..).zip(cells) {
                    cell(quad, falling(i), options.quads, out);
                }
                continue;
            }
            let start = out.triangles.len();
            out.triangles.resize(start + 2 * grid.nx as usize, [0; 3]);
            let pairs = out.triangles[start..].as_chunks_mut().0;
            for ((i, quad), pair) in (0..).zip(cells).zip(pairs) {
                *pair = halves(quad, falling(i));
            }
        }
    }

    /// The numbers of all vertices of a patch's grid, row by row.
    fn number(
        &self,
        mesh: &CoarseMesh,
        patch: usize,
        grid: &Grid,
        numbers: &Numbers,
        rows: &mut Vec<u32>,
    ) {
        let side = |side: usize| self.side(mesh, patch, grid, numbers, side);
        let (near, right, far, left) = (side(0), side(1), side(2), side(3));
        let width = grid.nx as usize + 1;
        // All are written below.
        rows.resize(width * (grid.ny as usize + 1), 0);
        let (first, rest) = rows.split_at_mut(width);
        let (inner, last) = rest.split_at_mut(rest.len() - width);
        near.fill(first);
        far.fill(last);
        let mut next = numbers.inner;
        for (j, row) in (1..).zip(inner.chunks_exact_mut(width)) {
            row[0] = left.number(j);
            for number in &mut row[1..width - 1] {
                *number = next;
                next = next.wrapping_add(1);
            }
            row[width - 1] = right.number(j);
        }
    }
}

/// A patch's side with the numbers of its vertices.
struct Side {
    ends: [u32; 2],
    level: u32,
    /// Columns or rows of the patch's grid.
    steps: u32,
    /// What the number of the start would be if it were an inner vertex, and the difference to the next.
    before: u32,
    step: u32,
}

impl Side {
    /// Sets the numbers of the vertices at all columns of the patch's grid.
    #[inline(always)]
    fn fill(&self, out: &mut [u32]) {
        for (i, number) in (0..).zip(out) {
            *number = self.number(i);
        }
    }

    /// Number of the vertex at a column or row of the patch's grid.
    #[inline(always)]
    fn number(&self, place: u32) -> u32 {
        match snap(place, self.steps, self.level) {
            0 => self.ends[0],
            place if place == self.level => self.ends[1],
            place => self.before.wrapping_add(self.step.wrapping_mul(place)),
        }
    }
}

fn cell(quad: [u32; 4], falling: bool, quads: bool, out: &mut Faces) {
    let [a, b, c, d] = quad;
    let whole = a != b && b != c && c != d && d != a;
    if quads && whole {
        out.quads.push(quad);
        return;
    }
    for [p, q, r] in halves(quad, falling) {
        if p != q && q != r && r != p {
            out.triangles.push([p, q, r]);
        }
    }
}

/// The two triangles of a cell.
#[inline(always)]
fn halves([a, b, c, d]: [u32; 4], falling: bool) -> [[u32; 3]; 2] {
    if falling {
        [[a, b, d], [b, c, d]]
    } else {
        [[a, b, c], [a, c, d]]
    }
}
