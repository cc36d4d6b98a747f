//! Positions of first rings: where they are, what they do to the soma, what limits them.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3, vec3};
use neurotess_generate::{FirstRing, GenerateOptions, Generated, SomaMethod, generate};
use neurotess_morphology::{
    Attachment, Morphology, NeuriteKind, Point, Section, Soma, SomaKind, SomaSample,
};
use proptest::prelude::*;

/// Radius (µm) of the soma.
const R: f32 = 5.0;

/// A soma with unbranched neurites of radius 0.5 µm through the given points.
fn cell(neurites: &[Vec<Vec3>]) -> Morphology {
    let mut m = Morphology::default();
    let sample = SomaSample {
        id: 1,
        position: Vec3::ZERO,
        radius: R,
        parent: None,
    };
    m.somata.push(Soma {
        kind: SomaKind::Point,
        samples: vec![sample],
        center: Vec3::ZERO,
        radius: R,
    });
    for points in neurites {
        let first = m.points.len() as u32;
        for &position in points {
            m.sample_ids.push(m.points.len() as i64 + 2);
            m.points.push(Point {
                position,
                radius: 0.5,
            });
        }
        m.sections.push(Section {
            kind: NeuriteKind(3),
            attachment: Attachment::Soma { soma: 0, sample: 0 },
            first,
            end: m.points.len() as u32,
        });
    }
    m
}

/// Five straight neurites with points at 8, 12, 16 and 20 µm.
fn star() -> Morphology {
    let directions = [
        vec3(0.0, 1.0, 0.1),
        vec3(1.0, -0.4, 0.3),
        vec3(-1.0, -0.3, 0.4),
        vec3(0.1, -0.5, -1.0),
        vec3(0.2, -0.6, 1.0),
    ];
    let straight = |d: &Vec3| {
        let d = d.normalize_or(Vec3::X);
        [8.0, 12.0, 16.0, 20.0].map(|at| d * at).to_vec()
    };
    cell(&directions.iter().map(straight).collect::<Vec<_>>())
}

fn with(morphology: &Morphology, rings: &[(u32, f64)]) -> Generated {
    let options = GenerateOptions {
        rings: rings.iter().copied().collect(),
        ..GenerateOptions::default()
    };
    generate(morphology, &options).expect("meshed")
}

fn ring(generated: &Generated, neurite: u32) -> FirstRing {
    let rings = generated.rings.iter();
    *rings
        .clone()
        .find(|r| r.neurite == neurite)
        .unwrap_or_else(|| panic!("{rings:?}"))
}

fn distance(ring: &FirstRing) -> f64 {
    ring.center.length()
}

fn count(generated: &Generated, code: &str) -> usize {
    let warnings = generated.warnings.iter();
    warnings.filter(|w| w.code == code).map(|w| w.count).sum()
}

fn assert_sound(generated: &Generated, what: &str) {
    let shape = generated.mesh.topology();
    assert!(
        shape.closed && shape.oriented && shape.vertex_manifold,
        "{what}: {shape:?}"
    );
    assert_eq!(shape.euler, 2 * shape.components as i64, "{what}");
    for bad in ["soma_folded", "no_insertion_quad"] {
        assert_eq!(count(generated, bad), 0, "{what}: {bad}");
    }
}

#[neurotess_testing::test]
fn rings_are_where_they_are_requested() {
    let star = star();
    // The first point is 3 µm from the sphere, so 2 is 3 µm beyond it.
    for (position, at) in [(0.0, 5.0), (0.5, 6.5), (1.0, 8.0), (1.5, 9.5), (2.0, 11.0)] {
        let made = with(&star, &[(1, position)]);
        assert_sound(&made, &format!("at {position}"));
        let ring = ring(&made, 1);
        assert!((ring.position - position).abs() < 1e-6, "{ring:?}");
        assert!((distance(&ring) - at).abs() < 1e-4, "{position}: {ring:?}");
        assert_eq!(count(&made, "ring_limited"), 0);
        let point = star.points[4].position.as_dvec3();
        assert!(ring.outwards.dot(point.normalize_or_zero()) > 0.9999);
    }
}

#[neurotess_testing::test]
fn the_others_stay_as_they_are() {
    let (star, usual) = (star(), with(&star(), &[]));
    let made = with(&star, &[(0, 2.0)]);
    for neurite in 1..5 {
        let (a, b) = (ring(&usual, neurite), ring(&made, neurite));
        assert!(a.center.distance(b.center) < 1e-9);
        assert!((a.position - 1.75 / 3.0).abs() < 1e-6, "1.35 R: {a:?}");
    }
    assert_eq!(usual.mesh, with(&star, &[]).mesh);
}

#[neurotess_testing::test]
fn farther_rings_make_larger_somata() {
    let star = star();
    let mut last = 0.0;
    for position in [0.0, 0.5, 1.0, 1.5, 2.0] {
        let volume = with(&star, &[(3, position)]).somata[0].volume;
        assert!(volume > last, "{position}: {volume} after {last}");
        last = volume;
    }
}

#[neurotess_testing::test]
fn beyond_the_first_point_a_ring_follows_the_path() {
    let bent = cell(&[
        vec![
            vec3(0.0, 8.0, 0.0),
            vec3(3.0, 11.0, 0.0),
            vec3(9.0, 17.0, 0.0),
        ],
        vec![vec3(0.0, -8.0, 0.0), vec3(0.0, -20.0, 0.0)],
    ]);
    let made = with(&bent, &[(0, 2.0)]);
    assert_sound(&made, "bent");
    // 3 µm along the diagonal.
    let expected = DVec3::new(3.0, 8.0 * 2_f64.sqrt() + 3.0, 0.0) / 2_f64.sqrt();
    assert!(ring(&made, 0).center.distance(expected) < 1e-4);
}

#[neurotess_testing::test]
fn a_fork_an_end_and_a_turn_of_the_path_limit_it() {
    let mut forked = cell(&[
        vec![vec3(0.0, 6.0, 0.0), vec3(0.0, 8.0, 0.0)],
        vec![vec3(-4.0, 18.0, 0.0)],
        vec![vec3(4.0, 18.0, 0.0)],
        vec![vec3(0.0, -6.0, 0.0), vec3(0.0, -7.5, 0.0)],
        vec![
            vec3(6.0, 0.0, 0.0),
            vec3(6.5, 0.0, 0.0),
            vec3(6.5, 0.0, 9.0),
        ],
    ]);
    for section in [1, 2] {
        forked.sections[section].attachment =
            Attachment::Section(neurotess_morphology::SectionId(0));
    }
    for (neurite, least, most) in [(0, 6.9, 7.3), (1, 6.7, 6.8), (2, 6.4, 6.6)] {
        let made = with(&forked, &[(neurite, 2.0)]);
        assert_sound(&made, &format!("neurite {neurite}"));
        assert_eq!(count(&made, "ring_limited"), 1, "neurite {neurite}");
        let at = distance(&ring(&made, neurite));
        assert!((least..most).contains(&at), "neurite {neurite}: {at}");
    }
}

#[neurotess_testing::test]
fn a_ring_that_goes_too_far_comes_to_a_stop() {
    let far = |y: f32| {
        vec![
            vec3(0.0, y, 0.0),
            vec3(0.0, 1.2 * y, 0.0),
            vec3(0.0, 2.0 * y, 0.0),
        ]
    };
    let cell = cell(&[far(60.0), far(-60.0)]);
    let mut last = 0.0;
    for position in [0.05, 0.1, 0.3, 0.6, 1.0, 2.0] {
        let made = with(&cell, &[(0, position)]);
        assert_sound(&made, &format!("at {position}"));
        let at = distance(&ring(&made, 0));
        assert!(at >= last - 1e-9, "{position}: {at} after {last}");
        last = at;
    }
    assert!(last < 40.0, "an arm of {last} µm out of a soma of 5");
    assert_eq!(count(&with(&cell, &[(0, 2.0)]), "ring_limited"), 1);
}

#[neurotess_testing::test]
fn requests_that_cannot_be_followed_are_reported() {
    let star = star();
    assert_eq!(
        count(&with(&star, &[(9, 1.0), (1, f64::NAN)]), "ring_unused"),
        2
    );
    let sphere = GenerateOptions {
        soma: SomaMethod::Sphere,
        rings: BTreeMap::from([(0, 1.5)]),
        ..GenerateOptions::default()
    };
    let made = generate(&star, &sphere).expect("meshed");
    assert_eq!(count(&made, "ring_unused"), 1);
    assert!((distance(&ring(&made, 0)) - 5.0).abs() < 1e-6);
    assert_eq!(ring(&with(&star, &[(0, 7.0)]), 0).position, 2.0);
}

#[neurotess_testing::test]
fn the_profile_has_positions_too() {
    for position in [0.0, 1.0, 2.0] {
        let options = GenerateOptions {
            soma: SomaMethod::Profile,
            rings: (0..5).map(|n| (n, position)).collect(),
            ..GenerateOptions::default()
        };
        let made = generate(&star(), &options).expect("meshed");
        assert_sound(&made, &format!("profile at {position}"));
        assert!((ring(&made, 2).position - position).abs() < 1e-6);
    }
}

fn direction() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0_f32..1.0)
        .prop_map(Vec3::from_array)
        .prop_filter("no direction", |d| d.length() > 0.2)
        .prop_map(|d| d.normalize_or(Vec3::X))
}

/// A path that leaves the soma and wanders.
fn path() -> impl Strategy<Value = Vec<Vec3>> {
    let steps = prop::collection::vec((direction(), 0.5_f32..6.0), 1..6);
    (direction(), 1.02_f32..4.0, steps).prop_map(|(out, start, steps)| {
        let mut points = vec![out * (start * R)];
        for (aside, length) in steps {
            let step = (out + 0.8 * aside).normalize_or(out) * length;
            points.push(points[points.len() - 1] + step);
        }
        points
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[neurotess_testing::test]
    fn any_positions_give_a_closed_surface_without_folds(
        paths in prop::collection::vec(path(), 1..7),
        positions in prop::collection::vec(0.0_f64..2.0, 6),
    ) {
        let cell = cell(&paths);
        let rings: Vec<(u32, f64)> = (0..paths.len() as u32).zip(positions).collect();
        let made = with(&cell, &rings);
        let shape = made.mesh.topology();
        prop_assert!(shape.closed && shape.oriented && shape.vertex_manifold, "{shape:?}");
        prop_assert_eq!(shape.euler, 2 * shape.components as i64);
        prop_assert_eq!(count(&made, "soma_folded"), 0);
        for (neurite, position) in rings {
            let placed = made.rings.iter().find(|r| r.neurite == neurite);
            prop_assert!(placed.is_none_or(|r| r.position <= position + 1e-6));
        }
    }
}
