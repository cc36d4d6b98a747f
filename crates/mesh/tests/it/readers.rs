//! Readers: variants of the formats, and faults with their place.

use crate::shapes::{torus, written};
use glam::DVec3;
use neurotess_mesh::{FilePosition, Format, ReadError, SurfaceMesh, check, read, read_bytes};

fn parse(text: &str, format: Format) -> SurfaceMesh {
    read_bytes(text.as_bytes(), format).expect("a valid file")
}

fn fault(bytes: &[u8], format: Format) -> ReadError {
    read_bytes(bytes, format).expect_err("a faulty file")
}

const PLY: &str = "ply\nformat ascii 1.0\ncomment hand-made\nelement vertex 4\n\
    property double x\nproperty float y\nproperty float z\nproperty uchar red\n\
    element face 2\nproperty list uchar int vertex_index\nproperty list uchar float texcoord\n\
    end_header\n0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0\n255\n3 0 1 2 0\n4 0 1 2 3 2 0.5 0.5\n";

#[neurotess_testing::test]
fn ply_text_with_other_properties() {
    let mesh = parse(PLY, Format::Ply);
    assert_eq!(mesh.vertices.len(), 4);
    assert_eq!(mesh.faces.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.faces.quads, [[0, 1, 2, 3]]);
}

#[neurotess_testing::test]
fn ply_big_endian() {
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\n\
        property float y\nproperty float z\nelement face 1\n\
        property list uchar uint vertex_indices\nend_header\n"
        .to_vec();
    for x in [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(x.to_be_bytes());
    }
    bytes.push(3);
    for index in [0u32, 1, 2] {
        bytes.extend(index.to_be_bytes());
    }
    let mesh = read_bytes(&bytes, Format::Ply).expect("valid");
    assert_eq!(mesh.vertices[1].position.to_array(), [1.0, 0.0, 0.0]);
    assert_eq!(mesh.faces.triangles, [[0, 1, 2]]);
}

#[neurotess_testing::test]
fn ply_header_that_lies_is_cut_off() {
    let lie = PLY.replace("vertex 4", "vertex 18446744073709551615");
    assert!(matches!(
        fault(lie.as_bytes(), Format::Ply),
        ReadError::Malformed { .. } | ReadError::Truncated { .. }
    ));
    let binary = String::from_utf8_lossy(&written(&SurfaceMesh::default(), Format::Ply))
        .replace("vertex 0", "vertex 4000000000")
        .replace("face 0", "face 18446744073709551615");
    assert!(matches!(
        fault(binary.as_bytes(), Format::Ply),
        ReadError::Truncated { .. }
    ));
    let nothing = "ply\nformat ascii 1.0\nelement dust 18446744073709551615\nend_header\n";
    assert_eq!(parse(nothing, Format::Ply), SurfaceMesh::default());
    let list = "ply\nformat binary_little_endian 1.0\nelement face 1\n\
        property list uint uchar vertex_indices\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}";
    assert!(matches!(
        fault(list.as_bytes(), Format::Ply),
        ReadError::Truncated { .. }
    ));
}

#[neurotess_testing::test]
fn faults_name_their_place() {
    let wrong = PLY.replace("1 1 0 255", "1 one 0 255");
    let error = fault(wrong.as_bytes(), Format::Ply);
    assert_eq!(error.place(), FilePosition::Line(15));
    assert_eq!(error.to_string(), "line 15: 'one': expected a number");
    let error = fault(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", Format::Obj);
    assert!(matches!(
        error,
        ReadError::BadIndex {
            at: FilePosition::Line(4),
            index: 3,
            vertices: 3
        }
    ));
    assert_eq!(
        fault(b"v 0 0 0\nf 0 1 2\n", Format::Obj).place(),
        FilePosition::Line(2)
    );
    assert_eq!(
        fault(b"v 0 0 0\nf 1 1\n", Format::Obj).place(),
        FilePosition::Line(2)
    );
    assert_eq!(
        fault(b"v nan 0 0\n", Format::Obj).place(),
        FilePosition::Line(1)
    );
    assert_eq!(
        fault(b"OFF\n9999999999999 0 0\n0 0 0\n", Format::Off).place(),
        FilePosition::Line(3)
    );
}

#[neurotess_testing::test]
fn obj_variants() {
    let mesh = parse(
        "# a fan, a quad and a triangle from behind\r\nmtllib x.mtl\r\no thing\r\nv 0 0 0 1.0\r\n\
         v 1 0 0\r\nv 1 1 0\r\nv 0 1 0 0.1 0.2 0.3\r\nv -1 0.5 0\r\nvt 0 0\r\nvn 0 0 1\r\n\
         f 1/1/1 2/1/1 3//1 4//1 5//1\r\nf 1 2 \\\r\n 3 4\r\nf -5 -4 -3\r\n",
        Format::Obj,
    );
    assert_eq!(
        mesh.faces.triangles,
        [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 1, 2]]
    );
    assert_eq!(mesh.faces.quads, [[0, 1, 2, 3]]);
}

#[neurotess_testing::test]
fn off_variants() {
    let plain = "OFF # comment\n# another\n3 1 0\n0 0 0\n1 0 0\n\n0 1 0\n3 0 1 2 255 0 0\n";
    let colored = "COFF 3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n";
    let bare = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let normals = "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n";
    for text in [plain, colored, bare, normals] {
        let mesh = parse(text, Format::Off);
        assert_eq!(
            (mesh.vertices.len(), &mesh.faces.triangles[..]),
            (3, &[[0, 1, 2]][..])
        );
    }
    assert!(matches!(
        fault(b"4OFF\n0 0 0\n", Format::Off),
        ReadError::Unsupported { .. }
    ));
    assert!(matches!(
        fault(b"OFF BINARY\n", Format::Off),
        ReadError::Unsupported { .. }
    ));
}

#[neurotess_testing::test]
fn stl_text_and_counts_that_lie() {
    let text = "solid x\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
        vertex 0 1 0\n  endloop\n endfacet\nendsolid x\n";
    assert_eq!(parse(text, Format::Stl).faces.triangles, [[0, 1, 2]]);
    assert!(read_bytes(&text.as_bytes()[..90], Format::Stl).is_err());
    let mut bytes = written(&torus(5, 4, DVec3::ZERO), Format::Stl);
    bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(matches!(
        fault(&bytes, Format::Stl),
        ReadError::Truncated { .. }
    ));
    bytes[80..84].copy_from_slice(&1u32.to_le_bytes());
    assert_eq!(fault(&bytes, Format::Stl).place(), FilePosition::Byte(80));
    // A binary file may begin as text does.
    let mut bytes = written(&torus(5, 4, DVec3::ZERO), Format::Stl);
    bytes[..5].copy_from_slice(b"solid");
    assert_eq!(
        read_bytes(&bytes, Format::Stl)
            .expect("binary")
            .faces
            .triangles
            .len(),
        40
    );
}

#[neurotess_testing::test]
fn gltf_with_embedded_data_and_nodes() {
    // Positions (0 0 0), (1 0 0), (0 1 0) as floats; the second node is mirrored and moved.
    let text = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0,"children":[1]},
        {"mesh":0,"scale":[-1,1,1],"translation":[0,0,5]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    let mesh = parse(text, Format::Glb);
    assert_eq!(mesh.faces.triangles, [[0, 1, 2], [3, 5, 4]]);
    assert_eq!(mesh.vertices[4].position.to_array(), [-1.0, 0.0, 5.0]);
    let cycle = text.replace(r#""translation""#, r#""children":[0],"translation""#);
    let cycle = cycle.replace(
        r#""nodes":[{"mesh":0,"ch"#,
        r#""scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"ch"#,
    );
    assert!(matches!(
        fault(cycle.as_bytes(), Format::Glb),
        ReadError::Malformed { .. }
    ));
    let lie = text.replace(r#""count":3"#, r#""count":99999999999999"#);
    assert!(matches!(
        fault(lie.as_bytes(), Format::Glb),
        ReadError::Truncated { .. }
    ));
    let separate = text.replace("data:application/octet-stream;base64,", "x.bin#");
    assert!(matches!(
        fault(separate.as_bytes(), Format::Glb),
        ReadError::Unsupported { .. }
    ));
}

#[neurotess_testing::test]
fn vtu_as_text_and_base64() {
    let text = r#"<?xml version="1.0"?><!-- <Piece> -->
        <VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
        <Piece NumberOfPoints="4" NumberOfCells="2"><Points>
        <DataArray type="Float32" NumberOfComponents="3" format="binary">JAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAA==</DataArray>
        </Points><Cells>
        <DataArray type="Int32" Name="connectivity">0 1 2 2 1 0</DataArray>
        <DataArray type="Int32" Name="offsets" format="ascii">3 6</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">5 5</DataArray>
        </Cells></Piece></UnstructuredGrid></VTKFile>"#;
    let mesh = parse(text, Format::Vtu);
    assert_eq!(mesh.faces.triangles, [[0, 1, 2], [2, 1, 0]]);
    assert_eq!(mesh.vertices[1].position.to_array(), [1.0, 0.0, 0.0]);
    let falling = text.replace("3 6</", "6 3</");
    assert!(matches!(
        fault(falling.as_bytes(), Format::Vtu),
        ReadError::Malformed { .. }
    ));
    let packed = text.replace("version=\"0.1\"", "compressor=\"vtkZLibDataCompressor\"");
    assert!(matches!(
        fault(packed.as_bytes(), Format::Vtu),
        ReadError::Unsupported { .. }
    ));
    let solid = text.replace("5 5</", "5 10</");
    assert!(matches!(
        fault(solid.as_bytes(), Format::Vtu),
        ReadError::Unsupported { .. }
    ));
}

#[neurotess_testing::test]
fn files_are_read_by_extension() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("torus.PLY");
    std::fs::write(&path, written(&torus(5, 4, DVec3::ZERO), Format::Ply)).expect("written");
    assert!(check(&read(&path).expect("read")).closed);
    assert!(matches!(
        read(&folder.path().join("torus.xyz")),
        Err(ReadError::Format(_))
    ));
    assert!(matches!(
        read(&folder.path().join("none.ply")),
        Err(ReadError::Io(_))
    ));
}
