//! Surfaces that cross a little are pressed in, and those that cross deeply grow together.

use crate::shapes::{BARE, assert_near, merged, straight, together, tube};
use glam::Vec3;
use neurotess_mesh::SurfaceMesh;
use neurotess_union::UnionOptions;

const PRESS: UnionOptions = UnionOptions { press: 0.3, ..BARE };

/// One tube with two arms side by side, their axes `apart` from one another at the ends and farther elsewhere.
fn two_arms(apart: f32) -> SurfaceMesh {
    let arm = |side: f32| {
        (0..12).map(move |n| {
            let along = 0.5 * (n + 1) as f32;
            let across = apart / 2.0 + 0.15 * (5.5 - along).max(0.0);
            Vec3::new(along, side * across, 0.0)
        })
    };
    let mut line: Vec<Vec3> = arm(-1.0).collect();
    line.reverse();
    // Around the bend, which is wide.
    let radius = apart / 2.0 + 0.15 * 5.0;
    line.extend((1..6).map(|n| {
        let angle = std::f32::consts::PI * n as f32 / 6.0;
        Vec3::new(0.5 - 1.5 * angle.sin(), -radius * angle.cos(), 0.0)
    }));
    line.extend(arm(1.0));
    tube(&line, 0.5, 12, 1)
}

#[neurotess_testing::test]
fn arms_that_cross_a_little_make_no_handle() {
    let mesh = two_arms(0.93);
    let (grown, before) = merged(&mesh, &BARE);
    assert_eq!(grown.report.handles_made(), Some(1));
    assert_eq!((grown.report.places.len(), grown.report.pressed), (1, 0));
    let (pressed, after) = merged(&mesh, &PRESS);
    assert_eq!(pressed.report.handles_made(), Some(0));
    assert!(pressed.report.pressed > 0 && pressed.report.rounds == 0);
    assert_eq!(pressed.report.pressed_places, grown.report.places);
    assert!(pressed.report.places.is_empty());
    assert_near(after.volume, before.volume, 0.03);
    // No vertex has gone farther than it may.
    for (before, after) in mesh.vertices.iter().zip(&pressed.mesh.vertices) {
        assert!(before.position.distance(after.position) <= 0.3 * 0.5 + 1e-6);
    }
}

#[neurotess_testing::test]
fn arms_that_cross_deeply_grow_together_as_if_nothing_was_pressed() {
    let mesh = two_arms(0.4);
    let (grown, _) = merged(&mesh, &BARE);
    let (tried, _) = merged(&mesh, &PRESS);
    assert!(grown.report.handles_made() > Some(0));
    assert_eq!(tried.report.pressed, 0);
    assert_eq!(tried.mesh, grown.mesh);
}

#[neurotess_testing::test]
fn each_place_is_pressed_or_merged_for_itself() {
    let through = |x: f32, apart: f32, section: i32| {
        together(&[
            straight([x, 0.0, 0.0], [x + 8.0, 0.0, 0.0], 1.0, section),
            straight(
                [x + 4.1, -4.0, apart],
                [x + 4.3, 4.0, apart],
                0.7,
                section + 1,
            ),
        ])
    };
    let mesh = together(&[through(0.0, 1.65, 1), through(20.0, 0.2, 3)]);
    let (union, report) = merged(&mesh, &PRESS);
    assert!(union.report.pressed > 0 && union.report.rounds > 0);
    assert_eq!(
        (union.report.pressed_places.len(), union.report.places.len()),
        (1, 1)
    );
    // The pair that was pressed apart, and the one that became one.
    assert_eq!(report.components, 3);
}
