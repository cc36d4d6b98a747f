//! How patches are cut into triangles.

use std::sync::LazyLock;

use neurotess_mesh::{Patch, PatchKind};

/// Cells of a patch to a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    Two,
    Four,
}

/// Facets of a patch at the highest level.
pub(super) const MAX_FACETS: usize = 32;

/// How all patches are cut into triangles.
pub(super) struct Cut {
    /// Cells of a patch to a side.
    pub(super) steps: usize,
    /// Of lateral patches: with parallel diagonals.
    parallel: Pattern,
    /// Of others: with diagonals that run towards the corners.
    fanned: Pattern,
    /// Points of the sides of a patch: from its first corner to the second, from there to the third, from the fourth
    /// to the third, from the first to the fourth.
    pub(super) sides: [Vec<usize>; 4],
    /// Points at the corners, in order, and points within.
    pub(super) corners: [usize; 4],
    pub(super) inner: Vec<usize>,
}

/// How a patch is cut into triangles; points are numbered row by row.
pub(super) struct Pattern {
    pub(super) triangles: Vec<[usize; 3]>,
    /// Triangles that share an edge.
    pub(super) within: Vec<[u32; 2]>,
    /// Triangles at each side, as its points run.
    pub(super) along: [Vec<u32>; 4],
}

impl Cut {
    /// The cut of a level: 2 or 4.
    pub(super) fn of(level: Level) -> &'static Self {
        static COARSE: LazyLock<Cut> = LazyLock::new(|| Cut::new(2));
        static FINE: LazyLock<Cut> = LazyLock::new(|| Cut::new(4));
        match level {
            Level::Two => &COARSE,
            Level::Four => &FINE,
        }
    }

    fn new(steps: usize) -> Self {
        let last = steps * (steps + 1);
        let all = 0..=steps;
        let sides = [
            all.clone().collect(),
            all.clone().map(|k| k * (steps + 1) + steps).collect(),
            all.clone().map(|k| last + k).collect(),
            all.map(|k| k * (steps + 1)).collect(),
        ];
        let inner = |k: &usize| !sides.iter().any(|side: &Vec<usize>| side.contains(k));
        Self {
            inner: (0..last + steps + 1).filter(inner).collect(),
            corners: [0, steps, last + steps, last],
            parallel: Pattern::new(steps, &sides, |_, _| false),
            fanned: Pattern::new(steps, &sides, |i, j| (2 * i < steps) != (2 * j < steps)),
            steps,
            sides,
        }
    }

    /// Facets of a patch.
    pub(super) fn facets(&self) -> usize {
        2 * self.steps * self.steps
    }

    /// Points of a patch.
    pub(super) fn points(&self) -> usize {
        (self.steps + 1) * (self.steps + 1)
    }

    pub(super) fn pattern(&self, patch: &Patch) -> &Pattern {
        match patch.kind {
            PatchKind::Lateral => &self.parallel,
            PatchKind::Cap | PatchKind::Soma | PatchKind::Loft => &self.fanned,
        }
    }
}

impl Pattern {
    /// `falls`: whether the diagonal of a cell runs from its upper left to its lower right corner.
    fn new(steps: usize, sides: &[Vec<usize>; 4], falls: impl Fn(usize, usize) -> bool) -> Self {
        let mut triangles = Vec::new();
        for (j, i) in (0..steps).flat_map(|j| (0..steps).map(move |i| (j, i))) {
            let a = j * (steps + 1) + i;
            let [b, c, d] = [a + 1, a + steps + 2, a + steps + 1];
            triangles.extend(match falls(i, j) {
                true => [[a, b, d], [b, c, d]],
                false => [[a, b, c], [a, c, d]],
            });
        }
        let has =
            |triangle: &[usize; 3], edge: [usize; 2]| edge.iter().all(|p| triangle.contains(p));
        let common = |a: usize, b: usize| {
            let corners = triangles[a].iter();
            corners
                .filter(|corner| triangles[b].contains(corner))
                .count()
        };
        let count = triangles.len();
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let within = pairs.filter(|&[a, b]| common(a, b) == 2);
        let within = within.map(|pair| pair.map(|k| k as u32)).collect();
        let at = |edge: [usize; 2]| triangles.iter().position(|triangle| has(triangle, edge));
        let along = sides.each_ref().map(|points| {
            let edges = points.windows(2).map(|edge| [edge[0], edge[1]]);
            edges.filter_map(at).map(|k| k as u32).collect()
        });
        Self {
            triangles,
            within,
            along,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_share_the_edges_that_they_are_said_to() {
        for cut in [Level::Two, Level::Four].map(Cut::of) {
            let s = cut.steps;
            for pattern in [&cut.parallel, &cut.fanned] {
                assert_eq!(pattern.triangles.len(), cut.facets());
                // Of three edges for each triangle those at the sides are of one alone.
                assert_eq!(2 * pattern.within.len(), 3 * cut.facets() - 4 * s);
                for pair in &pattern.within {
                    let [a, b] = pair.map(|k| pattern.triangles[k as usize]);
                    assert_eq!(a.iter().filter(|point| b.contains(point)).count(), 2);
                }
                for (points, along) in cut.sides.iter().zip(&pattern.along) {
                    assert_eq!(along.len(), s);
                    for (edge, &facet) in points.windows(2).zip(along) {
                        let triangle = pattern.triangles[facet as usize];
                        assert!(edge.iter().all(|point| triangle.contains(point)));
                    }
                }
            }
            assert_eq!(cut.inner.len(), cut.points() - 4 * s);
        }
    }

    #[test]
    fn round_patches_have_diagonals_towards_their_corners() {
        for cut in [Level::Two, Level::Four].map(Cut::of) {
            let of = |pattern: &Pattern, corner: &usize| {
                let at = pattern.triangles.iter().filter(|t| t.contains(corner));
                at.count()
            };
            assert_eq!(cut.corners.each_ref().map(|c| of(&cut.fanned, c)), [2; 4]);
            assert_eq!(
                cut.corners.each_ref().map(|c| of(&cut.parallel, c)),
                [2, 1, 2, 1]
            );
        }
    }
}
