//! Winding numbers by rays, exactly.
//!
//! A ray leaves a face towards +x. Its winding number there is the number of faces through which it leaves
//! the solid, less those through which it enters. Where it passes an edge or a vertex, the start counts as
//! moved by an infinitely small way along y and a smaller one along z (H. Edelsbrunner, E. Mücke,
//! Simulation of Simplicity, 1990), so that it never does; all signs are those of exact determinants.

use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord, Coord3D, orient2d, orient3d};

/// Where a ray starts.
pub(crate) struct Query {
    /// A point of a face.
    pub(crate) point: DVec3,
    /// That face, and those that coincide with it there; sorted.
    pub(crate) without: Vec<u32>,
}

/// Faces that one task looks at; by eye.
const CHUNK: usize = 1 << 13;

/// For each query the winding number just beside its point, towards +x, of all faces but those without.
///
/// Time grows with the faces, and with the queries whose rays pass their boxes.
pub(crate) fn windings(
    corners: impl Fn(u32) -> [DVec3; 3] + Sync,
    faces: usize,
    queries: &[Query],
) -> Vec<i32> {
    let mut order: Vec<usize> = (0..queries.len()).collect();
    order.sort_by(|&a, &b| queries[a].point.y.total_cmp(&queries[b].point.y));
    let rows: Vec<f64> = order.iter().map(|&n| queries[n].point.y).collect();
    let of_chunk = |chunk: usize| {
        let mut sums = Vec::new();
        for face in chunk * CHUNK..faces.min((chunk + 1) * CHUNK) {
            let triangle = corners(face as u32);
            let [low, high] = bounds(&triangle);
            let first = rows.partition_point(|&y| y < low.y);
            for (row, &query) in order.iter().enumerate().skip(first) {
                if rows[row] > high.y {
                    break;
                }
                let Query { point, without } = &queries[query];
                if point.z < low.z || point.z > high.z || point.x > high.x {
                    continue;
                }
                let passes = passes(&triangle, *point);
                if passes != 0 && without.binary_search(&(face as u32)).is_err() {
                    sums.push((query, passes));
                }
            }
        }
        sums
    };
    let sums: Vec<_> = (0..faces.div_ceil(CHUNK))
        .into_par_iter()
        .flat_map_iter(of_chunk)
        .collect();
    let mut windings = vec![0; queries.len()];
    for (query, passes) in sums {
        windings[query] += passes;
    }
    windings
}

fn bounds([a, b, c]: &[DVec3; 3]) -> [DVec3; 2] {
    [a.min(*b).min(*c), a.max(*b).max(*c)]
}

/// 1 if the ray from `point` leaves through the triangle, −1 if it enters, 0 if it misses.
fn passes(triangle: &[DVec3; 3], point: DVec3) -> i32 {
    let [a, b, c] = *triangle;
    let turns = [turn(a, b, point), turn(b, c, point), turn(c, a, point)];
    if turns[0] == 0 || turns != [turns[0]; 3] {
        return 0;
    }
    let [a, b, c, p] = [a, b, c, point].map(|p| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    });
    // Positive if the point is behind a triangle that turns counter-clockwise seen from +x.
    let behind = orient3d(a, b, c, p) * f64::from(turns[0]);
    if behind > 0.0 { turns[0] } else { 0 }
}

/// Which way a → b → p turns seen from +x, p moved a little: never 0 but if a is b.
fn turn(a: DVec3, b: DVec3, p: DVec3) -> i32 {
    let [q, r, s] = [a, b, p].map(|p| Coord { x: p.y, y: p.z });
    let exact = orient2d(q, r, s);
    let signs = [exact, a.z - b.z, b.y - a.y];
    let first = signs.into_iter().find(|&sign| sign != 0.0);
    first.map_or(0, |sign| if sign > 0.0 { 1 } else { -1 })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: [[u32; 3]; 12] = [
        [0, 2, 1],
        [0, 3, 2],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 5],
        [0, 5, 4],
        [1, 2, 6],
        [1, 6, 5],
        [2, 3, 7],
        [2, 7, 6],
        [3, 0, 4],
        [3, 4, 7],
    ];

    /// Cubes from −s to s, one in another.
    fn cubes(sizes: &[f64]) -> Vec<[DVec3; 3]> {
        let of = |size: &f64| {
            let at = |n: u32| {
                let sign = |set: bool| if set { *size } else { -*size };
                DVec3::new(
                    sign(n % 4 == 1 || n % 4 == 2),
                    sign(n % 4 >= 2),
                    sign(n >= 4),
                )
            };
            CUBE.map(|face| face.map(at))
        };
        sizes.iter().flat_map(of).collect()
    }

    #[test]
    fn rays_through_edges_and_corners_count_once() {
        let faces = cubes(&[1.0, 2.0, 3.0]);
        // Along diagonals of faces, through edges, along an edge, through a corner, beside all.
        let starts = [
            ([0.0, 0.0, 0.0], 3),
            ([0.0, 0.5, 0.5], 3),
            ([0.0, 1.0, 0.0], 2),
            ([0.0, -1.0, 0.0], 3),
            ([1.5, 1.0, 1.0], 2),
            ([0.0, 2.0, 2.0], 1),
            ([-2.5, 0.0, 0.0], 1),
            ([0.0, 3.0, 3.0], 0),
            ([4.0, 0.0, 0.0], 0),
            ([-4.0, 0.0, 0.0], 0),
        ];
        let queries: Vec<Query> = starts
            .iter()
            .map(|&(point, _)| Query {
                point: point.into(),
                without: vec![],
            })
            .collect();
        let expected: Vec<i32> = starts.iter().map(|&(_, winding)| winding).collect();
        let found = windings(|face| faces[face as usize], faces.len(), &queries);
        assert_eq!(found, expected);
    }

    #[test]
    fn an_inverted_cube_takes_one_away() {
        let mut faces = cubes(&[1.0, 2.0]);
        faces[..12].iter_mut().for_each(|face| face.swap(0, 1));
        let query = Query {
            point: DVec3::new(0.1, 0.2, 0.3),
            without: vec![],
        };
        let found = windings(|face| faces[face as usize], faces.len(), &[query]);
        assert_eq!(found, [0]);
    }
}
