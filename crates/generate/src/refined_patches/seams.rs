//! How patches are cut into triangles, and where two of them meet: which points and edges they share.

use neurotess_mesh::{CoarseMesh, Patch, PatchKind};

/// Facets of a patch.
pub(super) const FACETS: usize = 8;
/// Points of a patch.
pub(super) const POINTS: usize = 9;

/// How a patch is cut into triangles; points are numbered row by row.
pub(super) struct Pattern {
    pub(super) triangles: [[usize; 3]; FACETS],
    /// Triangles that share an edge.
    pub(super) within: [[u32; 2]; FACETS],
    /// Triangles at the two halves of each side, in the order of [`sides`].
    along: [[u32; 2]; 4],
}

/// With parallel diagonals.
const PARALLEL: Pattern = Pattern {
    triangles: [
        [0, 1, 4],
        [0, 4, 3],
        [1, 2, 5],
        [1, 5, 4],
        [3, 4, 7],
        [3, 7, 6],
        [4, 5, 8],
        [4, 8, 7],
    ],
    within: [
        [0, 1],
        [0, 3],
        [2, 3],
        [1, 4],
        [4, 5],
        [3, 6],
        [6, 7],
        [4, 7],
    ],
    along: [[0, 2], [2, 6], [5, 7], [1, 5]],
};
/// With diagonals that run towards the corners.
const FANNED: Pattern = Pattern {
    triangles: [
        [0, 1, 4],
        [0, 4, 3],
        [1, 2, 4],
        [2, 5, 4],
        [3, 4, 6],
        [4, 7, 6],
        [4, 5, 8],
        [4, 8, 7],
    ],
    within: [
        [0, 1],
        [0, 2],
        [2, 3],
        [3, 6],
        [6, 7],
        [5, 7],
        [4, 5],
        [1, 4],
    ],
    along: [[0, 2], [3, 6], [5, 7], [1, 4]],
};
/// Points of the sides of a patch, in the order of [`sides`].
const SIDES: [[usize; 3]; 4] = [[0, 1, 2], [2, 5, 8], [6, 7, 8], [0, 3, 6]];

impl Pattern {
    pub(super) fn of(patch: &Patch) -> &'static Self {
        match patch.kind {
            PatchKind::Lateral => &PARALLEL,
            PatchKind::Cap | PatchKind::Soma | PatchKind::Loft => &FANNED,
        }
    }
}

/// Sides that two patches share.
pub(super) struct Seams {
    /// Pairs of facets: two of each seam.
    pub(super) edges: Vec<[u32; 2]>,
    /// Numbers of the seams by patch and side; [`NO_SEAM`] where no other patch is.
    by_side: Vec<[u32; 4]>,
}

/// No other patch is at a side.
const NO_SEAM: u32 = u32::MAX;

impl Seams {
    /// Seams of a patch.
    pub(super) fn of(&self, patch: u32) -> impl Iterator<Item = u32> {
        let sides = self.by_side[patch as usize].into_iter();
        sides.filter(|&seam| seam != NO_SEAM)
    }

    /// Pairs of facets along a seam.
    pub(super) fn edges(&self, seam: u32) -> [[u32; 2]; 2] {
        [0, 1].map(|half| self.edges[2 * seam as usize + half])
    }

    /// Adds the seam between two sides, each given as a patch with a side of it.
    fn add(&mut self, mesh: &CoarseMesh, [a, b]: [(u32, usize); 2]) {
        let seam = self.edges.len() as u32 / 2;
        let first =
            |(patch, side): (u32, usize)| sides(mesh.patches[patch as usize].corners)[side].0;
        let along = |(patch, side): (u32, usize)| {
            let halves = Pattern::of(&mesh.patches[patch as usize]).along[side];
            halves.map(|facet| FACETS as u32 * patch + facet)
        };
        let ([a0, a1], mut others) = (along(a), along(b));
        if first(a) != first(b) {
            others.reverse();
        }
        self.edges.extend([[a0, others[0]], [a1, others[1]]]);
        for (patch, side) in [a, b] {
            self.by_side[patch as usize][side] = seam;
        }
    }
}

/// Sides of a patch, as its points run along them.
fn sides(c: [u32; 4]) -> [(u32, u32); 4] {
    [(c[0], c[1]), (c[1], c[2]), (c[3], c[2]), (c[0], c[3])]
}

/// Numbers of the points of each patch: corners first, then the middles of edges, then those of patches;
/// and where patches meet.
pub(super) fn numbers(mesh: &CoarseMesh) -> (Vec<[u32; POINTS]>, Seams) {
    let count = mesh.patches.len();
    let mut at: Vec<(u32, u32, u32)> = Vec::with_capacity(4 * count);
    for (patch, corners) in (0..).zip(mesh.patches.iter().map(|p| p.corners)) {
        let sides = (4 * patch..).zip(sides(corners));
        at.extend(sides.map(|(slot, (a, b))| (a.min(b), a.max(b), slot)));
    }
    at.sort_unstable();
    let mut points = vec![[0; POINTS]; count];
    let mut seams = Seams {
        edges: Vec::with_capacity(4 * count),
        by_side: vec![[NO_SEAM; 4]; count],
    };
    let mut number = mesh.vertices.len() as u32;
    for same in at.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        for slot in same.iter().map(|&(_, _, slot)| slot as usize) {
            points[slot / 4][SIDES[slot % 4][1]] = number;
        }
        for pair in same.windows(2) {
            let side = |slot: u32| (slot / 4, slot as usize % 4);
            seams.add(mesh, [side(pair[0].2), side(pair[1].2)]);
        }
        number += 1;
    }
    for ((points, patch), inner) in points.iter_mut().zip(&mesh.patches).zip(number..) {
        let [a, b, c, d] = patch.corners;
        (points[0], points[2], points[8], points[6]) = (a, b, c, d);
        points[4] = inner;
    }
    (points, seams)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_say_which_triangles_share_edges() {
        for pattern in [&PARALLEL, &FANNED] {
            let has = |triangle: usize, edge: [usize; 2]| {
                edge.iter()
                    .all(|point| pattern.triangles[triangle].contains(point))
            };
            let mut within: Vec<[u32; 2]> = Vec::new();
            for (a, b) in (0..FACETS).flat_map(|a| (a + 1..FACETS).map(move |b| (a, b))) {
                let common = pattern.triangles[a].iter().filter(|p| has(b, [**p; 2]));
                if common.count() == 2 {
                    within.push([a as u32, b as u32]);
                }
            }
            let mut said = pattern.within.map(|[a, b]| [a.min(b), a.max(b)]);
            said.sort_unstable();
            assert_eq!(within, said);
            for (points, halves) in SIDES.iter().zip(pattern.along) {
                for (edge, half) in points.windows(2).zip(halves) {
                    assert!(has(half as usize, [edge[0], edge[1]]));
                }
            }
        }
    }
}
