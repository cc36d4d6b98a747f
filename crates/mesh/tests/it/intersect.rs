//! Self-intersections: known cases, and against testing every pair.

use glam::{DVec3, Vec3};
use neurotess_mesh::{Faces, self_intersections, self_intersections_of};
use proptest::prelude::*;

fn pairs(points: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let points: Vec<Vec3> = points.iter().copied().map(Vec3::from).collect();
    self_intersections(
        &points,
        &Faces {
            triangles: triangles.to_vec(),
            quads: vec![],
        },
    )
}

const FLOOR: [[f32; 3]; 3] = [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]];
const TWO: [[u32; 3]; 2] = [[0, 1, 2], [3, 4, 5]];

fn floor_and(other: [[f32; 3]; 3]) -> usize {
    pairs(&[FLOOR, other].concat(), &TWO).len()
}

#[neurotess_testing::test]
fn crossing_triangles_are_a_pair() {
    assert_eq!(floor_and([[1., 1., -1.], [1., 1., 1.], [9., 9., 1.]]), 1);
    assert_eq!(floor_and([[1., 1., 1.], [1., 1., 2.], [9., 9., 1.]]), 0);
    assert_eq!(floor_and([[3., 3., -1.], [3., 3., 1.], [9., 9., 1.]]), 0);
}

#[neurotess_testing::test]
fn touching_counts() {
    assert_eq!(
        floor_and([[1., 1., 0.], [1., 1., 2.], [2., 1., 2.]]),
        1,
        "corner in face"
    );
    assert_eq!(
        floor_and([[2., 0., 0.], [2., -1., 2.], [2., -1., 1.]]),
        1,
        "corner on edge"
    );
    assert_eq!(
        floor_and([[0., 0., 0.], [-1., 0., 2.], [-1., 1., 2.]]),
        0,
        "the same corner"
    );
}

#[neurotess_testing::test]
fn coplanar_overlap_is_a_pair() {
    assert_eq!(
        floor_and([[1., 1., 0.], [5., 1., 0.], [1., 5., 0.]]),
        1,
        "edges cross"
    );
    assert_eq!(
        floor_and([[1., 1., 0.], [2., 1., 0.], [1., 2., 0.]]),
        1,
        "inside"
    );
    assert_eq!(
        floor_and([[-9., -9., 0.], [90., -9., 0.], [-9., 90., 0.]]),
        1,
        "around"
    );
    assert_eq!(
        floor_and([[3., 3., 0.], [5., 3., 0.], [3., 5., 0.]]),
        0,
        "beside"
    );
}

#[neurotess_testing::test]
fn triangles_that_share_a_vertex_count_if_one_pierces_the_other() {
    let with = |c: [f32; 3], d: [f32; 3]| {
        pairs(
            &[FLOOR[0], FLOOR[1], FLOOR[2], c, d],
            &[[0, 1, 2], [3, 0, 4]],
        )
        .len()
    };
    assert_eq!(with([1., 1., -1.], [1., 1., 1.]), 1);
    assert_eq!(
        with([5., 5., -1.], [5., 5., 1.]),
        1,
        "their edge is pierced by ours"
    );
    assert_eq!(with([-1., 1., -1.], [-1., 1., 1.]), 0);
    assert_eq!(
        with([1., 1., 0.], [-1., 3., 0.]),
        1,
        "coplanar sectors overlap"
    );
    assert_eq!(
        with([-1., -1., 0.], [-1., -3., 0.]),
        0,
        "coplanar sectors apart"
    );
}

#[neurotess_testing::test]
fn triangles_that_share_an_edge_count_if_folded_over() {
    let with =
        |d: [f32; 3]| pairs(&[FLOOR[0], FLOOR[1], FLOOR[2], d], &[[0, 1, 2], [1, 0, 3]]).len();
    assert_eq!(with([1., 1., 0.]), 1);
    assert_eq!(with([1., -1., 0.]), 0);
    assert_eq!(with([1., 1., 0.001]), 0);
}

#[neurotess_testing::test]
fn duplicate_faces_are_a_pair_and_degenerate_ones_none() {
    assert_eq!(pairs(&FLOOR, &[[0, 1, 2], [1, 2, 0]]).len(), 1);
    assert_eq!(floor_and([[1., 1., -1.], [1., 1., 0.], [1., 1., 1.]]), 0);
    assert_eq!(
        floor_and([[f32::NAN, 1., -1.], [1., 1., 0.], [1., 2., 1.]]),
        0
    );
}

#[neurotess_testing::test]
fn quads_are_numbered_after_triangles_and_count_once() {
    let mut points: Vec<Vec3> = FLOOR.iter().copied().map(Vec3::from).collect();
    let quad = [[1., -1., -1.], [1., 5., -1.], [1., 5., 1.], [1., -1., 1.]];
    points.extend(quad.map(Vec3::from));
    let faces = Faces {
        triangles: vec![[0, 1, 2]],
        quads: vec![[3, 4, 5, 6]],
    };
    assert_eq!(self_intersections(&points, &faces), [[0, 1]]);
    assert!(self_intersections(&points, &Faces::default()).is_empty());
}

/// A sphere of triangles.
fn sphere(center: Vec3, rings: u32, points: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>) {
    let first = points.len() as u32;
    let sides = 2 * rings;
    for ring in 1..rings {
        for side in 0..sides {
            let (theta, phi) = (ring as f32 / rings as f32, side as f32 / rings as f32);
            let ((st, ct), (sp, cp)) = (
                (theta * std::f32::consts::PI).sin_cos(),
                (phi * std::f32::consts::PI).sin_cos(),
            );
            points.push(center + Vec3::new(st * cp, st * sp, ct));
        }
    }
    let (north, south) = (points.len() as u32, points.len() as u32 + 1);
    points.extend([center + Vec3::Z, center - Vec3::Z]);
    let at = |ring: u32, side: u32| first + (ring - 1) * sides + side % sides;
    for side in 0..sides {
        triangles.push([north, at(1, side), at(1, side + 1)]);
        triangles.push([south, at(rings - 1, side + 1), at(rings - 1, side)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, side), at(ring + 1, side)];
            let [c, d] = [at(ring + 1, side + 1), at(ring, side + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
}

/// Every pair, by another method: an edge of one passes through the other (Möller and Trumbore,
/// Fast, Minimum Storage Ray/Triangle Intersection, 1997). For triangles in general position.
fn every_pair(points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let corners = |n: usize| triangles[n].map(|corner| points[corner as usize].as_dvec3());
    let mut pairs = Vec::new();
    for a in 0..triangles.len() {
        for b in a + 1..triangles.len() {
            let shared = triangles[a]
                .iter()
                .filter(|corner| triangles[b].contains(corner))
                .count();
            let (ta, tb) = (corners(a), corners(b));
            let passes = |t: &[DVec3; 3], u: &[DVec3; 3]| {
                (0..3).any(|n| passes_through(t[n], t[(n + 1) % 3], u))
            };
            if shared == 0 && (passes(&ta, &tb) || passes(&tb, &ta)) {
                pairs.push([a as u32, b as u32]);
            }
        }
    }
    pairs
}

fn passes_through(p: DVec3, q: DVec3, &[a, b, c]: &[DVec3; 3]) -> bool {
    let (ray, ab, ac, from) = (q - p, b - a, c - a, p - a);
    let across = ray.cross(ac);
    let scale = 1.0 / ab.dot(across);
    let (u, around) = (from.dot(across) * scale, from.cross(ab));
    let (v, t) = (ray.dot(around) * scale, ac.dot(around) * scale);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)
}

#[neurotess_testing::test]
fn interpenetrating_spheres_cross_as_every_pair_says() {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    sphere(Vec3::ZERO, 12, &mut points, &mut triangles);
    let alone = Faces {
        triangles: triangles.clone(),
        quads: vec![],
    };
    assert!(self_intersections(&points, &alone).is_empty());
    sphere(
        Vec3::new(0.731, 0.317, 0.213),
        13,
        &mut points,
        &mut triangles,
    );
    let expected = every_pair(&points, &triangles);
    assert!(expected.len() > 50);
    let found = self_intersections(
        &points,
        &Faces {
            triangles,
            quads: vec![],
        },
    );
    assert_eq!(found, expected);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[neurotess_testing::test]
    fn soups_cross_as_every_pair_says(
        corners in prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 3..180),
        size in 0.1f32..1.0,
    ) {
        let points: Vec<Vec3> = corners
            .chunks_exact(3)
            .flat_map(|t| {
                let at = Vec3::from(t[0]);
                [at, at + Vec3::from(t[1]) * size, at + Vec3::from(t[2]) * size]
            })
            .collect();
        let triangles: Vec<_> =
            (0..points.len() as u32 / 3).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect();
        let expected = every_pair(&points, &triangles);
        prop_assert_eq!(self_intersections(&points, &Faces { triangles, quads: vec![] }), expected);
    }

    /// On a coarse lattice everything touches, overlaps and repeats: the tree must lose no pair.
    #[neurotess_testing::test]
    fn lattice_soups_cross_pair_by_pair(
        points in prop::collection::vec(prop::array::uniform3(0i8..4), 4..40),
        picks in prop::collection::vec(prop::array::uniform3(0usize..40), 1..40),
    ) {
        let points: Vec<Vec3> =
            points.iter().map(|p| Vec3::from(p.map(f32::from))).collect();
        let triangles: Vec<[u32; 3]> =
            picks.iter().map(|t| t.map(|n| (n % points.len()) as u32)).collect();
        let mut expected = Vec::new();
        for a in 0..triangles.len() {
            for b in a + 1..triangles.len() {
                let two = Faces { triangles: vec![triangles[a], triangles[b]], quads: vec![] };
                if !self_intersections(&points, &two).is_empty() {
                    expected.push([a as u32, b as u32]);
                }
            }
        }
        let faces = Faces { triangles, quads: vec![] };
        prop_assert_eq!(&self_intersections(&points, &faces), &expected);
        let chosen: Vec<u32> = (0..faces.triangles.len() as u32).filter(|n| n % 3 == 0).collect();
        expected.retain(|pair| pair.iter().any(|face| chosen.contains(face)));
        prop_assert_eq!(self_intersections_of(&points, &faces, &chosen), expected);
    }
}
