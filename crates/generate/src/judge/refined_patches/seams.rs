//! Where two patches meet: which points and edges they share.

use neurotess_mesh::CoarseMesh;

use super::cut::Cut;

/// Sides that two patches share.
pub(super) struct Seams {
    /// Pairs of facets: as many of each seam as a side has cells.
    pub(super) edges: Vec<[u32; 2]>,
    steps: usize,
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
    pub(super) fn edges(&self, seam: u32) -> &[[u32; 2]] {
        &self.edges[self.steps * seam as usize..][..self.steps]
    }

    /// Adds the seam between two sides, each given as a patch with a side of it.
    fn add(&mut self, mesh: &CoarseMesh, cut: &Cut, [a, b]: [(u32, usize); 2]) {
        let seam = (self.edges.len() / self.steps) as u32;
        let first =
            |(patch, side): (u32, usize)| sides(mesh.patches[patch as usize].corners)[side].0;
        let along = |(patch, side): (u32, usize)| {
            let along = cut.pattern(&mesh.patches[patch as usize]).along[side].iter();
            along.map(move |facet| cut.facets() as u32 * patch + facet)
        };
        let edges = &mut self.edges;
        match first(a) == first(b) {
            true => edges.extend(along(a).zip(along(b)).map(<[u32; 2]>::from)),
            false => edges.extend(along(a).zip(along(b).rev()).map(<[u32; 2]>::from)),
        }
        for (patch, side) in [a, b] {
            self.by_side[patch as usize][side] = seam;
        }
    }
}

/// Sides of a patch, as its points run along them.
fn sides(c: [u32; 4]) -> [(u32, u32); 4] {
    [(c[0], c[1]), (c[1], c[2]), (c[3], c[2]), (c[0], c[3])]
}

/// Numbers of the points of all patches, patch by patch: corners first, then those of edges from the lower corner on,
/// then those within patches; and where patches meet.
pub(super) fn numbers(mesh: &CoarseMesh, cut: &Cut) -> (Vec<u32>, Seams) {
    let count = mesh.patches.len();
    let mut at: Vec<(u32, u32, u32)> = Vec::with_capacity(4 * count);
    for (patch, corners) in (0..).zip(mesh.patches.iter().map(|p| p.corners)) {
        let sides = (4 * patch..).zip(sides(corners));
        at.extend(sides.map(|(slot, (a, b))| (a.min(b), a.max(b), slot)));
    }
    at.sort_unstable();
    let mut points = vec![0; cut.points() * count];
    let mut seams = Seams {
        edges: Vec::with_capacity(2 * cut.steps * count),
        steps: cut.steps,
        by_side: vec![[NO_SEAM; 4]; count],
    };
    let mut number = mesh.vertices.len() as u32;
    for same in at.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        for &(low, _, slot) in same {
            let (patch, side) = (slot as usize / 4, slot as usize % 4);
            let points = &mut points[cut.points() * patch..][..cut.points()];
            let between = &cut.sides[side][1..cut.steps];
            let runs_up = sides(mesh.patches[patch].corners)[side].0 == low;
            for (k, number) in (0..between.len()).zip(number..) {
                let k = if runs_up { k } else { between.len() - 1 - k };
                points[between[k]] = number;
            }
        }
        for pair in same.windows(2) {
            let side = |slot: u32| (slot / 4, slot as usize % 4);
            seams.add(mesh, cut, [side(pair[0].2), side(pair[1].2)]);
        }
        number += cut.steps as u32 - 1;
    }
    for (points, patch) in points.chunks_mut(cut.points()).zip(&mesh.patches) {
        for (&place, corner) in cut.corners.iter().zip(patch.corners) {
            points[place] = corner;
        }
        for &place in &cut.inner {
            points[place] = number;
            number += 1;
        }
    }
    (points, seams)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use neurotess_refine::{RefineOptions, patch_points};

    use super::super::RefinedPatches;
    use super::super::cut::Level;
    use super::super::tests::hairpin;
    use super::*;

    /// A tube whose patches run along their common sides in both directions.
    fn turned() -> CoarseMesh {
        let mut mesh = hairpin();
        for (number, patch) in mesh.patches.iter_mut().enumerate() {
            patch.corners.rotate_left(number % 4);
        }
        mesh
    }

    #[test]
    fn a_point_has_one_number_in_all_patches_that_share_it() {
        let mesh = hairpin();
        for cut in [Level::Two, Level::Four].map(Cut::of) {
            let (numbers, _) = numbers(&mesh, cut);
            let mut at = BTreeMap::new();
            for (patch, numbers) in (0..).zip(numbers.chunks(cut.points())) {
                let mut points = Vec::new();
                let options = RefineOptions::default();
                patch_points(&mesh, &[patch], cut.steps as u32, &options, &mut points);
                for (&number, point) in numbers.iter().zip(points) {
                    assert_eq!(*at.entry(number).or_insert(point), point, "{number}");
                }
            }
            // Fifteen pieces of tube, closed around and open at the ends.
            let s = cut.steps;
            assert_eq!(at.len(), 4 * s * (15 * s + 1));
        }
    }

    #[test]
    fn facets_along_a_seam_share_an_edge() {
        for mesh in [hairpin(), turned()] {
            let all: Vec<u32> = (0..mesh.patches.len() as u32).collect();
            for level in [Level::Two, Level::Four] {
                let refined = RefinedPatches::at_level(level, &mesh, all.clone());
                // Four along the tube for each piece, and four around between two of them.
                let seams = 4 * 15 + 4 * 14;
                assert_eq!(refined.seams.edges.len(), seams * refined.cut.steps);
                for edge in &refined.seams.edges {
                    let [a, b] = edge.map(|k| refined.facets[k as usize].corners);
                    let common = a.iter().filter(|corner| b.contains(corner));
                    assert_eq!(common.count(), 2, "{edge:?}");
                }
            }
        }
    }
}
