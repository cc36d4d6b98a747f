//! Bodies whose union is known.

use std::sync::atomic::AtomicBool;

use crate::shapes::{BARE, assert_near, brick, inverted, merged, straight, together, tube};
use glam::Vec3;
use neurotess_mesh::{Stopped, SurfaceMesh, SurfaceVertex, Watch};
use neurotess_union::{Kin, UnionError, UnionOptions, Why, crossing_places, union, union_watched};

fn default() -> UnionOptions {
    UnionOptions::default()
}

/// Two tubes through one another, nothing parallel to anything.
fn crossing_tubes() -> SurfaceMesh {
    together(&[
        straight([-5.0, 0.1, 0.2], [5.0, 0.3, -0.1], 1.0, 1),
        straight([0.2, -4.0, 0.3], [-0.3, 4.1, 0.0], 0.6, 7),
    ])
}

#[neurotess_testing::test]
fn two_crossing_tubes_become_one_body_without_a_handle() {
    let mesh = crossing_tubes();
    let (union, report) = merged(&mesh, &default());
    assert_eq!((report.components, report.genus), (1, Some(0)));
    assert_eq!(union.report.handles_made(), Some(0));
    let before = mesh.measure().volume;
    assert!(report.volume < before && report.volume > 0.85 * before);
    assert!(union.report.pairs_before > 20);
    assert!(union.mesh.faces.quads.is_empty());
}

#[neurotess_testing::test]
fn another_thread_can_stop_it() {
    let made = |stopped| {
        let stopped = AtomicBool::new(stopped);
        union_watched(&crossing_tubes(), &default(), &Watch::stopped_by(&stopped))
    };
    assert_eq!(made(true), Err(UnionError::Stopped(Stopped)));
    assert_eq!(made(false), union(&crossing_tubes(), &default()));
}

#[neurotess_testing::test]
fn the_place_of_a_crossing_names_both_samples() {
    let places = merged(&crossing_tubes(), &default()).0.report.places;
    let searched = crossing_places(&crossing_tubes(), &Watch::default());
    assert_eq!(searched.expect("searched"), places);
    let stopped = crossing_places(
        &crossing_tubes(),
        &Watch::stopped_by(&AtomicBool::new(true)),
    );
    assert!(matches!(stopped, Err(UnionError::Stopped(Stopped))));
    assert_eq!(places.len(), 1, "{places:?}");
    let place = &places[0];
    assert!(place.position.length() < 0.5, "{place:?}");
    assert_eq!(place.kin, Kin::Apart);
    let mut sections = place.sections;
    sections.sort_unstable();
    assert_eq!(sections, [1, 7]);
    // Rings 0 to 8 along each tube, the crossing near the middle one.
    for (point, section) in place.points.iter().zip(place.sections) {
        assert!((3..=5).contains(&(point - 1000 * section)), "{place:?}");
    }
    // The axes pass at a tenth or two; the thin tube is wholly within the thick one.
    assert!((0.9..=1.201).contains(&place.depth), "{place:?}");
}

#[neurotess_testing::test]
fn crossing_twice_makes_one_handle() {
    let bow: Vec<Vec3> = (0..=20)
        .map(|n| {
            let t = n as f32 / 10.0 - 1.0;
            Vec3::new(4.1 * t, 3.0 * t * t - 1.03, 0.05 + 0.1 * t)
        })
        .collect();
    let line: Vec<Vec3> = (0..=40)
        .map(|n| Vec3::new(0.3 * n as f32 - 6.0, 0.1, 0.2 - 0.01 * n as f32))
        .collect();
    let mesh = together(&[tube(&line, 0.5, 9, 1), tube(&bow, 0.4, 9, 2)]);
    let (union, report) = merged(&mesh, &default());
    assert_eq!((report.components, report.genus), (1, Some(1)));
    assert_eq!(union.report.handles_made(), Some(1));
    assert_eq!(union.report.places.len(), 2, "{:?}", union.report.places);
}

#[neurotess_testing::test]
fn a_tube_through_its_own_section_is_near() {
    let loop_: Vec<Vec3> = (0..=30)
        .map(|n| {
            let angle = n as f32 / 30.0 * 7.5;
            Vec3::new(3.0 * angle.cos(), 3.0 * angle.sin(), 0.02 * angle)
        })
        .collect();
    let mesh = tube(&loop_, 0.5, 9, 4);
    let (union, report) = merged(&mesh, &default());
    assert_eq!((report.components, report.genus), (1, Some(1)));
    assert!(
        union
            .report
            .places
            .iter()
            .all(|place| place.kin == Kin::Near)
    );
}

#[neurotess_testing::test]
fn what_lies_inside_is_left_out() {
    let outer = straight([-5.0, 0.0, 0.0], [5.0, 0.0, 0.0], 1.0, 1);
    let inner = straight([-2.0, 0.1, 0.0], [2.0, 0.0, 0.1], 0.3, 2);
    let (union, report) = merged(&together(&[outer.clone(), inner]), &default());
    assert_eq!(union.report.pairs_before, 0);
    assert_eq!(report.components, 1);
    assert_near(report.volume, outer.measure().volume, 1e-12);
    let why: Vec<Why> = union.report.dropped.iter().map(|part| part.why).collect();
    assert_eq!(why, [Why::Inside]);
    assert_eq!(union.mesh.vertices, outer.vertices);
}

#[neurotess_testing::test]
fn a_cavity_of_the_input_stays() {
    let shell = together(&[
        brick([0.0; 3], [4.0; 3]),
        inverted(brick([1.0; 3], [2.0; 3])),
    ]);
    let (union, report) = merged(&shell, &default());
    assert_eq!(report.components, 2);
    assert_near(report.volume, 63.0, 1e-12);
    assert!(union.report.dropped.is_empty());
}

#[neurotess_testing::test]
fn a_body_inside_out_encloses_nothing() {
    let bodies = [
        brick([0.0; 3], [1.0; 3]),
        inverted(brick([2.0; 3], [3.0; 3])),
    ];
    let (union, report) = merged(&together(&bodies), &default());
    assert_eq!((report.components, report.volume), (1, 1.0));
    assert_eq!(union.report.dropped[0].why, Why::Inverted);
    let (union, report) = merged(&bodies[1], &default());
    assert_eq!(report.triangles, 0);
    assert_eq!(union.report.dropped.len(), 1);
}

#[neurotess_testing::test]
fn a_body_inside_out_takes_its_part_of_another() {
    let bodies = [
        brick([0.0; 3], [4.0; 3]),
        inverted(brick([1.1, 1.2, 1.3], [2.0, 2.0, 6.0])),
    ];
    let (_, report) = merged(&together(&bodies), &BARE);
    assert_near(report.volume, 64.0 - 0.9 * 0.8 * 2.7, 1e-6);
}

/// A beam, and a slab inside out through it at a place.
fn cut_beam(x: f32) -> SurfaceMesh {
    let slab = brick([x, -1.0, -1.2], [x + 1.0, 2.0, 2.3]);
    let mut mesh = together(&[brick([0.0; 3], [10.0, 1.0, 1.0]), inverted(slab)]);
    mesh.vertices
        .iter_mut()
        .for_each(|vertex| vertex.radius = 0.5);
    mesh
}

#[neurotess_testing::test]
fn a_piece_with_a_volume_that_is_cut_off_stays_and_is_told() {
    let (union, report) = merged(&cut_beam(4.0), &BARE);
    assert_eq!(report.components, 2);
    assert_near(report.volume, 9.0, 1e-6);
    assert!(union.report.dropped.is_empty());
    let [part] = union.report.cut_off[..] else {
        panic!("{:?}", union.report.cut_off);
    };
    assert_eq!(part.why, Why::CutOff);
    assert_near(part.volume, 4.0, 1e-6);
}

#[neurotess_testing::test]
fn a_splinter_is_left_out_and_told() {
    let (union, report) = merged(&cut_beam(5e-4), &BARE);
    assert_eq!(report.components, 1);
    let [part] = union.report.dropped[..] else {
        panic!("{:?}", union.report.dropped);
    };
    assert_eq!(part.why, Why::Tiny);
    assert_near(part.volume, 5e-4, 1e-3);
    assert!(union.report.cut_off.is_empty());
}

#[neurotess_testing::test]
fn bodies_with_a_common_face_become_one() {
    let bodies = [
        brick([0.0; 3], [1.0; 3]),
        brick([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]),
    ];
    let (_, report) = merged(&together(&bodies), &BARE);
    assert_eq!(report.components, 1);
    assert_near(report.volume, 2.0, 1e-12);
    let bodies = [
        brick([0.0; 3], [2.0; 3]),
        brick([2.0, 0.5, 0.25], [3.0, 1.5, 1.25]),
    ];
    let (_, report) = merged(&together(&bodies), &BARE);
    assert_eq!((report.components, report.genus), (1, Some(0)));
    assert_near(report.volume, 9.0, 1e-6);
}

#[neurotess_testing::test]
fn bodies_with_faces_in_one_plane_become_one() {
    let bodies = [
        brick([0.0; 3], [2.0; 3]),
        brick([1.0, 0.0, 0.5], [3.0, 2.0, 1.5]),
    ];
    let (_, report) = merged(&together(&bodies), &BARE);
    assert_eq!((report.components, report.genus), (1, Some(0)));
    assert_near(report.volume, 8.0 + 2.0, 1e-6);
}

#[neurotess_testing::test]
fn a_body_there_twice_is_there_once() {
    for count in [2, 3] {
        let one = straight([-5.0, 0.1, 0.2], [5.0, 0.3, -0.1], 1.0, 1);
        let (_, report) = merged(&together(&vec![one.clone(); count]), &BARE);
        assert_eq!(report.components, 1);
        assert_eq!(report.vertices, one.vertices.len());
        assert_near(report.volume, one.measure().volume, 1e-9);
    }
}

#[neurotess_testing::test]
fn bodies_that_touch_are_parted() {
    let base = brick([0.0; 3], [2.0; 3]);
    let touching = [
        ("along an edge", brick([2.0, 2.0, 0.5], [3.0, 3.0, 1.5])),
        (
            "along the same edge",
            brick([2.0, 2.0, 0.0], [4.0, 4.0, 2.0]),
        ),
        ("in a corner", brick([2.0; 3], [3.0; 3])),
    ];
    for (what, other) in touching {
        let (_, report) = merged(&together(&[base.clone(), other.clone()]), &BARE);
        let volume = base.measure().volume + other.measure().volume;
        assert_eq!(report.components, 2, "{what}");
        assert_near(report.volume, volume, 0.01);
    }
}

#[neurotess_testing::test]
fn a_corner_on_a_face_is_parted() {
    let mut spike = brick([0.5, 0.5, 2.0], [1.5, 1.5, 4.0]);
    // Its lower side shrinks to a point on the other's upper side.
    for corner in spike.vertices.iter_mut().filter(|v| v.position.z == 2.0) {
        corner.position.z = 3.0;
    }
    spike.vertices.push(SurfaceVertex {
        position: Vec3::new(0.9, 1.1, 2.0),
        ..SurfaceVertex::default()
    });
    let [a, b, c, d] = spike.faces.quads.remove(0);
    let tip = spike.vertices.len() as u32 - 1;
    let sides = [[a, b, tip], [b, c, tip], [c, d, tip], [d, a, tip]];
    spike.faces.triangles.extend(sides);
    let mesh = together(&[brick([0.0; 3], [2.0; 3]), spike]);
    let (union, report) = merged(&mesh, &default());
    assert!(union.report.pairs_before > 0);
    assert_eq!(report.components, 2);
    assert_near(report.volume, mesh.measure().volume, 0.01);
}

#[neurotess_testing::test]
fn tubes_that_touch_along_a_line_are_parted() {
    let line = |y: f32| -> Vec<Vec3> { (0..4).map(|n| Vec3::new(n as f32, y, 0.0)).collect() };
    let one = tube(&line(0.0), 0.5, 4, 1);
    let reach = one
        .vertices
        .iter()
        .map(|v| v.position.y)
        .fold(0.0, f32::max);
    let other = tube(&line(2.0 * reach), 0.5, 4, 2);
    let mesh = together(&[one, other]);
    let (_, report) = merged(&mesh, &default());
    assert_near(report.volume, mesh.measure().volume, 0.05);
}

#[neurotess_testing::test]
fn nothing_and_what_crosses_nothing_stay() {
    let (union, _) = merged(&SurfaceMesh::default(), &default());
    assert_eq!(union.mesh, SurfaceMesh::default());
    let mut mesh = straight([-5.0, 0.1, 0.2], [5.0, 0.3, -0.1], 1.0, 1);
    mesh.origin = glam::DVec3::new(1e4, -3e3, 7.0);
    let (union, _) = merged(&mesh, &default());
    assert_eq!(union.mesh.vertices, mesh.vertices);
    assert_eq!(union.mesh.origin, mesh.origin);
    assert_eq!((union.report.rounds, union.report.faces_changed), (0, 0));
}

#[neurotess_testing::test]
fn what_no_crossing_touches_stays_to_the_bit() {
    let mesh = crossing_tubes();
    let (union, _) = merged(&mesh, &default());
    let is_old = |vertex: &SurfaceVertex| mesh.vertices.contains(vertex);
    let old = union.mesh.vertices.iter().filter(|v| is_old(v)).count();
    // The rings beside the crossing may go; those at the ends may not.
    assert!(old > mesh.vertices.len() / 2);
    let ends = mesh.vertices.iter().filter(|v| v.position.length() > 3.0);
    assert!(ends.clone().count() > 40);
    for end in ends {
        assert!(union.mesh.vertices.contains(end), "{end:?}");
    }
}

#[neurotess_testing::test]
fn labels_are_never_interpolated_and_radii_are() {
    let mut mesh = crossing_tubes();
    for vertex in &mut mesh.vertices {
        vertex.radius += 0.01 * vertex.position.x;
    }
    let (union, _) = merged(&mesh, &BARE);
    let alike = |a: &SurfaceVertex, b: &SurfaceVertex| {
        (a.kind, a.point, a.section) == (b.kind, b.point, b.section)
    };
    let mut made = 0;
    for vertex in &union.mesh.vertices {
        assert!(mesh.vertices.iter().any(|old| alike(old, vertex)));
        if !mesh.vertices.contains(vertex) {
            made += 1;
            let base = if vertex.section == 1 { 1.0 } else { 0.6 };
            let expected = base + 0.01 * vertex.position.x;
            assert!((vertex.radius - expected).abs() < 1e-5, "{vertex:?}");
            assert!((vertex.normal.length() - 1.0).abs() < 1e-5);
        }
    }
    assert!(made > 10);
}

#[neurotess_testing::test]
fn bad_surfaces_are_errors() {
    let mut open = brick([0.0; 3], [1.0; 3]);
    open.faces.quads.pop();
    assert_eq!(union(&open, &default()), Err(UnionError::NotClosed));
    let mut turned = brick([0.0; 3], [1.0; 3]);
    turned.faces.quads[2].reverse();
    assert_eq!(union(&turned, &default()), Err(UnionError::NotClosed));
    let mut endless = brick([0.0; 3], [1.0; 3]);
    endless.vertices[5].position.y = f32::NAN;
    assert_eq!(union(&endless, &default()), Err(UnionError::NotFinite(5)));
    let mut missing = brick([0.0; 3], [1.0; 3]);
    missing.faces.quads[0][1] = 8;
    assert_eq!(
        union(&missing, &default()),
        Err(UnionError::MissingVertex(8))
    );
}

#[neurotess_testing::test]
fn equal_input_gives_equal_output() {
    let mesh = crossing_tubes();
    assert_eq!(union(&mesh, &default()), union(&mesh, &default()));
}
