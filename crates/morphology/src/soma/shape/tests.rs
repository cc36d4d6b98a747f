use glam::Vec3;

use super::*;
use crate::SomaSample;

fn samples(rows: &[([f32; 3], f32, Option<u32>)]) -> Vec<SomaSample> {
    let sample =
        |(i, &(position, radius, parent)): (i64, &([f32; 3], f32, Option<u32>))| SomaSample {
            id: i + 1,
            position: Vec3::from_array(position),
            radius,
            parent,
        };
    (0..).zip(rows).map(sample).collect()
}

/// An ellipse about (3, 4, 5), in the plane z = 5 turned about z by `turn`.
fn ellipse(half: [f64; 2], turn: f64) -> Soma {
    let corners = (0..48).map(|i| {
        let (sin, cos) = (f64::from(i) * PI / 24.0).sin_cos();
        let (x, y) = (half[0] * cos, half[1] * sin);
        let (s, c) = turn.sin_cos();
        let place = DVec3::new(3.0 + c * x - s * y, 4.0 + s * x + c * y, 5.0);
        (place.as_vec3().to_array(), 0.0, u32::checked_sub(i, 1))
    });
    Soma::from_outlines(samples(&corners.collect::<Vec<_>>()))
}

#[test]
fn an_ellipse_becomes_an_ellipsoid_as_deep_as_it_is_wide() {
    let shape = SomaShape::of(&ellipse([12.0, 6.0], 0.7));
    assert!(shape.center().distance(DVec3::new(3.0, 4.0, 5.0)) < 1e-3);
    let (s, c) = 0.7_f64.sin_cos();
    let along = [DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z];
    for (axis, half) in along.into_iter().zip([12.0, 6.0, 6.0]) {
        for sign in [-1.0, 1.0] {
            let distance = shape.distance(axis * sign);
            assert!((distance / half - 1.0).abs() < 5e-3, "{axis}: {distance}");
        }
    }
    let volume = 4.0 / 3.0 * PI * 12.0 * 6.0 * 6.0;
    assert!(
        (shape.volume() / volume - 1.0).abs() < 0.015,
        "{}",
        shape.volume()
    );
    // An oblate or prolate ellipsoid's area by its formula.
    let eccentricity = (1.0_f64 - 0.25).sqrt();
    let area = 2.0 * PI * 36.0 * (1.0 + 12.0 / (6.0 * eccentricity) * eccentricity.asin());
    assert!(
        (shape.area() / area - 1.0).abs() < 0.01,
        "{} {area}",
        shape.area()
    );
}

#[test]
fn the_silhouette_of_an_outline_is_the_outline_with_round_corners() {
    // A kidney.
    let corners = [
        [10., 0.],
        [9., 3.5],
        [7., 5.2],
        [5., 5.5],
        [2., 4.],
        [0., 3.2],
        [-3., 3.6],
        [-6., 4.],
        [-9., 3.],
        [-10., 0.],
        [-6., -4.],
        [0., -5.],
        [7., -4.],
    ];
    let rows = (0_u32..).zip(corners);
    let rows: Vec<_> = rows
        .map(|(i, [x, y])| ([x, y, 0.0], 0.0, i.checked_sub(1)))
        .collect();
    let soma = Soma::from_outlines(samples(&rows));
    let shape = SomaShape::of(&soma);
    for [x, y] in corners {
        let corner = DVec3::new(f64::from(x), f64::from(y), 0.0) - shape.center();
        let traced = corner.length();
        let distance = shape.distance(corner / traced);
        // Corners that were clicked are rounded over 6° to both sides.
        let off = (distance - traced).abs() / f64::from(soma.radius);
        assert!(off < 0.08, "{x} {y}: {distance} of {traced}");
    }
}

#[test]
fn a_stack_keeps_every_outline_and_has_round_caps() {
    let mut rows = Vec::new();
    for (radius, z) in [(4.0_f64, 0.0_f32), (6.0, 3.0), (5.0, 6.0)] {
        for i in 0..32_u32 {
            let (sin, cos) = (f64::from(i) * PI / 16.0).sin_cos();
            let place = [(radius * cos) as f32, (radius * sin) as f32, z];
            let parent = (i > 0).then(|| rows.len() as u32 - 1);
            rows.push((place, 0.0, parent));
        }
    }
    let shape = SomaShape::of(&Soma::from_outlines(samples(&rows)));
    for &(place, ..) in &rows {
        let corner = Vec3::from_array(place).as_dvec3() - shape.center();
        let distance = shape.distance(corner.normalize_or_zero());
        assert!(
            (distance / corner.length() - 1.0).abs() < 0.01,
            "{place:?}: {distance}"
        );
    }
    let top = shape.center().z + shape.distance(DVec3::Z);
    let bottom = shape.center().z - shape.distance(DVec3::NEG_Z);
    assert!(
        (top - 7.5).abs() < 1e-3 && (bottom + 1.5).abs() < 1e-3,
        "{bottom} to {top}"
    );
}

#[test]
fn long_chains_have_the_volume_of_their_frusta_and_half_depth_ends() {
    let rows = [([0., 0., 0.], 5.0, None), ([0., 0., 24.], 5.0, Some(0))];
    let shape = SomaShape::of(&Soma::from_samples(samples(&rows)));
    let volume = PI * 25.0 * 24.0;
    assert!(
        (shape.volume() / volume - 1.0).abs() < 1e-9,
        "{}",
        shape.volume()
    );
    // A third of a radius is cut off, and half of one stands for it.
    let end = 12.0 + 5.0 / 6.0;
    assert!((shape.distance(DVec3::Z) - end).abs() < 1e-9);
    assert!((shape.distance(DVec3::X) - 5.0).abs() < 1e-9);
    assert!(!shape.is_like_neurite());
    // A cone: its side is straight from sample to sample.
    let rows = [([0., 0., 0.], 6.0, None), ([0., 0., 14.], 3.0, Some(0))];
    let shape = SomaShape::of(&Soma::from_samples(samples(&rows)));
    let place = shape.center() + DVec3::X * shape.distance(DVec3::X);
    assert!(
        (place.x - (6.0 - 3.0 * place.z / 14.0)).abs() < 1e-9,
        "{place}"
    );
    let volume = PI * 14.0 / 3.0 * (36.0 + 18.0 + 9.0);
    assert!(
        (shape.volume() / volume - 1.0).abs() < 1e-9,
        "{}",
        shape.volume()
    );
    let (summed, _) = {
        let directions = Directions::new(24);
        let distances: Vec<f64> = directions
            .units
            .iter()
            .map(|&unit| shape.distance(unit))
            .collect();
        directions.volume_and_area(&distances)
    };
    assert!((summed / volume - 1.0).abs() < 0.01, "{summed} of {volume}");
}

/// Fault C1: the usual stylized soma, as long as it is wide, in two samples, in three, and with its root in the middle.
#[test]
fn a_chain_no_longer_than_it_is_wide_stands_for_a_ball() {
    let ends = [([-10., 0., 0.], 10.0, None), ([10., 0., 0.], 10.0, Some(0))];
    let in_a_row = [
        ([-10., 0., 0.], 10.0, None),
        ([0., 0., 0.], 10.0, Some(0)),
        ([10., 0., 0.], 10.0, Some(1)),
    ];
    // Not quite the three points of NeuroMorpho.Org.
    let around = [
        ([0., 0., 0.], 10.0, None),
        ([0., -10.3, 0.], 10.0, Some(0)),
        ([0., 10.3, 0.], 10.0, Some(0)),
    ];
    for rows in [&ends[..], &in_a_row, &around] {
        let soma = Soma::from_samples(samples(rows));
        let shape = SomaShape::of(&soma);
        assert!(
            shape.is_sphere() && (soma.radius - 10.0).abs() < 1e-3,
            "{rows:?}"
        );
        assert!((shape.volume() - 4188.79).abs() < 1.0, "{}", shape.volume());
        assert!(shape.area() < 1260.0, "{}", shape.area());
    }
    // A disk is no thicker than it has area.
    let disk = [([0., 0., 0.], 10.0, None), ([0., 0., 4.], 10.0, Some(0))];
    let shape = SomaShape::of(&Soma::from_samples(samples(&disk)));
    assert!(shape.is_sphere() && (shape.radius() - 8.366).abs() < 1e-3);
}

/// A ball in slices is that ball, whatever their number.
#[test]
fn the_slices_of_a_ball_are_a_ball() {
    let rows: Vec<_> = (0..21_u32)
        .map(|i| {
            let x = f64::from(i) - 10.0;
            let radius = (100.0 - x * x).sqrt();
            ([x as f32, 0., 0.], radius as f32, i.checked_sub(1))
        })
        .collect();
    let shape = SomaShape::of(&Soma::from_samples(samples(&rows)));
    assert!(
        (shape.volume() / 4188.79 - 1.0).abs() < 0.01,
        "{}",
        shape.volume()
    );
    for direction in Directions::new(5).units {
        let distance = shape.distance(direction);
        assert!(
            (distance / 10.0 - 1.0).abs() < 0.03,
            "{direction}: {distance}"
        );
    }
}

#[test]
fn bent_branched_and_long_chains_are_like_neurites() {
    let is_like_neurite =
        |rows: &[_]| SomaShape::of(&Soma::from_samples(samples(rows))).is_like_neurite();
    let bent = [
        ([0., 0., 0.], 3.0, None),
        ([12., 0., 0.], 3.0, Some(0)),
        ([12., 12., 0.], 3.0, Some(1)),
        ([0., 12., 0.], 3.0, Some(2)),
    ];
    let long = [([0., 0., 0.], 2.0, None), ([40., 0., 0.], 2.0, Some(0))];
    assert!(is_like_neurite(&bent) && is_like_neurite(&long));
    let thick = [
        ([0., 0., 0.], 5.0, None),
        ([4., 1., 0.], 6.0, Some(0)),
        ([8., 0., 0.], 5.0, Some(1)),
    ];
    assert!(!is_like_neurite(&thick));
}

#[test]
fn a_soma_without_extent_is_a_sphere_of_no_radius() {
    let rows = [([1., 0., 0.], 0.0, None), ([1., 0., 0.], 0.0, Some(0))];
    let shape = SomaShape::of(&Soma::from_samples(samples(&rows)));
    assert!(shape.is_sphere());
    assert_eq!((shape.volume(), shape.distance(DVec3::X)), (0.0, 0.0));
    let nowhere = SomaShape::sphere(DVec3::ZERO, f64::NAN);
    assert_eq!(nowhere.area(), 0.0);
}
