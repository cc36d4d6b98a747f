//! Colors of vertices in PLY, VTU and GLB.

use std::io::Cursor;

use crate::shapes::{json, neuron, torus, written};
use glam::DVec3;
use neurotess_mesh::palette::{Palette, linear};
use neurotess_mesh::{
    ColorBy, Format, OwnAttribute, SurfaceMesh, WriteOptions, check, read_bytes_with_attributes,
    write_with,
};

fn colored(mesh: &SurfaceMesh, format: Format) -> Vec<u8> {
    let options = WriteOptions {
        color_by: Some(ColorBy::Type),
        ..WriteOptions::default()
    };
    let mut file = Cursor::new(Vec::new());
    write_with(mesh, format, &options, &mut file).expect("written");
    file.into_inner()
}

fn read(bytes: &[u8], format: Format) -> (SurfaceMesh, Vec<OwnAttribute>) {
    read_bytes_with_attributes(bytes, format).expect("read")
}

#[neurotess_testing::test]
fn vertices_of_ply_and_vtu_have_the_colors_of_their_types() {
    for origin in [DVec3::ZERO, DVec3::new(9e5, 0.5, 0.1)] {
        let mesh = torus(40, 30, origin);
        let expected = mesh.vertices.iter();
        let expected: Vec<[f64; 3]> = expected
            .map(|v| Palette::default().of_type(v.kind).map(f64::from))
            .collect();
        let (ply, found) = read(&colored(&mesh, Format::Ply), Format::Ply);
        let plain = read(&written(&mesh, Format::Ply), Format::Ply);
        assert_eq!((&ply, plain.1.len()), (&plain.0, 0));
        let names: Vec<&str> = found.iter().map(|a| &*a.name).collect();
        assert_eq!(names, ["red", "green", "blue"]);
        for (n, channel) in found.iter().enumerate() {
            assert!(channel.values.iter().eq(expected.iter().map(|rgb| &rgb[n])));
        }
        let (vtu, found) = read(&colored(&mesh, Format::Vtu), Format::Vtu);
        assert_eq!(vtu, read(&written(&mesh, Format::Vtu), Format::Vtu).0);
        assert_eq!(
            (found.len(), &*found[0].name, found[0].components),
            (1, "RGB", 3)
        );
        assert_eq!(found[0].values, expected.as_flattened());
    }
}

#[neurotess_testing::test]
fn vertices_of_a_glb_have_light_and_a_white_material_that_is_no_metal() {
    let mesh = neuron(DVec3::X);
    let bytes = colored(&mesh, Format::Glb);
    let root = json(&bytes);
    let primitive = &root["meshes"][0]["primitives"][0];
    let material = &root["materials"][primitive["material"].as_u64().expect("one") as usize];
    let look = &material["pbrMetallicRoughness"];
    assert_eq!(
        look["baseColorFactor"],
        serde_json::json!([1.0, 1.0, 1.0, 1.0])
    );
    assert_eq!(look["metallicFactor"], 0.0);
    let number = primitive["attributes"]["COLOR_0"].as_u64().expect("colors") as usize;
    let accessor = &root["accessors"][number];
    assert_eq!(
        (&accessor["normalized"], &accessor["type"]),
        (&true.into(), &"VEC3".into())
    );
    let stride = root["bufferViews"][0]["byteStride"].as_u64().expect("one") as usize;
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize;
    let first = 28 + length + accessor["byteOffset"].as_u64().expect("one") as usize;
    for (n, vertex) in mesh.vertices.iter().enumerate() {
        let expected = linear(Palette::default().of_type(vertex.kind));
        for (channel, light) in expected.into_iter().enumerate() {
            let at = first + n * stride + 2 * channel;
            let found = f32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])) / 65_535.0;
            assert!((found - light).abs() < 1e-5, "{found} {light}");
        }
    }
    let (found, own) = read(&bytes, Format::Glb);
    let plain = read(&written(&mesh, Format::Glb), Format::Glb).0;
    assert_eq!((found, own.len()), (plain, 0));
}

/// Where primitives have materials of types, their colors are not multiplied with those of vertices.
#[neurotess_testing::test]
fn materials_are_white_where_vertices_have_colors() {
    let options = WriteOptions {
        glb_materials: true,
        color_by: Some(ColorBy::Type),
        ..WriteOptions::default()
    };
    let mut file = Cursor::new(Vec::new());
    write_with(&neuron(DVec3::ZERO), Format::Glb, &options, &mut file).expect("written");
    let bytes = file.into_inner();
    let root = json(&bytes);
    let materials = root["materials"].as_array().expect("a list");
    let names: Vec<_> = materials.iter().map(|m| m["name"].as_str()).collect();
    assert_eq!(names[..2], [Some("soma"), Some("axon")]);
    for material in materials {
        let color = &material["pbrMetallicRoughness"]["baseColorFactor"];
        assert_eq!(*color, serde_json::json!([1.0, 1.0, 1.0, 1.0]));
    }
    let report = check(&read(&bytes, Format::Glb).0);
    assert!(report.closed && report.oriented);
}
