//! Several surfaces in one GLB, each shown as often as it stands somewhere.

use std::io::Cursor;

use glam::{DAffine3, DQuat, DVec3, Vec3};
use neurotess_mesh::{
    Faces, Format, GlbNode, Placed, Surface, SurfaceMesh, SurfaceVertex, WriteOptions, check,
    read_bytes, write_glb,
};

fn tetrahedron(size: f32, origin: DVec3) -> SurfaceMesh {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let vertex = |corner: Vec3| SurfaceVertex {
        position: corner * size,
        normal: (corner - 0.25).normalize_or(Vec3::X),
        radius: size,
        ..SurfaceVertex::default()
    };
    SurfaceMesh {
        origin,
        vertices: corners.map(vertex).to_vec(),
        faces: Faces {
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            quads: Vec::new(),
        },
    }
}

fn node(surface: usize, translation: DVec3) -> GlbNode {
    GlbNode {
        name: format!("cell {surface}"),
        surface,
        world_from_surface: DAffine3::from_scale_rotation_translation(
            DVec3::splat(1.5),
            DQuat::from_rotation_y(0.7),
            translation,
        ),
    }
}

#[neurotess_testing::test]
fn surfaces_are_read_back_where_their_nodes_stand() {
    let meshes = [
        tetrahedron(1.0, DVec3::new(5.0, 0.0, 0.0)),
        SurfaceMesh::default(),
        tetrahedron(3.0, DVec3::ZERO),
    ];
    let surfaces = meshes.each_ref().map(|mesh| mesh as &dyn Surface);
    // The empty one is shown too, and leaves nothing.
    let nodes = [
        node(2, DVec3::new(1e4, 0.0, 0.0)),
        node(0, DVec3::ZERO),
        node(1, DVec3::ZERO),
        node(0, DVec3::new(0.0, -700.0, 0.0)),
    ];
    let mut file = Cursor::new(Vec::new());
    write_glb(&surfaces, &nodes, &WriteOptions::default(), &mut file).expect("written");
    let bytes = file.into_inner();
    let read = read_bytes(&bytes, Format::Glb).expect("read");
    let mut expected = Vec::new();
    for node in &nodes {
        let placed = Placed::new(surfaces[node.surface], node.world_from_surface);
        let mesh = SurfaceMesh::collect(&placed);
        let positions = mesh
            .vertices
            .iter()
            .map(|v| mesh.origin + v.position.as_dvec3());
        expected.extend(positions);
    }
    let mut found: Vec<DVec3> = read
        .vertices
        .iter()
        .map(|v| read.origin + v.position.as_dvec3())
        .collect();
    assert_eq!(found.len(), expected.len());
    let key = |p: &DVec3| p.to_array().map(|c| (c * 100.0).round() as i64);
    found.sort_by_key(key);
    expected.sort_by_key(key);
    for (found, expected) in found.iter().zip(&expected) {
        assert!(found.distance(*expected) < 2e-3, "{found} {expected}");
    }
    let report = check(&read);
    assert!(report.closed && report.components == 3);
    // Each surface is in the file once.
    let json = u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize;
    assert_eq!(bytes.len() - 28 - json, 40 * 8 + 12 * 8);
    assert!(json < 6000, "{json}");
}

#[neurotess_testing::test]
fn nothing_is_a_scene_without_nodes() {
    let mut file = Cursor::new(Vec::new());
    write_glb(&[], &[], &WriteOptions::default(), &mut file).expect("written");
    let read = read_bytes(&file.into_inner(), Format::Glb).expect("read");
    assert!(read.vertices.is_empty());
}
