//! Small holes that merging makes are filled, and large loops stay.

use std::f32::consts::TAU;

use crate::shapes::{BARE, assert_near, merged, straight, together, tube};
use glam::Vec3;
use neurotess_mesh::{Report, SurfaceMesh, SurfaceVertex};
use neurotess_union::{Union, UnionOptions};
use proptest::prelude::*;

const FILL: UnionOptions = UnionOptions { fill: 2.0, ..BARE };

/// What `--simulation` asks for, but for pressing in: these shapes are to be merged.
fn whole() -> UnionOptions {
    UnionOptions {
        fill: 2.0,
        least_angle: 20.0,
        ..UnionOptions::default()
    }
}

/// A tube of radius 0.5 that turns about the z axis by more than once, back into itself.
fn ring(around: f32, at: Vec3, section: i32) -> SurfaceMesh {
    let steps = (20.0 * around.max(1.0)) as usize;
    let line: Vec<Vec3> = (0..=steps)
        .map(|n| {
            let angle = 1.08 * TAU * n as f32 / steps as f32;
            at + Vec3::new(around * angle.cos(), around * angle.sin(), 0.03 * angle)
        })
        .collect();
    tube(&line, 0.5, 12, section)
}

/// A wave through a straight tube, both of radius 0.4: four crossings.
fn wave(height: f32) -> SurfaceMesh {
    let line: Vec<Vec3> = (0..=60)
        .map(|n| {
            let along = 11.6 * n as f32 / 60.0 - 1.0;
            Vec3::new(along, height * (along + 0.4).sin(), 0.11)
        })
        .collect();
    let wave = tube(&line, 0.4, 10, 2);
    together(&[straight([-1.3, 0.0, 0.0], [12.4, 0.0, 0.0], 0.4, 1), wave])
}

fn handles(mesh: &SurfaceMesh, options: &UnionOptions) -> i64 {
    let (union, _) = merged(mesh, options);
    union.report.handles.expect("a manifold")
}

/// Asserts what holds of everything that was filled.
fn assert_fair(mesh: &SurfaceMesh, filled: &Union, plain: &Union) {
    let (filled, plain) = (&filled.report, &plain.report);
    assert_eq!(filled.components, plain.components);
    assert_eq!(filled.places, plain.places);
    let gains = filled.filled.iter().map(|hole| hole.volume);
    assert!(filled.volume > plain.volume - 1e-3 * plain.volume);
    assert!(gains.clone().all(f64::is_finite));
    for hole in &filled.filled {
        let label = |v: &SurfaceVertex| (v.point, v.section);
        let known = |v: &SurfaceVertex| label(v) == (hole.point, hole.section);
        assert!(mesh.vertices.iter().any(known), "{hole:?}");
        assert!(hole.girth > 0.0);
    }
}

/// A surface merged without filling holes, and with it.
fn plain_and_filled(mesh: &SurfaceMesh, options: UnionOptions) -> (Union, Union, Report) {
    let not = UnionOptions {
        fill: 0.0,
        ..options
    };
    let (plain, _) = merged(mesh, &not);
    let (filled, report) = merged(mesh, &options);
    (plain, filled, report)
}

#[neurotess_testing::test]
fn a_tube_that_bends_back_into_itself_has_no_hole() {
    let mesh = ring(0.8, Vec3::ZERO, 1);
    for options in [FILL, whole()] {
        let (plain, filled, report) = plain_and_filled(&mesh, options);
        assert_eq!(plain.report.handles, Some(1));
        assert!(plain.report.filled.is_empty());
        assert_eq!((report.genus, report.components), (Some(0), 1));
        assert_fair(&mesh, &filled, &plain);
        let [hole] = filled.report.filled[..] else {
            panic!("{:?}", filled.report.filled);
        };
        // The hole is 0.3 wide, about the axis, and about as high as the tube is thick.
        assert!(hole.position.length() < 0.4, "{hole:?}");
        assert!((0.8..TAU.into()).contains(&hole.girth), "{hole:?}");
        assert!((0.0..0.3).contains(&hole.volume), "{hole:?}");
    }
}

#[neurotess_testing::test]
fn a_large_ring_stays_a_ring() {
    let mesh = ring(3.0, Vec3::ZERO, 1);
    let (plain, _) = merged(&mesh, &BARE);
    let (tried, report) = merged(&mesh, &FILL);
    assert_eq!(report.genus, Some(1));
    assert_eq!(tried, plain);
}

#[neurotess_testing::test]
fn the_limit_is_in_circumferences() {
    // The hole is 0.7 wide, its girth 1.4 of a circumference.
    let mesh = ring(1.2, Vec3::ZERO, 1);
    let limit = |fill: f64| UnionOptions { fill, ..BARE };
    assert_eq!(handles(&mesh, &limit(1.0)), 1);
    assert_eq!(handles(&mesh, &limit(2.0)), 0);
}

#[neurotess_testing::test]
fn holes_beside_one_another_are_filled() {
    let mesh = wave(1.0);
    for options in [FILL, whole()] {
        let (plain, filled, report) = plain_and_filled(&mesh, options);
        assert_eq!(plain.report.handles, Some(3));
        assert_eq!(report.genus, Some(0));
        assert_eq!(filled.report.filled.len(), 3);
        assert_fair(&mesh, &filled, &plain);
    }
}

#[neurotess_testing::test]
fn loops_of_distinct_branches_stay() {
    let mesh = wave(4.0);
    let (plain, _) = merged(&mesh, &BARE);
    let (tried, report) = merged(&mesh, &FILL);
    assert_eq!(report.genus, Some(3));
    assert_eq!(tried, plain);
}

#[neurotess_testing::test]
fn each_hole_counts_for_itself() {
    // A small ring, a large one, and one that merging did not make.
    let closed = {
        let mut mesh = SurfaceMesh::default();
        for n in 0..16_u32 {
            for m in 0..8_u32 {
                let [around, across] = [n as f32 / 16.0 * TAU, m as f32 / 8.0 * TAU];
                let out = 0.8 + 0.5 * across.cos();
                mesh.vertices.push(SurfaceVertex {
                    position: Vec3::new(
                        20.0 + out * around.cos(),
                        out * around.sin(),
                        0.5 * across.sin(),
                    ),
                    radius: 0.5,
                    ..SurfaceVertex::default()
                });
                let at = |r: u32, s: u32| (n + r) % 16 * 8 + (m + s) % 8;
                mesh.faces
                    .quads
                    .push([at(0, 0), at(1, 0), at(1, 1), at(0, 1)]);
            }
        }
        mesh
    };
    let mesh = together(&[
        ring(0.8, Vec3::ZERO, 1),
        ring(3.0, Vec3::new(10.0, 0.0, 0.0), 2),
        closed,
    ]);
    let (filled, report) = merged(&mesh, &whole());
    assert_eq!(filled.report.handles_before, 1);
    assert_eq!((report.components, report.genus), (3, Some(2)));
    assert_eq!(filled.report.filled.len(), 1);
    assert_eq!(filled.report.filled[0].section, 1);
}

#[neurotess_testing::test]
fn labels_stay_labels_and_far_vertices_stay() {
    let mesh = ring(0.8, Vec3::ZERO, 7);
    let (filled, _) = merged(&mesh, &whole());
    let label = |v: &SurfaceVertex| (v.kind, v.point, v.section);
    for vertex in &filled.mesh.vertices {
        let known = |old: &SurfaceVertex| label(old) == label(vertex);
        assert!(mesh.vertices.iter().any(known), "{vertex:?}");
        assert_near(vertex.radius.into(), 0.5, 1e-5);
        assert_near(vertex.normal.length().into(), 1.0, 1e-4);
    }
    // All on the far side of the ring, where the tube is not in its own way.
    let (bare, _) = merged(&mesh, &FILL);
    let outside = |v: &&SurfaceVertex| v.position.x < -1.0;
    assert!(mesh.vertices.iter().filter(outside).count() > 10);
    for vertex in mesh.vertices.iter().filter(outside) {
        assert!(bare.mesh.vertices.contains(vertex), "{vertex:?}");
    }
}

#[neurotess_testing::test]
fn equal_input_gives_equal_output() {
    let mesh = wave(1.0);
    assert_eq!(merged(&mesh, &whole()).0, merged(&mesh, &whole()).0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[neurotess_testing::test]
    fn filling_is_sound(around in 0.4_f32..1.6, rise in -0.2_f32..0.2, sides in 4u32..14) {
        let line: Vec<Vec3> = (0..=24)
            .map(|n| {
                let angle = 1.5 * TAU * n as f32 / 24.0;
                Vec3::new(around * angle.cos(), around * angle.sin(), rise * angle)
            })
            .collect();
        let mesh = tube(&line, 0.5, sides, 1);
        let (plain, _) = merged(&mesh, &UnionOptions { fill: 0.0, ..whole() });
        let (filled, _) = merged(&mesh, &whole());
        prop_assert_eq!(filled.report.components, plain.report.components);
        let less = plain.report.handles.unwrap_or(0) - filled.report.handles.unwrap_or(0);
        prop_assert!(less >= filled.report.filled.len() as i64);
        prop_assert!(!filled.report.filled.is_empty() || filled == plain);
    }
}
