use super::*;
use glam::Vec3;

fn soma(samples: &[(f32, f32, f32, f32, Option<u32>)]) -> Soma {
    let sample = |(i, &(x, y, z, radius, parent)): (usize, &(f32, f32, f32, f32, _))| SomaSample {
        id: i as i64 + 1,
        position: Vec3::new(x, y, z),
        radius,
        parent,
    };
    Soma::from_samples(samples.iter().enumerate().map(sample).collect())
}

#[test]
fn three_points_in_any_direction_are_one_sphere() {
    let (c, s) = (3.0, 4.0); // radius 5
    let soma = soma(&[
        (1., 1., 1., 5., None),
        (4., 5., 1., 5., Some(0)),
        (-2., -3., 1., 5., Some(0)),
    ]);
    assert_eq!((soma.kind, soma.radius), (SomaKind::ThreePoint, 5.0));
    assert_eq!(soma.center, Vec3::ONE);
    assert_eq!(c * c + s * s, 25.0);
}

#[test]
fn three_points_in_a_row_are_cylinders() {
    let soma = soma(&[
        (0., 0., 0., 5., None),
        (0., 5., 0., 5., Some(0)),
        (0., 11., 0., 5., Some(1)),
    ]);
    assert_eq!(soma.kind, SomaKind::Cylinders);
    // Sides of 110 π and two faces of 25 π.
    assert!((soma.radius - (160.0_f32 / 4.0).sqrt()).abs() < 1e-5);
}

/// The samples of `a1_soma_profile.swc`: one in the middle, and `count` others at this distance with one radius.
fn marked(middle: f32, distance: f64, radius: f32, count: u32, flat: bool, in_a_row: bool) -> Soma {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let place = |i: u32| {
        let height = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let [height, turn] = match flat {
            true => [0.0, 2.0 * PI * f64::from(i) / f64::from(count)],
            false => [height, golden * f64::from(i)],
        };
        let width = (1.0 - height * height).sqrt();
        distance * DVec3::new(width * turn.cos(), width * turn.sin(), height)
    };
    let sample = |i: u32| SomaSample {
        id: i64::from(i) + 1,
        position: match i.checked_sub(1) {
            None => Vec3::ZERO,
            Some(mark) => place(mark).as_vec3(),
        },
        radius: if i == 0 { middle } else { radius },
        parent: i
            .checked_sub(1)
            .map(|before| if in_a_row { before } else { 0 }),
    };
    Soma::from_samples((0..=count).map(sample).collect())
}

/// Fault C4.
#[test]
fn samples_without_a_radius_of_their_own_are_a_surface_or_an_outline() {
    for (radius, count) in [(1.0, 24), (0.0, 24), (0.5, 9), (-1.0, 12), (6.0, 30)] {
        let soma = marked(6.0, 6.5, radius, count, false, false);
        assert_eq!(soma.kind, SomaKind::Surface, "{radius}");
        assert!(
            (soma.radius - 6.5).abs() < 1e-5,
            "{radius}: {}",
            soma.radius
        );
        let (area, _) = soma_area_volume(&soma);
        assert!((area - 530.9).abs() < 0.1, "{area}");
        assert!(SomaShape::of(&soma).is_sphere());
    }
    for in_a_row in [false, true] {
        let soma = marked(6.0, 6.5, 1.0, 24, true, in_a_row);
        assert_eq!(soma.kind, SomaKind::Contour);
        assert!((soma.radius - 6.5).abs() < 0.05, "{}", soma.radius);
        assert_eq!(soma.outlines()[0].len(), 24);
    }
}

#[test]
fn samples_without_a_radius_to_one_side_are_left_out() {
    let mut samples = vec![(0., 0., 0., 6.0, None)];
    samples.extend((0..5_u8).map(|i| {
        (
            5.0 + 0.5 * f32::from(i),
            2.0,
            0.1 * f32::from(i),
            1.0,
            Some(0),
        )
    }));
    let soma = soma(&samples);
    assert_eq!(
        (soma.kind, soma.radius, soma.center),
        (SomaKind::Point, 6.0, Vec3::ZERO)
    );
}

#[test]
fn thin_closed_outline_is_a_contour_of_equal_area() {
    let soma = soma(&[
        (0., 0., 0., 0., None),
        (4., 0., 0., 0., Some(0)),
        (4., 2., 0., 0., Some(1)),
        (0., 2., 0., 0., Some(2)),
        (0., 1., 0., 0., Some(3)),
    ]);
    assert_eq!(
        (soma.kind, soma.center),
        (SomaKind::Contour, Vec3::new(2., 1., 0.))
    );
    assert!((soma.radius - (8.0 / PI as f32).sqrt()).abs() < 1e-6);
}

#[test]
fn thick_closed_outline_is_cylinders() {
    let corners =
        [(0., 0.), (4., 0.), (4., 2.), (0., 2.), (0., 1.)].map(|(x, y): (f32, f32)| (x, y));
    let samples: Vec<_> = (0..5)
        .map(|i| {
            (
                corners[i].0,
                corners[i].1,
                0.,
                1.0,
                i.checked_sub(1).map(|p| p as u32),
            )
        })
        .collect();
    assert_eq!(soma(&samples).kind, SomaKind::Cylinders);
}

#[test]
fn of_stacked_outlines_the_largest_counts() {
    let square = |half: f32, z: f32| {
        [(-1., -1.), (1., -1.), (1., 1.), (-1., 1.)]
            .map(|(x, y): (f32, f32)| Vec3::new(half * x, half * y, z))
    };
    let corners = [square(1., 0.), square(2., 3.), square(1.5, 6.)].concat();
    let sample = |(i, &position): (usize, &Vec3)| SomaSample {
        id: i as i64 + 1,
        position,
        radius: 1.0,
        parent: match i {
            0 => None,
            i if i % 4 == 0 => Some(i as u32 - 4),
            i => Some(i as u32 - 1),
        },
    };
    let soma = Soma::from_outlines(corners.iter().enumerate().map(sample).collect());
    assert_eq!(
        (soma.kind, soma.center),
        (SomaKind::Contour, Vec3::new(0., 0., 3.))
    );
    assert!((soma.radius - (16.0 / PI as f32).sqrt()).abs() < 1e-6);
}

#[test]
fn outlines_without_area_have_the_mean_distance() {
    let sample = |id, x, parent| SomaSample {
        id,
        position: Vec3::new(x, 0., 0.),
        radius: 0.1,
        parent,
    };
    let soma = Soma::from_outlines(vec![sample(1, 0., None), sample(2, 4., Some(0))]);
    assert_eq!(
        (soma.kind, soma.center, soma.radius),
        (SomaKind::Contour, Vec3::new(2., 0., 0.), 2.0)
    );
}

fn outline(points: &[(f32, f32)]) -> Soma {
    let sample = |(i, &(x, y)): (usize, &(f32, f32))| SomaSample {
        id: i as i64 + 1,
        position: Vec3::new(x, y, 0.0),
        radius: 0.0,
        parent: i.checked_sub(1).map(|p| p as u32),
    };
    Soma::from_outlines(points.iter().enumerate().map(sample).collect())
}

fn mean_distance(points: &[(f32, f32)]) -> f32 {
    let points: Vec<DVec3> = points
        .iter()
        .map(|&(x, y)| Vec3::new(x, y, 0.0).as_dvec3())
        .collect();
    spread(&points).1 as f32
}

#[test]
fn outlines_that_enclose_next_to_nothing_have_their_mean_distance() {
    let needle = [(0., 0.), (10., 0.2), (20., 0.), (10., -0.2)];
    let open = [(0., 0.), (5., 0.4), (10., 0.6), (15., 0.4), (20., 0.1)];
    let eight = [(0., 0.), (8., 5.), (8., 0.), (0., 5.)];
    for points in [&needle[..], &open, &eight] {
        let soma = outline(points);
        assert_eq!(soma.kind, SomaKind::Contour);
        assert_eq!(soma.radius, mean_distance(points), "{points:?}");
    }
    // One that goes around something keeps the radius of equal area.
    let round = outline(&[(0., 0.), (4., 0.), (4., 2.), (0., 2.)]);
    assert!((round.radius - (8.0 / PI as f32).sqrt()).abs() < 1e-6);
}

#[test]
fn samples_without_thickness_are_an_outline_however_they_hang() {
    let ring = |parent: fn(u32) -> Option<u32>| {
        let sample = |i: u32| {
            let angle = f64::from(i) / 12.0 * 2.0 * PI * 0.7;
            SomaSample {
                id: i64::from(i) + 1,
                position: (4.4 * DVec3::new(angle.cos(), angle.sin(), 0.0)).as_vec3(),
                radius: 0.0,
                parent: parent(i),
            }
        };
        Soma::from_samples((0..12).map(sample).collect())
    };
    // A ring with a gap, and one whose samples all hang on the first.
    let in_a_row = ring(|i| i.checked_sub(1));
    let on_the_first = ring(|i| (i > 0).then_some(0));
    for soma in [in_a_row, on_the_first] {
        assert_eq!(soma.kind, SomaKind::Contour);
        assert!((3.5..5.0).contains(&soma.radius), "{}", soma.radius);
    }
    let in_one_place = soma(&[(1., 0., 0., 0., None), (1., 0., 0., 0., Some(0))]);
    assert_eq!(
        (in_one_place.kind, in_one_place.radius),
        (SomaKind::Cylinders, 0.0)
    );
}

/// Samples in a row, as a block of Neurolucida has them.
fn block(rows: &[[f32; 3]]) -> Soma {
    let sample = |(i, &row): (usize, &[f32; 3])| SomaSample {
        id: i as i64 + 1,
        position: Vec3::from_array(row),
        radius: 0.28,
        parent: i.checked_sub(1).map(|p| p as u32),
    };
    Soma::from_outlines(rows.iter().enumerate().map(sample).collect())
}

/// Fault F17: the outlines of `c05_stack_in_one_block.asc`, of which the larger one has this radius.
#[test]
fn a_block_whose_z_jumps_is_a_stack() {
    let rows = [
        [-11.25, -22.78, 1.66],
        [-13.04, -17.52, 1.66],
        [-15.60, -11.61, 1.66],
        [-15.39, -4.32, 1.66],
        [-12.88, 1.02, 1.66],
        [-11.10, 3.84, 1.66],
        [-4.00, 1.00, 1.66],
        [-2.00, -10.00, 1.66],
        [-5.00, -20.00, 1.66],
        [-8.55, 6.01, -4.57],
        [-6.64, 3.38, -4.57],
        [-3.51, -3.52, -4.57],
        [-5.00, -14.00, -4.57],
        [-10.00, -17.00, -4.57],
        [-13.00, -8.00, -4.57],
    ];
    let soma = block(&rows);
    assert!((soma.radius - 9.08).abs() < 0.005, "{}", soma.radius);
    assert_eq!(
        soma.outlines().iter().map(Vec::len).collect::<Vec<_>>(),
        [9, 6]
    );
}

/// One outline in two depths is no stack: its halves do not go around anything.
#[test]
fn an_outline_that_is_not_flat_is_no_stack() {
    let [a, b] = [0.0, 3.0];
    let rows = [
        [10., 0., a],
        [7., 7., a],
        [0., 10., a],
        [-7., 7., b],
        [-10., 0., b],
        [-7., -7., b],
        [0., -10., b],
        [7., -7., a],
    ];
    let radius = block(&rows).radius;
    // The mean distance from the mean of the samples: not flat.
    assert!((radius - 9.53).abs() < 0.01, "{radius}");
    let tilted = |i: i16| {
        let (sin, cos) = (f32::from(i) * std::f32::consts::PI / 12.0).sin_cos();
        [8.0 * cos, 8.0 * sin, 1.0 * cos]
    };
    let rows: Vec<[f32; 3]> = (0..24).map(tilted).collect();
    assert_eq!(block(&rows).outlines().len(), 1);
}

/// Fault F23, `c04_soma3_dend_mid.swc`.
#[test]
fn the_faces_at_the_ends_of_a_chain_count() {
    let soma = soma(&[
        (0., 0., 0., 10., None),
        (0., 0., 2., 10., Some(0)),
        (0., 0., 4., 10., Some(1)),
    ]);
    assert!((soma.radius - 8.366).abs() < 1e-3, "{}", soma.radius);
}

#[test]
fn coincident_samples_take_the_thickest() {
    let soma = soma(&[(1., 0., 0., 2., None), (1., 0., 0., 2., Some(0))]);
    assert_eq!((soma.kind, soma.radius), (SomaKind::Cylinders, 2.0));
}
