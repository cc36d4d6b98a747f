//! Where a mesh crosses itself.
//!
//! **The rule.** A pair of faces counts if their triangles have a point in common beyond what they
//! share as neighbors. Quads are two triangles, split along the diagonal from their first corner,
//! and no pair with each other. Corners are the same if their index is, or their position bit for
//! bit, so that a file that repeats its vertices (STL) has the neighbors that it shows.
//!
//! | corners shared | the pair counts if |
//! | --- | --- |
//! | none | the closed triangles meet: touching counts |
//! | one | the edge opposite to it, of one, meets the other |
//! | two | they lie in one plane and on the same side of the edge (folded over) |
//! | three | always: they are the same triangle |
//!
//! Triangles without an area have no part in it; they are degenerate already.
//!
//! **What it costs.** Time grows with the faces and with the pairs of boxes that overlap. Of a real mesh
//! those are some tens for each face; but thousands of pieces in one place are all within one another, and
//! 300,000 of them would take hours. So a [`Search`] stops when it has found more pairs than there are faces
//! (and than a million), or has looked at 256 pairs of boxes for each triangle; then what it has is "at
//! least". Batches of the tree's blocks are searched in order, and their size depends on what was found
//! before and on nothing else: an unfinished search is the same on every machine.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::bvh::{Bounds, Bvh};
use crate::crossing::{fans_meet, folded, has_area, triangles_meet};
use crate::weld::first_alike;
use crate::{Faces, SurfaceMesh, Watch};

impl SurfaceMesh {
    /// See [`self_intersections`].
    pub fn self_intersections(&self) -> Vec<[u32; 2]> {
        self_intersections(&self.positions(), &self.faces)
    }
}

/// Pairs of faces that cross, each once, lower number first, sorted. Faces are numbered triangles
/// first, then quads: face `triangles.len() + n` is quad `n`.
///
/// Time grows with the faces and with the pairs found: a million triangles take about a second.
/// Panics if a face names a vertex that is not there.
pub fn self_intersections(positions: &[Vec3], faces: &Faces) -> Vec<[u32; 2]> {
    search(positions, faces, Limits::NONE, &Watch::default()).pairs
}

/// Those pairs of [`self_intersections`] that have at least one of the `chosen` faces. What changed a few
/// faces of a mesh without crossings looks at these only: time grows with all faces, but a tenth as fast as
/// that of a search among all.
///
/// Panics if a face names a vertex that is not there.
pub fn self_intersections_of(positions: &[Vec3], faces: &Faces, chosen: &[u32]) -> Vec<[u32; 2]> {
    let count = faces.triangles.len();
    let mut is_chosen = vec![false; count + faces.quads.len()];
    for &face in chosen {
        is_chosen[face as usize] = true;
    }
    let corners = |corners: [u32; 3]| corners.map(|corner| positions[corner as usize]);
    let halves = |face: u32| -> [Option<[Vec3; 3]>; 2] {
        match (face as usize).checked_sub(count) {
            None => [Some(corners(faces.triangles[face as usize])), None],
            Some(quad) => {
                let [a, b, c, d] = faces.quads[quad];
                [[a, b, c], [a, c, d]].map(|half| Some(corners(half)))
            }
        }
    };
    let sound = |face: u32| {
        let of = halves(face).into_iter().flatten();
        of.filter(|half| is_sound(&half.map(Vec3::as_dvec3)))
            .map(move |half| (face, half))
    };
    let few: Vec<(u32, [Vec3; 3])> = (0..is_chosen.len() as u32)
        .into_par_iter()
        .filter(|&face| is_chosen[face as usize])
        .flat_map_iter(sound)
        .collect();
    let boxes: Vec<Bounds> = few.par_iter().map(|&(_, half)| Bounds::of(half)).collect();
    let tree = Bvh::new(&boxes);
    let of_face = |face: u32| {
        let mut found = Vec::new();
        for half in halves(face).into_iter().flatten() {
            let bounds = Bounds::of(half);
            tree.overlaps_of(&bounds, |n| {
                let (other, theirs) = few[n as usize];
                // Of two chosen ones, the lower finds the pair.
                let twice = is_chosen[face as usize] && other <= face;
                if !twice && is_sound(&half.map(Vec3::as_dvec3)) && cross(half, theirs) {
                    found.push([face.min(other), face.max(other)]);
                }
                true
            });
        }
        found
    };
    let all = 0..is_chosen.len() as u32;
    let mut pairs: Vec<[u32; 2]> = all.into_par_iter().flat_map_iter(of_face).collect();
    pairs.par_sort_unstable();
    pairs.dedup();
    pairs
}

/// Like [`self_intersections`], in a time that grows with the faces whatever their places.
pub fn search_self_intersections(positions: &[Vec3], faces: &Faces) -> Search {
    search_self_intersections_watched(positions, faces, &Watch::default())
}

/// [`search_self_intersections`], which ends soon, incomplete, once it is stopped.
pub fn search_self_intersections_watched(
    positions: &[Vec3],
    faces: &Faces,
    watch: &Watch<'_>,
) -> Search {
    search(positions, faces, Limits::of(faces), watch)
}

/// What a search has found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Search {
    /// Pairs of faces that cross, as [`self_intersections`] gives them.
    pub pairs: Vec<[u32; 2]>,
    /// Whether these are all.
    pub complete: bool,
    /// How many pairs of overlapping boxes were looked at.
    pub looked_at: u64,
}

/// When a search stops.
#[derive(Clone, Copy, Debug)]
struct Limits {
    pairs: usize,
    looked_at: u64,
}

impl Limits {
    const NONE: Self = Self {
        pairs: usize::MAX,
        looked_at: u64::MAX,
    };
    /// Fewest pairs, and fewest looks: some tenths of a second.
    const LEAST: Self = Self {
        pairs: 1_000_000,
        looked_at: 10_000_000,
    };
    /// Looks for each triangle. Real meshes need about 20, needles in a tangle some hundred.
    const LOOKS: u64 = 256;

    fn of(faces: &Faces) -> Self {
        let triangles = faces.triangles.len() + 2 * faces.quads.len();
        let looks = Self::LOOKS * triangles as u64;
        Self {
            pairs: triangles.max(Self::LEAST.pairs),
            looked_at: looks.max(Self::LEAST.looked_at),
        }
    }
}

/// Most blocks in a batch; the first has one. Enough for many threads, few enough to stop soon.
const MAX_BATCH: u64 = 256;

fn search(positions: &[Vec3], faces: &Faces, limits: Limits, watch: &Watch<'_>) -> Search {
    let triangles = triangles(positions, faces);
    let boxes: Vec<Bounds> = triangles
        .par_iter()
        .map(|triangle| Bounds::of(triangle.corners.map(|corner| positions[corner as usize])))
        .collect();
    let tree = Bvh::new(&boxes);
    let of_block = |block: usize| {
        let (mut pairs, mut looked_at) = (Vec::new(), 0);
        tree.overlaps_of_block(block, |a, b| {
            looked_at += 1;
            let (a, b) = (&triangles[a as usize], &triangles[b as usize]);
            if a.face != b.face && a.crosses(b, positions) {
                pairs.push([a.face.min(b.face), a.face.max(b.face)]);
            }
        });
        (pairs, looked_at)
    };
    let joined = |mut a: (Vec<[u32; 2]>, u64), b: (Vec<[u32; 2]>, u64)| {
        a.0.extend(b.0);
        (a.0, a.1 + b.1)
    };
    let (mut pairs, mut looked_at) = (Vec::new(), 0);
    let blocks = tree.block_count();
    let (mut next, mut batch) = (0, 1);
    let within =
        |pairs: &[_], looked_at| pairs.len() < limits.pairs && looked_at < limits.looked_at;
    while next < blocks && within(&pairs, looked_at) && !watch.is_stopped() {
        let end = blocks.min(next + batch);
        let found = (next..end)
            .into_par_iter()
            .map(of_block)
            .reduce(Default::default, joined);
        (pairs, looked_at) = joined((pairs, looked_at), found);
        next = end;
        // As many as what is left allows, if they are like those before.
        let each = looked_at / next as u64 + 1;
        batch = ((limits.looked_at - looked_at.min(limits.looked_at)) / each).clamp(1, MAX_BATCH)
            as usize;
    }
    pairs.par_sort_unstable();
    pairs.dedup();
    Search {
        pairs,
        complete: next == blocks,
        looked_at,
    }
}

/// Whether a triangle has a part in all this: it is finite and has an area.
fn is_sound(corners: &[DVec3; 3]) -> bool {
    corners.iter().all(|corner| corner.is_finite()) && has_area(corners)
}

/// A triangle of a face.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [u32; 3],
    face: u32,
}

/// Triangles of all faces that have an area, corners at one position being one.
fn triangles(positions: &[Vec3], faces: &Faces) -> Vec<Triangle> {
    let first = first_alike(positions);
    let make = |face: usize, corners: [u32; 3]| {
        let corners = corners.map(|corner| first[corner as usize]);
        let points = corners.map(|corner| positions[corner as usize].as_dvec3());
        is_sound(&points).then_some(Triangle {
            corners,
            face: face as u32,
        })
    };
    let count = faces.triangles.len();
    let triangles = faces
        .triangles
        .par_iter()
        .enumerate()
        .filter_map(|(n, &face)| make(n, face));
    let quads = faces
        .quads
        .par_iter()
        .enumerate()
        .flat_map_iter(|(n, &[a, b, c, d])| {
            [make(count + n, [a, b, c]), make(count + n, [a, c, d])]
                .into_iter()
                .flatten()
        });
    triangles.chain(quads).collect()
}

impl Triangle {
    fn crosses(&self, other: &Self, positions: &[Vec3]) -> bool {
        let mut a = self.corners;
        let mut b = other.corners;
        let shared = shared_first(&mut a, &mut b);
        let at = |corner: u32| -> DVec3 { positions[corner as usize].as_dvec3() };
        meet(shared, &a.map(at), &b.map(at))
    }
}

/// Whether two triangles cross, their corners told apart by their positions.
fn cross(mut a: [Vec3; 3], mut b: [Vec3; 3]) -> bool {
    let shared = shared_first(&mut a, &mut b);
    meet(shared, &a.map(Vec3::as_dvec3), &b.map(Vec3::as_dvec3))
}

/// Whether two triangles meet beyond their first corners, which they share.
fn meet(shared: usize, a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    match shared {
        0 => triangles_meet(a, b),
        1 => fans_meet(a, b),
        2 => folded(a, b),
        _ => true,
    }
}

/// Moves the corners that both have to the front, in the same order; returns how many.
fn shared_first<C: Copy + PartialEq>(a: &mut [C; 3], b: &mut [C; 3]) -> usize {
    let mut shared = 0;
    for n in 0..3 {
        if let Some(m) = (shared..3).find(|&m| b[m] == a[n]) {
            a.swap(n, shared);
            b.swap(m, shared);
            shared += 1;
        }
    }
    shared
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;

    /// Tetrahedra whose first corners are at these places.
    fn pieces(places: impl Iterator<Item = (Vec3, f32)>) -> (Vec<Vec3>, Faces) {
        let (mut positions, mut faces) = (Vec::new(), Faces::default());
        for (place, size) in places {
            let b = positions.len() as u32;
            let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
            positions.extend(corners.map(|corner| place + size * corner));
            let sides = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
            faces
                .triangles
                .extend(sides.map(|side| side.map(|c| b + c)));
        }
        (positions, faces)
    }

    fn looks((positions, faces): &(Vec<Vec3>, Faces)) -> (u64, bool) {
        let triangles = faces.triangles.len();
        let limits = Limits {
            pairs: triangles,
            looked_at: Limits::LOOKS * triangles as u64,
        };
        let found = search(positions, faces, limits, &Watch::default());
        (found.looked_at, found.complete)
    }

    #[test]
    fn work_grows_with_the_pieces_wherever_they_are() {
        let in_a_row = |n: u32| pieces((0..n).map(|i| (i as f32 * Vec3::X, 0.4)));
        // All within one another: none crosses another, and all boxes overlap.
        let nested = |n: u32| {
            let size = |i: u32| 1.0 + i as f32;
            pieces((0..n).map(move |i| (-0.2 * size(i) * Vec3::ONE, size(i))))
        };
        let in_one_place = |n: u32| pieces((0..n).map(|_| (Vec3::ZERO, 1.0)));
        let scenes: [&dyn Fn(u32) -> (Vec<Vec3>, Faces); 3] = [&in_a_row, &nested, &in_one_place];
        for (number, scene) in scenes.into_iter().enumerate() {
            let ((one, complete), (two, _)) = (looks(&scene(2000)), looks(&scene(4000)));
            assert!(
                two as f64 <= 2.5 * one as f64,
                "scene {number}: {one} then {two}"
            );
            assert_eq!(complete, number == 0, "scene {number}");
        }
    }

    #[test]
    fn a_search_that_ends_early_is_a_part_of_the_whole_one() {
        let (positions, faces) = pieces((0..60).map(|i| (i as f32 * 0.01 * Vec3::X, 1.0)));
        let all = self_intersections(&positions, &faces);
        let some = search(
            &positions,
            &faces,
            Limits {
                pairs: 10,
                looked_at: u64::MAX,
            },
            &Watch::default(),
        );
        let whole = search_self_intersections(&positions, &faces);
        assert!(whole.complete && whole.pairs == all);
        assert!(
            some.pairs
                .iter()
                .all(|pair| all.binary_search(pair).is_ok())
        );
    }

    #[test]
    fn another_thread_can_stop_a_search() {
        let (positions, faces) = pieces((0..60).map(|i| (i as f32 * 0.01 * Vec3::X, 1.0)));
        let found = |stopped| {
            let stopped = AtomicBool::new(stopped);
            search_self_intersections_watched(&positions, &faces, &Watch::stopped_by(&stopped))
        };
        let stopped = found(true);
        assert!(!stopped.complete && stopped.looked_at == 0 && stopped.pairs.is_empty());
        assert_eq!(found(false), search_self_intersections(&positions, &faces));
    }

    #[test]
    fn pairs_of_chosen_faces_are_those_of_all_that_name_one() {
        let (positions, faces) = pieces((0..60).map(|i| (i as f32 * 0.3 * Vec3::X, 1.0)));
        let all = self_intersections(&positions, &faces);
        let chosen = [3, 4, 100, 101, 239];
        let expected: Vec<[u32; 2]> = all
            .iter()
            .filter(|pair| pair.iter().any(|face| chosen.contains(face)))
            .copied()
            .collect();
        assert!(!expected.is_empty() && expected.len() < all.len());
        assert_eq!(self_intersections_of(&positions, &faces, &chosen), expected);
        assert!(self_intersections_of(&positions, &faces, &[]).is_empty());
    }
}
