//! GLB with triangles that Draco compressed.

use std::collections::BTreeMap;
use std::io::Cursor;

use crate::attributes::With;
use crate::shapes::{json, neuron, torus, written};
use glam::{DAffine3, DVec3, Vec3};
use neurotess_mesh::{
    ColorBy, Compression, Format, GlbNode, Surface, SurfaceMesh, VertexAttribute, WALL,
    WriteOptions, check, read_bytes, read_bytes_with_attributes, write_glb, write_with,
};

pub(crate) fn draco() -> WriteOptions {
    WriteOptions {
        compression: Some(Compression::Draco),
        ..WriteOptions::default()
    }
}

pub(crate) fn compressed(surface: &dyn Surface) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    write_with(surface, Format::Glb, &draco(), &mut file).expect("written");
    file.into_inner()
}

/// Each vertex by its place, on a grid that is far finer than the mesh and coarser than what was rounded.
fn by_place(mesh: &SurfaceMesh) -> BTreeMap<[i64; 3], usize> {
    let place = |p: Vec3| {
        (p.as_dvec3() + mesh.origin)
            .to_array()
            .map(|c| (c * 50.0).round() as i64)
    };
    let vertices = mesh.vertices.iter().enumerate();
    vertices.map(|(n, v)| (place(v.position), n)).collect()
}

#[neurotess_testing::test]
fn a_compressed_glb_reads_back() {
    for mesh in [
        neuron(DVec3::new(900.0, 0.0, 0.25)),
        torus(48, 16, DVec3::ZERO),
    ] {
        let bytes = compressed(&mesh);
        let root = json(&bytes);
        let extension = serde_json::json!(["KHR_draco_mesh_compression"]);
        assert_eq!(
            (&root["extensionsUsed"], &root["extensionsRequired"]),
            (&extension, &extension)
        );
        let plain = written(&mesh, Format::Glb);
        assert!(
            4 * bytes.len() < plain.len(),
            "{} of {}",
            bytes.len(),
            plain.len()
        );
        let found = read_bytes(&bytes, Format::Glb).expect("read");
        let (report, expected) = (
            check(&found),
            check(&read_bytes(&plain, Format::Glb).expect("read")),
        );
        assert!(report.closed && report.oriented && report.vertex_manifold);
        assert_eq!(
            (report.vertices, report.triangles, report.euler),
            (expected.vertices, expected.triangles, expected.euler)
        );
        // The voxels have a few coordinates only, so that all are rounded the same way.
        assert!((report.volume / expected.volume - 1.0).abs() < 5e-4);
        let (old, new) = (by_place(&mesh), by_place(&found));
        assert_eq!(old.len(), mesh.vertices.len(), "the grid is fine enough");
        for (place, &n) in &old {
            let near =
                (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| [x, y, z])));
            let mut near = near.map(|by| std::array::from_fn(|i| place[i] + by[i]));
            let found =
                &found.vertices[near.find_map(|at| new.get(&at).copied()).expect("a vertex")];
            let vertex = &mesh.vertices[n];
            assert_eq!(
                (found.kind, found.point, found.section),
                (vertex.kind, vertex.point, vertex.section)
            );
            assert!((found.radius - vertex.radius).abs() < 1e-3);
            assert!(
                found.normal.dot(vertex.normal) > 0.9999,
                "{} {}",
                found.normal,
                vertex.normal
            );
        }
    }
}

/// Integers of 8 and 16 bits where they do, floats that round to the number elsewhere.
#[neurotess_testing::test]
fn whole_numbers_are_exact() {
    for (first, step, component) in [
        (0, 1, 5121),
        (-1, 9, 5122),
        (0, 340, 5123),
        (70_000, 2, 5126),
        (-5, 80_000, 5126),
        (WALL, 5_000, 5126),
        (i32::MAX - 700, 1, 5126),
    ] {
        let mut mesh = torus(12, 16, DVec3::ZERO);
        let mut expected = Vec::new();
        for (n, vertex) in (0..).zip(&mut mesh.vertices) {
            vertex.point = first + n * step;
            // What floats of GLB hold anyway.
            expected.push((vertex.point as f32) as i32);
        }
        let bytes = compressed(&mesh);
        let root = json(&bytes);
        let primitive = &root["meshes"][0]["primitives"][0];
        let number = primitive["attributes"]["_POINT"]
            .as_u64()
            .expect("a number");
        assert_eq!(
            root["accessors"][number as usize]["componentType"],
            component
        );
        let found = read_bytes(&bytes, Format::Glb).expect("read");
        let mut found: Vec<i32> = found.vertices.iter().map(|v| v.point).collect();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected, "from {first}");
    }
}

#[neurotess_testing::test]
fn numbers_of_ones_own_are_kept() {
    let mesh = torus(20, 9, DVec3::ZERO);
    let count = mesh.vertices.len();
    let layer: Vec<f32> = (0..count).map(|n| (n % 7) as f32).collect();
    let voltage: Vec<f32> = (0..2 * count).map(|n| -65.0 + 0.3 * n as f32).collect();
    let gaps: Vec<f32> = (0..count)
        .map(|n| if n == 3 { f32::NAN } else { n as f32 + 0.5 })
        .collect();
    let same = vec![4.25; count];
    let attribute = |name, components, values| VertexAttribute {
        name,
        components,
        values,
    };
    let own = vec![
        attribute("Layer", 1, &layer[..]),
        attribute("voltage", 2, &voltage[..]),
        attribute("gaps", 1, &gaps[..]),
        attribute("same", 1, &same[..]),
    ];
    let points: Vec<usize> = mesh
        .vertices
        .iter()
        .map(|v| (v.point + 1) as usize)
        .collect();
    let bytes = compressed(&With(mesh, own));
    let (found, own) = read_bytes_with_attributes(&bytes, Format::Glb).expect("read");
    let mut by_name: BTreeMap<&str, &[f64]> = BTreeMap::new();
    for attribute in &own {
        by_name.insert(&attribute.name, &attribute.values);
    }
    assert_eq!(
        by_name.keys().copied().collect::<Vec<_>>(),
        ["Layer", "gaps", "same", "voltage"]
    );
    assert_eq!(points, (0..count).collect::<Vec<_>>());
    for (new, vertex) in found.vertices.iter().enumerate() {
        let old = (vertex.point + 1) as usize;
        assert_eq!(by_name["Layer"][new], f64::from(layer[old]));
        for side in 0..2 {
            let (found, told) = (by_name["voltage"][2 * new + side], voltage[2 * old + side]);
            assert!((found - f64::from(told)).abs() < 1e-4);
        }
        assert!(by_name["gaps"][new] == f64::from(gaps[old]) || old == 3);
        assert_eq!(by_name["same"][new], 4.25);
    }
}

#[neurotess_testing::test]
fn cells_of_a_circuit_share_streams() {
    let meshes = [
        neuron(DVec3::ZERO),
        torus(12, 7, DVec3::X),
        SurfaceMesh::default(),
    ];
    let surfaces = meshes.each_ref().map(|mesh| mesh as &dyn Surface);
    let nodes = [0, 1, 2, 1, 0].map(|surface| GlbNode {
        name: format!("cell {surface}"),
        surface,
        world_from_surface: DAffine3::from_translation(DVec3::Y * 100.0 * surface as f64),
    });
    let options = WriteOptions {
        color_by: Some(ColorBy::Type),
        ..draco()
    };
    let mut file = Cursor::new(Vec::new());
    write_glb(&surfaces, &nodes, &options, &mut file).expect("written");
    let bytes = file.into_inner();
    let root = json(&bytes);
    let count = |name: &str| root[name].as_array().map(Vec::len);
    assert_eq!(
        (
            count("bufferViews"),
            count("meshes"),
            count("nodes"),
            count("materials")
        ),
        (Some(2), Some(2), Some(4), Some(1))
    );
    let report = check(&read_bytes(&bytes, Format::Glb).expect("read"));
    assert!(report.closed && report.oriented);
    assert_eq!(
        report.vertices,
        2 * meshes[0].vertices.len() + 2 * meshes[1].vertices.len()
    );
}

#[neurotess_testing::test]
fn what_is_empty_or_broken_is_told() {
    let empty = compressed(&SurfaceMesh::default());
    assert_eq!(
        read_bytes(&empty, Format::Glb)
            .expect("read")
            .vertices
            .len(),
        0
    );
    let mut lost = torus(4, 3, DVec3::ZERO);
    lost.vertices[5].position.y = f32::NAN;
    let error = write_with(&lost, Format::Glb, &draco(), &mut Cursor::new(Vec::new()));
    assert!(error.expect_err("lost").to_string().contains("vertex 5"));
    let bytes = compressed(&torus(9, 5, DVec3::ZERO));
    let mut cut = bytes.clone();
    // Within the stream, behind its header.
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize;
    cut[length + 28 + 12..length + 28 + 40].fill(0xff);
    let error = read_bytes(&cut, Format::Glb)
        .expect_err("broken")
        .to_string();
    assert!(error.contains("Draco"), "{error}");
}
