//! Topology of meshes with known defects.

use glam::Vec3;
use neurotess_mesh::{Faces, Topology, genus_by_component, topology};

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// Points in general position: no three on a line.
fn points(count: usize) -> Vec<Vec3> {
    (0..count as u32)
        .map(|n| n as f32)
        .map(|n| Vec3::new(n.sin() * 3.0, (2.3 * n).cos() * 2.0, n + (0.7 * n).sin()))
        .collect()
}

fn of_triangles(triangles: &[[u32; 3]], vertices: usize) -> Topology {
    topology(
        &points(vertices),
        &Faces {
            triangles: triangles.to_vec(),
            quads: vec![],
        },
    )
}

fn of_quads(quads: &[[u32; 4]], vertices: usize) -> Topology {
    topology(
        &points(vertices),
        &Faces {
            triangles: vec![],
            quads: quads.to_vec(),
        },
    )
}

fn cube() -> Vec<[u32; 4]> {
    vec![
        [0, 3, 2, 1],
        [4, 5, 6, 7],
        [0, 1, 5, 4],
        [1, 2, 6, 5],
        [2, 3, 7, 6],
        [3, 0, 4, 7],
    ]
}

fn sound(topology: Topology) -> bool {
    topology.closed
        && topology.edge_manifold
        && topology.vertex_manifold
        && topology.oriented
        && topology.degenerate_faces == 0
}

#[neurotess_testing::test]
fn tetrahedron_is_a_sphere() {
    let topology = of_triangles(&TETRAHEDRON, 4);
    assert!(sound(topology));
    assert_eq!(
        (topology.edges, topology.euler, topology.genus),
        (6, 2, Some(0))
    );
}

#[neurotess_testing::test]
fn cube_of_quads_is_a_sphere() {
    let topology = of_quads(&cube(), 8);
    assert!(sound(topology));
    assert_eq!(
        (topology.edges, topology.euler, topology.components),
        (12, 2, 1)
    );
}

fn torus() -> Vec<[u32; 4]> {
    let at = |i: u32, j: u32| (i % 5) * 4 + j % 4;
    (0..5)
        .flat_map(|i| (0..4).map(move |j| (i, j)))
        .map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
        .collect()
}

#[neurotess_testing::test]
fn torus_has_genus_one() {
    let topology = of_quads(&torus(), 20);
    assert!(sound(topology));
    assert_eq!((topology.euler, topology.genus), (0, Some(1)));
}

#[neurotess_testing::test]
fn each_component_has_its_own_handles() {
    // A cube from vertex 1 on, a torus from 9 on, and a tetrahedron from 30 on.
    let shifted = |quad: &[u32; 4], by: u32| quad.map(|corner| corner + by);
    let quads = torus()
        .iter()
        .map(|quad| shifted(quad, 9))
        .collect::<Vec<_>>();
    let cube = cube()
        .iter()
        .map(|quad| shifted(quad, 1))
        .collect::<Vec<_>>();
    let faces = Faces {
        triangles: TETRAHEDRON
            .map(|face| face.map(|corner| corner + 30))
            .to_vec(),
        quads: [quads, cube].concat(),
    };
    assert_eq!(genus_by_component(40, &faces), [0, 1, 0]);
    assert_eq!(topology(&points(40), &faces).genus, Some(1));
    assert!(genus_by_component(3, &Faces::default()).is_empty());
}

#[neurotess_testing::test]
fn open_box_is_manifold_but_not_closed() {
    let topology = of_quads(&cube()[1..], 8);
    assert!(!topology.closed && topology.edge_manifold && topology.vertex_manifold);
    assert_eq!((topology.euler, topology.genus), (1, None));
}

#[neurotess_testing::test]
fn flipped_face_is_not_oriented() {
    let mut faces = TETRAHEDRON;
    faces[2].swap(0, 1);
    let topology = of_triangles(&faces, 4);
    assert!(topology.closed && topology.vertex_manifold && !topology.oriented);
}

#[neurotess_testing::test]
fn three_faces_on_an_edge_are_not_manifold() {
    let topology = of_triangles(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5);
    assert!(!topology.edge_manifold && !topology.vertex_manifold && !topology.closed);
}

#[neurotess_testing::test]
fn tetrahedra_that_share_a_vertex_are_not_vertex_manifold() {
    let mut faces = TETRAHEDRON.to_vec();
    faces.extend(TETRAHEDRON.map(|face| face.map(|v| if v == 0 { 0 } else { v + 3 })));
    let topology = of_triangles(&faces, 7);
    assert!(topology.closed && topology.edge_manifold && !topology.vertex_manifold);
    assert_eq!(
        (topology.components, topology.euler, topology.genus),
        (1, 3, None)
    );
}

#[neurotess_testing::test]
fn duplicate_face_breaks_the_edges() {
    let mut faces = TETRAHEDRON.to_vec();
    faces.push(TETRAHEDRON[0]);
    let topology = of_triangles(&faces, 4);
    assert!(!topology.closed && !topology.edge_manifold && !topology.oriented);
}

#[neurotess_testing::test]
fn isolated_vertex_is_not_used() {
    let topology = of_triangles(&TETRAHEDRON, 5);
    assert!(sound(topology));
    assert_eq!(
        (topology.vertices, topology.used_vertices, topology.euler),
        (5, 4, 2)
    );
}

#[neurotess_testing::test]
fn degenerate_triangle_is_counted() {
    let mut faces = TETRAHEDRON.to_vec();
    faces.push([0, 1, 1]);
    let topology = of_triangles(&faces, 4);
    assert_eq!((topology.degenerate_faces, topology.faces), (1, 4));
    let line = [Vec3::ZERO, Vec3::X, Vec3::X * 3.0];
    let flat = topology_of_one(line);
    assert_eq!((flat.degenerate_faces, flat.faces), (1, 1));
}

fn topology_of_one(positions: [Vec3; 3]) -> Topology {
    topology(
        &positions,
        &Faces {
            triangles: vec![[0, 1, 2]],
            quads: vec![],
        },
    )
}

#[neurotess_testing::test]
fn quad_with_a_repeated_corner_is_a_triangle() {
    let mut faces = Faces {
        triangles: TETRAHEDRON[1..].to_vec(),
        quads: vec![[0, 2, 2, 1]],
    };
    let topology = topology(&points(4), &faces);
    assert!(topology.closed && topology.oriented);
    assert_eq!((topology.degenerate_faces, topology.euler), (1, 2));
    faces.quads[0] = [0, 2, 0, 1];
    assert!(!neurotess_mesh::topology(&points(4), &faces).closed);
}

#[neurotess_testing::test]
fn components_are_counted() {
    let mut faces = TETRAHEDRON.to_vec();
    faces.extend(TETRAHEDRON.map(|face| face.map(|v| v + 4)));
    let topology = of_triangles(&faces, 8);
    assert!(sound(topology));
    assert_eq!(
        (topology.components, topology.euler, topology.genus),
        (2, 4, Some(0))
    );
}

#[neurotess_testing::test]
fn no_faces_are_closed_and_empty() {
    let topology = of_triangles(&[], 0);
    assert!(sound(topology));
    assert_eq!((topology.components, topology.genus), (0, Some(0)));
}
