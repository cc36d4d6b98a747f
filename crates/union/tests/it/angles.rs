//! Narrow triangles are made wider, and the surface stays where it is.

use crate::shapes::{BARE, assert_near, merged, straight, together, tube};
use glam::Vec3;
use neurotess_mesh::{SurfaceMesh, check};
use neurotess_union::UnionOptions;

const WIDE: UnionOptions = UnionOptions {
    least_angle: 20.0,
    ..BARE
};

/// A tube with a slight bend whose rings come in pairs, much nearer to one another than its radius.
fn paired_rings(sides: u32) -> SurfaceMesh {
    let line: Vec<Vec3> = (0..24)
        .map(|n| {
            let along = (n / 2) as f32 + 0.03 * (n % 2) as f32;
            Vec3::new(along, 0.005 * along * along, 0.0)
        })
        .collect();
    tube(&line, 1.0, sides, 1)
}

#[neurotess_testing::test]
fn narrow_triangles_become_wide() {
    let mesh = paired_rings(9);
    let (as_it_was, before) = merged(&mesh, &BARE);
    assert!(before.quality.min_angle < 3.0 && as_it_was.report.improved == 0);
    let (wider, after) = merged(&mesh, &WIDE);
    assert!(wider.report.improved > 0);
    assert!(after.quality.min_angle > 19.0, "{:?}", after.quality);
    // Only edges that are given to other corners change it.
    assert_near(after.volume, before.volume, 0.001);
    assert_near(after.area, before.area, 0.01);
    // Every vertex lies on the tube as before, within the reach of its sample.
    for vertex in &wider.mesh.vertices {
        let near = mesh.vertices.iter().any(|other| {
            other.point == vertex.point && other.position.distance(vertex.position) < 1.0
        });
        assert!(near, "{vertex:?}");
    }
}

/// The largest angle (degrees) between two facets that share an edge.
fn sharpest(mesh: &SurfaceMesh) -> f32 {
    let mut beside = std::collections::BTreeMap::<[u32; 2], Vec<Vec3>>::new();
    for &face in &mesh.faces.triangles {
        let [a, b, c] = face.map(|v| mesh.vertices[v as usize].position);
        let normal = (b - a).cross(c - a);
        for k in 0..3 {
            let [from, to] = [face[k], face[(k + 1) % 3]];
            let edge = [from.min(to), from.max(to)];
            beside.entry(edge).or_default().push(normal);
        }
    }
    let angles = beside.values().filter_map(|normals| match normals[..] {
        [a, b] => Some(a.angle_between(b)),
        _ => None,
    });
    angles.fold(0.0, f32::max).to_degrees()
}

/// All triangles of the tube are narrower than asked for, and would be wider with six sides and 60° between them.
#[neurotess_testing::test]
fn tubes_keep_eight_sides() {
    let line: Vec<Vec3> = (0..12)
        .map(|n| Vec3::new(2.6 * n as f32, 0.0, (n as f32).sin() * 0.1))
        .collect();
    let mesh = tube(&line, 1.0, 8, 1);
    let (as_it_was, before) = merged(&mesh, &BARE);
    let (union, after) = merged(&mesh, &WIDE);
    assert!(before.quality.min_angle_p1 < 18.0);
    let [before, after] = [(as_it_was, before), (union, after)]
        .map(|(union, verdict)| (sharpest(&union.mesh), verdict.area));
    neurotess_testing::note!("{before:?}, {after:?}");
    assert!(after.0 < before.0.max(50.3), "{before:?}, {after:?}");
    assert!(
        (after.1 / before.1 - 1.0).abs() < 0.004,
        "{before:?}, {after:?}"
    );
}

#[neurotess_testing::test]
fn wide_triangles_stay_to_the_bit() {
    let line: Vec<Vec3> = (0..9).map(|n| Vec3::X * n as f32 * 0.7).collect();
    let mesh = tube(&line, 1.0, 9, 1);
    assert!(check(&mesh).quality.min_angle > 20.0);
    let (union, _) = merged(&mesh, &WIDE);
    assert_eq!(union.report.improved, 0);
    assert_eq!(union.mesh.vertices, mesh.vertices);
}

/// Nearly flat edges across which the angles are more than 180.5° together.
fn edges_of_the_wrong_diagonal(mesh: &SurfaceMesh) -> usize {
    let mut across = std::collections::BTreeMap::<[u32; 2], Vec<(f32, Vec3)>>::new();
    for &face in &mesh.faces.triangles {
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|n| face[(k + n) % 3]);
            let at = |v: u32| mesh.vertices[v as usize].position;
            let angle = (at(a) - at(c)).angle_between(at(b) - at(c));
            let normal = (at(b) - at(a)).cross(at(c) - at(a)).normalize_or_zero();
            let edge = across.entry([a.min(b), a.max(b)]).or_default();
            edge.push((angle.to_degrees(), normal));
        }
    }
    let wrong = |edge: &&Vec<(f32, Vec3)>| {
        edge[0].0 + edge[1].0 > 180.6 && edge[0].1.dot(edge[1].1) > 0.996
    };
    across.values().filter(wrong).count()
}

#[neurotess_testing::test]
fn a_twisted_tube_gets_the_better_diagonals_and_keeps_its_vertices() {
    for twist in [0.06_f32, -0.06] {
        let line: Vec<Vec3> = (0..30).map(|n| Vec3::X * n as f32 * 0.3).collect();
        let mut mesh = tube(&line, 1.0, 24, 1);
        for vertex in &mut mesh.vertices {
            let turn = glam::Quat::from_rotation_x(twist * vertex.position.x / 0.3);
            vertex.position = turn * vertex.position;
        }
        let (as_it_was, before) = merged(&mesh, &BARE);
        let options = UnionOptions {
            least_angle: 1.0,
            ..BARE
        };
        let (chosen, after) = merged(&mesh, &options);
        let counts = [&as_it_was, &chosen].map(|union| edges_of_the_wrong_diagonal(&union.mesh));
        // The diagonal from the first corner is the right one for one of the two.
        assert_eq!(
            counts,
            if twist > 0.0 { [24 * 29, 0] } else { [0, 0] },
            "{twist}"
        );
        assert!(after.quality.min_angle >= before.quality.min_angle);
        let positions = |union: &neurotess_union::Union| union.mesh.positions();
        assert_eq!(positions(&as_it_was), positions(&chosen));
        // The better diagonal lies on the tube, the other one within it.
        assert!(after.volume >= before.volume);
        assert_near(after.volume, before.volume, 0.01);
    }
}

#[neurotess_testing::test]
fn what_would_cross_another_branch_stays() {
    // Two tubes with narrow faces side by side, a thousandth of a radius apart.
    let one = paired_rings(32);
    let mut other = one.clone();
    for vertex in &mut other.vertices {
        vertex.position.z += 2.001;
        vertex.section = 2;
    }
    let (union, report) = merged(&together(&[one, other]), &WIDE);
    assert!(union.report.improved > 0);
    assert_eq!(report.components, 2);
}

#[neurotess_testing::test]
fn seams_are_made_wider_too() {
    let mesh = together(&[
        straight([-4.0, 0.0, 0.0], [4.0, 0.0, 0.0], 1.0, 1),
        straight([0.1, -4.0, 0.2], [0.3, 4.0, 0.1], 0.7, 2),
    ]);
    let (_, before) = merged(&mesh, &UnionOptions::default());
    let options = UnionOptions {
        least_angle: 20.0,
        ..UnionOptions::default()
    };
    let (_, after) = merged(&mesh, &options);
    assert!(
        before.quality.min_angle < 11.0 && after.quality.min_angle > 19.5,
        "{:?} {:?}",
        before.quality,
        after.quality
    );
    assert_near(after.volume, before.volume, 0.01);
}
