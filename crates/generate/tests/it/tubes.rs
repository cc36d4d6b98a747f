//! Tubes that bend more tightly than they are thick, jump in thickness, or fork at acute angles: refined,
//! they neither fold over nor cross themselves, or far less than the rings as traced would.

use crate::branches::add;
use glam::{Vec3, vec3};
use neurotess_generate::{GenerateOptions, Generated, generate};
use neurotess_mesh::{SurfaceMesh, self_intersections, topology};
use neurotess_morphology::{Attachment, Morphology, SectionId};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use proptest::prelude::*;

fn path(points: &[(Vec3, f32)]) -> Morphology {
    let mut m = Morphology::default();
    add(&mut m, Attachment::Free, points.iter().copied());
    m
}

/// A straight way in and out, with points that go to and fro across it.
fn zigzag(step: f32, width: f32) -> Morphology {
    let mut points = vec![(vec3(-8.0, 0.0, 0.0), 1.0), (vec3(-4.0, 0.0, 0.0), 1.0)];
    points.extend((0..8).map(|i| {
        let side = if i % 2 == 0 { width } else { -width };
        (vec3(step * i as f32, side, 0.2 * side), 1.0)
    }));
    let end = 8.0 * step;
    points.extend([4.0, 8.0].map(|d| (vec3(end + d, 0.0, 0.0), 1.0)));
    path(&points)
}

/// There and back, so far apart.
fn hairpin(apart: f32, length: f32) -> Morphology {
    let there = (0..5).map(|i| vec3(length * i as f32, 0.0, 0.0));
    let back = (0..5).map(|i| vec3(length * (4 - i) as f32, apart * (1.0 + i as f32), 0.3));
    let points: Vec<(Vec3, f32)> = there.chain(back).map(|p| (p, 1.0)).collect();
    path(&points)
}

/// Radii that jump from sample to sample, on a path that bends a little.
fn jumps(step: f32, thick: f32) -> Morphology {
    let points: Vec<(Vec3, f32)> = (0..12)
        .map(|i| {
            let along = step * i as f32;
            let radius = if i % 3 == 1 { thick } else { 0.3 };
            (vec3(along, 0.4 * (1.7 * along).sin(), 0.0), radius)
        })
        .collect();
    path(&points)
}

/// A trunk that forks into two at this angle (radians), with points so far apart.
fn acute_fork(angle: f32, step: f32) -> Morphology {
    let trunk: Vec<(Vec3, f32)> = (0..4)
        .map(|i| (vec3(4.0 * i as f32, 0.0, 0.0), 1.0))
        .collect();
    let mut m = path(&trunk);
    for side in [0.5, -0.5] {
        let (sin, cos) = (side * angle).sin_cos();
        let points: Vec<(Vec3, f32)> = (1..14)
            .map(|i| {
                (
                    vec3(12.0 + step * i as f32 * cos, step * i as f32 * sin, 0.0),
                    0.8,
                )
            })
            .collect();
        add(&mut m, Attachment::Section(SectionId(0)), points);
    }
    m
}

/// Crossing pairs and folded edges at a level.
fn faults(generated: &Generated, level: u32) -> usize {
    let level = LodCriterion::Homogeneous(level);
    let refined = Refinement::new(&generated.mesh, level, &RefineOptions::default());
    let surface = SurfaceMesh::collect(&refined);
    let positions: Vec<Vec3> = surface.vertices.iter().map(|v| v.position).collect();
    let topology = topology(&positions, &surface.faces);
    assert!(topology.closed && topology.oriented && topology.vertex_manifold);
    let triangles = &surface.faces.triangles;
    let normal = |t: usize| {
        let [a, b, c] = triangles[t].map(|v| positions[v as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let mut edges = Vec::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), t));
        }
    }
    edges.sort_unstable();
    let folded = |pair: &&[(u32, u32, usize)]| normal(pair[0].2).dot(normal(pair[1].2)) < -0.5;
    let folds = edges.chunks(2).filter(folded).count();
    self_intersections(&positions, &surface.faces).len() + folds
}

fn made(morphology: &Morphology) -> Generated {
    generate(morphology, &GenerateOptions::default()).expect("meshed")
}

/// Volume inside (µm³) at level 4.
fn volume(generated: &Generated) -> f32 {
    let level = LodCriterion::Homogeneous(4);
    let refined = Refinement::new(&generated.mesh, level, &RefineOptions::default());
    let surface = SurfaceMesh::collect(&refined);
    let corners = surface.faces.triangles.iter();
    let corners = corners.map(|t| t.map(|v| surface.vertices[v as usize].position));
    corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// Points a seventh of a radius apart, as voxels are, whose radii vary by 30 %: kept as they came, they hold 10 % less.
#[neurotess_testing::test]
fn dense_points_show_their_mean_thickness() {
    let radius = |i: usize| 1.0 + 0.3 * (2.4 * i as f32).sin();
    let tube = |radius: &dyn Fn(usize) -> f32| {
        let points: Vec<(Vec3, f32)> = (0..240)
            .map(|i| (vec3(0.15 * i as f32, 0.0, 0.0), radius(i)))
            .collect();
        made(&path(&points))
    };
    let square = (0..240).map(|i| radius(i).powi(2)).sum::<f32>() / 240.0;
    let dense = tube(&radius);
    let share = volume(&dense) / volume(&tube(&|_| square.sqrt()));
    assert!((share - 1.0).abs() < 0.03, "{share}");
    // Each ring is still labeled as one of the points that it stands for.
    for ring in &dense.mesh.tracing {
        let x = 0.15 * (ring.sample.0 - 1) as f32;
        assert!((ring.center.x - x).abs() < 0.3, "{} at {x}", ring.center.x);
    }
}

/// Faults of many shapes of one kind, at level 2.
fn sum(shapes: impl Iterator<Item = Morphology>) -> usize {
    shapes.map(|shape| faults(&made(&shape), 2)).sum()
}

/// Pairs of two parameters on a grid.
fn grid<'a>(a: &'a [f32], b: &'a [f32]) -> impl Iterator<Item = (f32, f32)> + 'a {
    a.iter().flat_map(move |&a| b.iter().map(move |&b| (a, b)))
}

#[neurotess_testing::test]
fn zigzags_tighter_than_the_radius_are_sound() {
    let shapes = grid(&[0.6, 0.9, 1.2, 1.6], &[0.3, 0.6, 1.0]);
    let faults = sum(shapes.map(|(step, width)| zigzag(step, width)));
    assert!(faults <= 2, "{faults}"); // with rings as traced: 74
}

#[neurotess_testing::test]
fn hairpins_are_sound() {
    let shapes = grid(&[0.2, 0.35, 0.6, 1.0], &[1.5, 3.0]);
    let faults = sum(shapes.map(|(apart, length)| hairpin(apart, length)));
    // With rings as traced: 243. Two, if all points of both legs may be left out up to where they are two radii apart:
    // then the branch is 4 to 12 µm shorter than traced.
    assert!(faults <= 13, "{faults}");
}

/// Where its path turns, a tube has nearly the volume of two cylinders that meet in a ball: one ring across the
/// bisector lacks 1.0 to 2.5 r³, two circles 0.5 at most; with their inner corners in the crease they lack 0.1.
#[neurotess_testing::test]
fn single_bends_do_not_narrow_the_tube() {
    let bent = |turn: f32| {
        let (sin, cos) = turn.sin_cos();
        let ends = [vec3(-10.0, 0.0, 0.0), vec3(10.0 * cos, 10.0 * sin, 0.0)];
        let way = [ends[0], 0.5 * ends[0], Vec3::ZERO, 0.5 * ends[1], ends[1]];
        volume(&made(&path(&way.map(|at| (at, 1.0)))))
    };
    let straight = bent(0.0);
    for degrees in [62.0_f32, 75.0, 90.0, 105.0, 120.0] {
        let turn = degrees.to_radians();
        // Cut off by the ball from two cylinders that meet in the bisector's plane.
        let expected = 4.0 / 3.0 * (0.5 * turn).tan() - 2.0 / 3.0 * turn;
        let lacking = straight - bent(turn) - expected;
        assert!(lacking.abs() < 0.3, "{degrees}°: {lacking}");
    }
}

#[neurotess_testing::test]
fn points_far_from_a_bend_stay() {
    // A way that wriggles a little up to a point that lies behind the next ones.
    let way = (0..12).map(|i| vec3(2.0 * i as f32, 0.9 * (2.1 * i as f32).sin(), 0.0));
    let back = [
        vec3(21.0, 0.2, -2.3),
        vec3(20.6, 0.1, -2.6),
        vec3(21.4, 0.8, -1.0),
        vec3(22.8, 0.7, 0.9),
    ];
    let onwards = (1..8).map(|i| vec3(22.8 + 2.0 * i as f32, 0.5 * (1.7 * i as f32).cos(), 1.0));
    let points: Vec<(Vec3, f32)> = way.chain(back).chain(onwards).map(|p| (p, 1.0)).collect();
    let generated = made(&path(&points));
    let left_out = generated.warnings.iter().any(|w| w.code == "sharp_bend");
    assert!(left_out, "{:?}", generated.warnings);
    let is_there = |sample: usize| {
        let mut labels = generated.mesh.tracing.iter();
        labels.any(|t| t.sample.0 == sample as i32)
    };
    let far = (0..8).chain(17..23).map(|point| point + 1);
    let lacking: Vec<usize> = far.filter(|&sample| !is_there(sample)).collect();
    assert!(lacking.is_empty(), "{lacking:?}");
}

#[neurotess_testing::test]
fn jumps_of_the_radius_are_sound() {
    for (step, thick) in grid(&[0.7, 1.0, 1.4, 2.0], &[0.8, 1.5, 2.5]) {
        let generated = made(&jumps(step, thick));
        assert_eq!(crossings(&generated), 0, "{step} {thick}");
    }
}

/// Pairs of faces that cross at level 4.
fn crossings(generated: &Generated) -> usize {
    let level = LodCriterion::Homogeneous(4);
    let options = RefineOptions::default();
    let surface = SurfaceMesh::collect(&Refinement::new(&generated.mesh, level, &options));
    surface.self_intersections().len()
}

/// Fault C7, `v1_varicosities.swc`: swellings nearer to their neighbors than they are thick, in one point or several, on a
/// straight path or a bent one.
#[neurotess_testing::test]
fn swellings_are_as_thick_as_they_were_traced() {
    let one = |thin: f32, thick: f32| [thin, thin, thin, thin, thick, thin];
    let round = [0.1, 0.1, 0.4, 0.9, 1.2, 0.9, 0.4, 0.1];
    let cases: [(&[f32], f32, f32); 6] = [
        (&one(0.1, 1.5), 0.5, 0.0),
        (&one(0.2, 0.8), 0.25, 0.0),
        (&one(0.3, 0.9), 0.3, 0.0),
        (&one(0.1, 1.5), 0.5, 1.5),
        (&round, 0.2, 0.0),
        (&round, 0.2, 1.0),
    ];
    for (radii, step, sway) in cases {
        let points: Vec<(Vec3, f32)> = (0..90)
            .map(|i| {
                let along = step * i as f32;
                let place = vec3(along, sway * (0.3 * along).sin(), 0.0);
                (place, radii[i % radii.len()])
            })
            .collect();
        let traced: f32 = points
            .windows(2)
            .map(|w| {
                let [(p, a), (q, b)] = [w[0], w[1]];
                std::f32::consts::PI * p.distance(q) * (a * a + a * b + b * b) / 3.0
            })
            .sum();
        let generated = made(&path(&points));
        let share = volume(&generated) / traced;
        assert!(
            (share - 1.0).abs() < 0.035,
            "{radii:?} {step} {sway}: {share}"
        );
        let most = radii.iter().copied().fold(0.0, f32::max);
        let highest = generated.mesh.vertices.iter().map(|v| {
            let center = generated.mesh.tracing[v.tracing as usize].center;
            v.position.distance(center)
        });
        assert!(
            highest.fold(0.0, f32::max) > 0.95 * most,
            "{radii:?} {step} {sway}"
        );
        assert_eq!(crossings(&generated), 0, "{radii:?} {step} {sway}");
    }
}

#[neurotess_testing::test]
fn forks_at_acute_angles_are_sound() {
    let shapes = grid(&[0.1, 0.2, 0.35, 0.5], &[0.8, 1.5, 3.0]);
    let faults = sum(shapes.map(|(angle, step)| acute_fork(angle, step)));
    assert!(faults <= 8, "{faults}"); // with rings as traced: 212
}

#[neurotess_testing::test]
fn sound_tubes_stay_as_they_were_traced() {
    let points: Vec<(Vec3, f32)> = (0..20)
        .map(|i| (vec3(2.0 * i as f32, (0.2 * i as f32).sin(), 0.0), 0.5))
        .collect();
    let generated = made(&path(&points));
    assert!(generated.warnings.is_empty(), "{:?}", generated.warnings);
    let radii = generated.mesh.tracing.iter().map(|t| t.radius);
    assert!(radii.into_iter().all(|radius| radius == 0.5));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Random walks with random radii: closed, every vertex with its sample, nothing thinner than a pinch,
    /// and the same twice.
    #[neurotess_testing::test]
    fn whatever_is_drawn_in_stays_closed_and_belongs_to_its_sample(
        steps in proptest::collection::vec(((-1.0_f32..1.0), (-1.0_f32..1.0), (-1.0_f32..1.0), (0.2_f32..1.0)), 6..60),
    ) {
        let mut at = Vec3::ZERO;
        let points: Vec<(Vec3, f32)> = steps
            .iter()
            .map(|&(x, y, z, radius)| {
                at += vec3(x, y, z) + vec3(0.3, 0.0, 0.0);
                (at, radius)
            })
            .collect();
        let morphology = path(&points);
        let generated = made(&morphology);
        faults(&generated, 2);
        for point in &generated.mesh.tracing {
            let sample = points[point.sample.0 as usize - 1].0;
            // A ring may stand for several samples, which are within half a radius of one another.
            let near = points.iter().filter(|(at, _)| at.distance(sample) <= 1.0);
            let (thin, thick) = near.fold((f32::INFINITY, 0.0_f32), |(thin, thick), (_, radius)| {
                (thin.min(*radius), thick.max(*radius))
            });
            prop_assert!(point.radius > 0.34 * thin && point.radius <= 1.001 * thick);
            prop_assert!(point.center.distance(sample) <= 1.6 * thick);
        }
        prop_assert_eq!(&generated.mesh, &made(&morphology).mesh);
    }
}
