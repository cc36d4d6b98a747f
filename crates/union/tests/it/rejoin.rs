//! Pieces that merging cuts off, where a tube is inside out, are joined again.

use crate::shapes::{BARE, brick, inverted, merged, together, tube};
use glam::Vec3;
use neurotess_mesh::{Report, SurfaceMesh, SurfaceVertex};
use neurotess_union::{Union, UnionOptions};
use proptest::prelude::*;

const REJOIN: UnionOptions = UnionOptions {
    rejoin: true,
    ..BARE
};

/// A tube whose second half turns back along the first, `width` beside it at its end.
fn hairpin(width: f32) -> SurfaceMesh {
    let line = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.1],
        [4.0, 0.0, 0.0],
        [0.5, width, 0.0],
        [-2.0, 1.8 * width, 0.1],
    ];
    tube(&line.map(Vec3::from), 0.5, 8, 3)
}

/// A surface merged without joining, and with it.
fn cut_and_joined(mesh: &SurfaceMesh) -> (Union, Union, Report) {
    let (cut, _) = merged(mesh, &BARE);
    let (joined, report) = merged(mesh, &REJOIN);
    (cut, joined, report)
}

#[neurotess_testing::test]
fn a_hairpin_stays_in_one_piece() {
    let mut were_cut = 0;
    for width in [0.8, 1.0, 1.3, 1.6, 2.0, 2.5, 3.0] {
        let mesh = hairpin(width);
        let (cut, joined, report) = cut_and_joined(&mesh);
        assert_eq!(report.components, 1, "{width}");
        assert!(joined.report.cut_off.is_empty(), "{width}");
        assert_eq!(
            joined.report.joined.len(),
            cut.report.cut_off.len(),
            "{width}"
        );
        if cut.report.cut_off.is_empty() {
            assert_eq!(cut, joined);
            continue;
        }
        were_cut += 1;
        assert!(joined.report.handles <= cut.report.handles, "{width}");
        for place in &joined.report.joined {
            let known = |v: &SurfaceVertex| (v.point, v.section) == (place.point, place.section);
            assert!(mesh.vertices.iter().any(known), "{place:?}");
            // At the bend, and no more than the tube between its rings.
            assert!((place.position.x - 4.0).abs() < 1.6, "{place:?}");
            assert!(place.gap > 0.0 && place.gap < 4.0, "{place:?}");
            assert!((0.0..3.0).contains(&place.volume), "{place:?}");
        }
    }
    assert!(were_cut > 1, "{were_cut}");
}

/// A beam of ten units, and a slab inside out through it.
fn cut_beam(radius: f32) -> SurfaceMesh {
    let slab = brick([4.0, -1.0, -1.2], [5.0, 2.0, 2.3]);
    let mut mesh = together(&[brick([0.0; 3], [10.0, 1.0, 1.0]), inverted(slab)]);
    let vertices = mesh.vertices.iter_mut();
    vertices.for_each(|vertex| vertex.radius = radius);
    mesh
}

#[neurotess_testing::test]
fn what_is_cut_off_is_joined_however_thin_it_is_said_to_be() {
    // Of a soma of a micrometer's hundredth, through which thick neurites go, rings have its radius.
    for radius in [0.7, 0.05, 0.0] {
        let (cut, whole, report) = cut_and_joined(&cut_beam(radius));
        assert_eq!(cut.report.cut_off.len(), 1);
        assert_eq!(report.components, 1, "{radius}");
        assert!(whole.report.cut_off.is_empty());
        // What was missing, but for a little that the hull is smaller by.
        let [joined] = whole.report.joined[..] else {
            panic!("{:?}", whole.report.joined);
        };
        assert!((0.4..1.0).contains(&joined.volume), "{joined:?}");
        assert!((joined.gap - 10.0).abs() < 1e-5, "{joined:?}");
    }
}

fn line() -> impl Strategy<Value = Vec<[f32; 3]>> {
    prop::collection::vec(prop::array::uniform3(-2.0f32..2.0), 3..9)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[neurotess_testing::test]
    fn crumpled_tubes_stay_in_one_piece(line in line(), sides in 4u32..9) {
        let mut line: Vec<Vec3> = line.into_iter().map(Vec3::from).collect();
        line.dedup_by(|a, b| a.distance(*b) < 0.4);
        let turns_back = line.windows(3).any(|w| (w[2] - w[0]).length() < 0.3);
        prop_assume!(line.len() > 1 && !turns_back);
        let mesh = tube(&line, 0.5, sides, 1);
        let (union, report) = merged(&mesh, &UnionOptions::default());
        prop_assert_eq!(report.components, 1, "{:?}", union.report);
        prop_assert!(union.report.cut_off.is_empty());
    }
}
