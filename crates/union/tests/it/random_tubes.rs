//! Any tubes: closed, manifold, free of crossings, and of the volume that another way gives.

use crate::shapes::{BARE, merged, together, tube};
use glam::Vec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{MeshGL64, WindingRule};
use neurotess_mesh::SurfaceMesh;
use neurotess_union::UnionOptions;
use proptest::prelude::*;

/// Tubes within a box of 10 µm.
fn tubes(lines: &[Vec<[f32; 3]>], sides: u32) -> SurfaceMesh {
    let bodies: Vec<SurfaceMesh> = (1..)
        .zip(lines)
        .filter_map(|(section, line)| {
            let mut line: Vec<Vec3> = line.iter().copied().map(Vec3::from).collect();
            line.dedup_by(|a, b| a.distance(*b) < 0.5);
            // A tube that turns back has no direction there.
            let turns_back = line.windows(3).any(|w| (w[2] - w[0]).length() < 0.5);
            let radius = 0.3 + 0.1 * (section % 5) as f32;
            (line.len() > 1 && !turns_back).then(|| tube(&line, radius, sides, section))
        })
        .collect();
    together(&bodies)
}

/// The volume where the winding number is 1 or more, by the whole pipeline of another crate.
fn reference_volume(mesh: &SurfaceMesh) -> f64 {
    let quads = mesh.faces.quads.iter();
    let halves = quads.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let triangles = mesh.faces.triangles.iter().copied().chain(halves);
    let positions = mesh.vertices.iter();
    let soup = MeshGL64 {
        num_prop: 3,
        vert_properties: positions
            .flat_map(|v| v.position.as_dvec3().to_array())
            .collect(),
        tri_verts: triangles.flatten().map(u64::from).collect(),
        ..MeshGL64::default()
    };
    Manifold::from_mesh_gl64_robust(&soup)
        .rebuild_solid(WindingRule::Positive)
        .volume()
}

fn line() -> impl Strategy<Value = Vec<[f32; 3]>> {
    prop::collection::vec(prop::array::uniform3(-5.0f32..5.0), 2..6)
}

/// On a lattice much is coplanar, coincides or touches.
fn lattice_line() -> impl Strategy<Value = Vec<[f32; 3]>> {
    prop::collection::vec(prop::array::uniform3(-2i8..3), 2..5).prop_map(|line| {
        line.into_iter()
            .map(|p| p.map(|x| 2.0 * f32::from(x)))
            .collect()
    })
}

/// A soak found it: sheets so near to one another that rounding made them cross after each cut.
#[neurotess_testing::test]
fn sheets_that_nearly_coincide_are_pressed_apart() {
    let lines = [
        vec![[0.0, 2.0, 0.0], [0.0, 0.0, 0.0]],
        vec![[0.0, 0.0, -2.0], [2.0, 0.0, 0.0]],
        vec![[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        vec![
            [2.0, 0.0, -2.0],
            [4.0, 0.0, 2.0],
            [0.0, 0.0, -2.0],
            [4.0, 0.0, 0.0],
        ],
        vec![[2.0, -2.0, -2.0], [4.0, 0.0, 0.0]],
    ];
    merged(&tubes(&lines, 8), &UnionOptions::default());
}

/// A soak found it: a tube that folds onto itself touches along an edge whose ends are one fan each.
#[neurotess_testing::test]
fn an_edge_of_four_faces_becomes_two() {
    let lines = [
        vec![[0.0, -2.0, -4.0], [0.0, -2.0, 0.0]],
        vec![[0.0, 0.0, -4.0], [0.0, -2.0, -4.0], [2.0, 0.0, -4.0]],
    ];
    merged(&tubes(&lines, 3), &UnionOptions::default());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(16, 48)))]

    #[neurotess_testing::test]
    fn tubes_become_fair_surfaces(lines in prop::collection::vec(line(), 1..6), sides in 3u32..9) {
        let mesh = tubes(&lines, sides);
        let (union, _) = merged(&mesh, &UnionOptions::default());
        // What is merged needs no merging.
        let (again, _) = merged(&union.mesh, &UnionOptions::default());
        prop_assert_eq!(again.report.rounds, 0);
        prop_assert_eq!(again.mesh.faces, union.mesh.faces);
        // Wider triangles are as many pieces with as many handles, and still do not cross.
        let options = UnionOptions { least_angle: 20.0, ..UnionOptions::default() };
        let (wider, _) = merged(&mesh, &options);
        prop_assert_eq!(wider.report.components, union.report.components);
        prop_assert_eq!(wider.report.handles, union.report.handles);
        // Pressed in first, they may be other pieces, but as sound.
        merged(&mesh, &UnionOptions { press: 0.6, ..options });
    }

    #[neurotess_testing::test]
    fn volumes_are_those_of_another_way(lines in prop::collection::vec(line(), 1..5)) {
        let mesh = tubes(&lines, 6);
        let (union, report) = merged(&mesh, &BARE);
        let expected = reference_volume(&mesh);
        // Splinters are left out. Sheets that touch are parted by a share of the radius: of these short
        // tubes, with bends like hairpins, that is more.
        let margin = if union.report.parted == 0 { 1e-3 } else { 2e-2 };
        prop_assert!((report.volume - expected).abs() < margin * expected.abs() + 1e-6,
            "{} and {}", report.volume, expected);
    }

    #[neurotess_testing::test]
    fn tubes_on_a_lattice_become_fair_surfaces(
        lines in prop::collection::vec(lattice_line(), 1..6),
        sides in 3u32..9,
    ) {
        merged(&tubes(&lines, sides), &UnionOptions::default());
    }
}
