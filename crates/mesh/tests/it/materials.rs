//! Groups of OBJ, materials of OBJ and GLB.

use std::collections::BTreeSet;
use std::io::Cursor;

use crate::shapes::{Blocks, json, neuron, torus, written};
use glam::{DAffine3, DVec3};
use neurotess_mesh::palette::{Palette, linear};
use neurotess_mesh::{
    FaceLabel, Format, GlbNode, Surface, SurfaceMesh, WriteOptions, check, obj_materials,
    read_bytes, region_name, write_glb, write_with,
};

fn with_options(surface: &dyn Surface, format: Format, options: &WriteOptions) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    write_with(surface, format, options, &mut file).expect("written");
    file.into_inner()
}

/// The names of the types of all triangles, then of quads.
fn names(mesh: &SurfaceMesh) -> Vec<String> {
    let name = |corners: [u32; 3]| {
        let label = FaceLabel::of(corners.map(|corner| &mesh.vertices[corner as usize]));
        (label.section, region_name(label.kind).into_owned())
    };
    let triangles = mesh.faces.triangles.iter().map(|&corners| name(corners).1);
    let quads = mesh.faces.quads.iter().map(|&[a, b, c, d]| {
        let halves = [[a, b, c], [a, c, d]].map(name);
        let nearer = halves.into_iter().min_by_key(|half| half.0);
        nearer.expect("two").1
    });
    triangles.chain(quads).collect()
}

#[neurotess_testing::test]
fn faces_of_an_obj_are_in_groups_by_type() {
    let mesh = neuron(DVec3::ZERO);
    let text = String::from_utf8(written(&mesh, Format::Obj)).expect("text");
    assert!(!text.contains("usemtl") && !text.contains("mtllib"));
    let (mut found, mut group, mut changes) = (Vec::new(), String::new(), 0);
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("g ") {
            assert_ne!(name, group, "a line that changes nothing");
            changes += 1;
            name.clone_into(&mut group);
        } else if line.starts_with("f ") {
            found.push(group.clone());
        }
    }
    assert_eq!(found, names(&mesh));
    let kinds: BTreeSet<&String> = found.iter().collect();
    assert_eq!(kinds.len(), 4);
    assert!(changes < 20, "{changes}");
}

#[neurotess_testing::test]
fn an_obj_names_its_materials_and_their_file() {
    let mesh = neuron(DVec3::ZERO);
    let options = WriteOptions {
        material_file: Some("a cell.mtl".into()),
        ..WriteOptions::default()
    };
    let mut file = Cursor::new(Vec::new());
    let kinds = write_with(&mesh, Format::Obj, &options, &mut file).expect("written");
    assert_eq!(kinds, BTreeSet::from([1, 2, 3, 4]));
    let text = String::from_utf8(file.into_inner()).expect("text");
    assert_eq!(text.lines().nth(1), Some("mtllib a cell.mtl"));
    let lines: Vec<&str> = text.lines().collect();
    for pair in lines.windows(2) {
        if let Some(name) = pair[0].strip_prefix("g ") {
            assert_eq!(pair[1], format!("usemtl {name}"));
        }
    }
    let materials = obj_materials(&kinds);
    let [r, g, b] = Palette::default()
        .of_type(2)
        .map(|byte| f32::from(byte) / 255.0);
    let axon = format!("newmtl axon\nKa 0 0 0\nKd {r:.4} {g:.4} {b:.4}\n");
    assert!(materials.contains(&axon), "{materials}");
    assert_eq!(materials.matches("newmtl ").count(), 4);
    let read = read_bytes(text.as_bytes(), Format::Obj).expect("read");
    assert_eq!(read.faces, mesh.faces);
}

fn colored() -> WriteOptions {
    WriteOptions {
        glb_materials: true,
        ..WriteOptions::default()
    }
}

#[neurotess_testing::test]
fn a_glb_has_a_primitive_and_a_material_for_each_type() {
    let mesh = neuron(DVec3::new(900.5, 0.0, 0.0));
    let bytes = with_options(&mesh, Format::Glb, &colored());
    let root = json(&bytes);
    let primitives = root["meshes"][0]["primitives"].as_array().expect("a list");
    assert_eq!(primitives.len(), 4);
    let mut triangles = 0;
    for (primitive, kind) in primitives.iter().zip(1..) {
        assert_eq!(
            primitive["attributes"], primitives[0]["attributes"],
            "one buffer"
        );
        let material = &root["materials"][primitive["material"].as_u64().expect("one") as usize];
        assert_eq!(material["name"], region_name(kind).as_ref());
        let color = &material["pbrMetallicRoughness"]["baseColorFactor"];
        for (n, light) in linear(Palette::default().of_type(kind)).iter().enumerate() {
            assert!((color[n].as_f64().expect("a number") - f64::from(*light)).abs() < 1e-4);
        }
        let indices = primitive["indices"].as_u64().expect("a number") as usize;
        triangles += root["accessors"][indices]["count"]
            .as_u64()
            .expect("a number");
    }
    let report = check(&read_bytes(&bytes, Format::Glb).expect("read"));
    assert!(report.closed && report.oriented && report.vertex_manifold);
    assert_eq!(report.vertices, mesh.vertices.len());
    assert_eq!(report.triangles as u64 * 3, triangles);
    let names = names(&read_bytes(&bytes, Format::Glb).expect("read"));
    assert!(names.is_sorted_by_key(|name| {
        ["soma", "axon", "basal_dendrite"]
            .iter()
            .position(|n| n == name)
            .unwrap_or(3)
    }));
}

#[neurotess_testing::test]
fn a_glb_without_materials_is_one_primitive_in_the_order_of_the_surface() {
    let mesh = neuron(DVec3::ZERO);
    let bytes = written(&mesh, Format::Glb);
    let root = json(&bytes);
    assert!(root.get("materials").is_none());
    assert_eq!(
        root["meshes"][0]["primitives"].as_array().map(Vec::len),
        Some(1)
    );
    let found = read_bytes(&bytes, Format::Glb).expect("read");
    assert_eq!(
        found.faces.triangles[..mesh.faces.triangles.len()],
        mesh.faces.triangles
    );
}

/// More types than the JSON of a GLB has room for: it is written again.
#[neurotess_testing::test]
fn many_types_have_room() {
    let mut mesh = torus(40, 12, DVec3::ZERO);
    for vertex in &mut mesh.vertices {
        vertex.kind = vertex.section - 3;
    }
    let bytes = with_options(&mesh, Format::Glb, &colored());
    let materials = json(&bytes)["materials"].as_array().map(Vec::len);
    assert!(materials > Some(50), "{materials:?}");
    let report = check(&read_bytes(&bytes, Format::Glb).expect("read"));
    assert!(report.closed && report.oriented);
    let length = u32::from_le_bytes(bytes[8..12].try_into().expect("four")) as usize;
    assert_eq!(length, bytes.len());
    let blocks = with_options(&Blocks(mesh, 7), Format::Glb, &colored());
    assert_eq!(
        json(&blocks)["materials"].as_array().map(Vec::len),
        materials
    );
}

#[neurotess_testing::test]
fn cells_of_a_circuit_share_materials() {
    let meshes = [
        neuron(DVec3::ZERO),
        neuron(DVec3::X),
        SurfaceMesh::default(),
    ];
    let surfaces = meshes.each_ref().map(|mesh| mesh as &dyn Surface);
    let nodes = [0, 1, 2, 1].map(|surface| GlbNode {
        name: format!("cell {surface}"),
        surface,
        world_from_surface: DAffine3::from_translation(DVec3::Y * 100.0 * surface as f64),
    });
    let mut file = Cursor::new(Vec::new());
    write_glb(&surfaces, &nodes, &colored(), &mut file).expect("written");
    let bytes = file.into_inner();
    assert_eq!(json(&bytes)["materials"].as_array().map(Vec::len), Some(4));
    let report = check(&read_bytes(&bytes, Format::Glb).expect("read"));
    assert!(report.closed && report.oriented);
    assert_eq!(
        (report.vertices, report.components),
        (3 * meshes[0].vertices.len(), 3)
    );
}
