//! Numbers of one's own in files.

use std::io::Cursor;

use glam::{DVec3, Vec3};
use neurotess_mesh::{
    Faces, Format, Surface, SurfaceMesh, SurfaceVertex, VertexAttribute, WriteError,
    forward_surface, read_bytes, read_bytes_with_attributes, write,
};

/// A surface with numbers of one's own.
pub(crate) struct With<'a>(pub(crate) SurfaceMesh, pub(crate) Vec<VertexAttribute<'a>>);

impl Surface for With<'_> {
    forward_surface!(
        0: origin unit vertex_count triangle_count quad_count vertex_blocks vertices face_blocks faces
    );

    fn attributes(&self) -> &[VertexAttribute<'_>] {
        &self.1
    }
}

/// More vertices than a group has, so that rows of several groups follow one another.
fn strip(count: u32, origin: DVec3) -> SurfaceMesh {
    let vertex = |n: u32| SurfaceVertex {
        position: Vec3::new(n as f32, (n % 2) as f32, 0.0),
        normal: Vec3::Z,
        kind: 3,
        point: n as i32,
        section: 1,
        radius: 0.5,
    };
    SurfaceMesh {
        origin,
        vertices: (0..count).map(vertex).collect(),
        faces: Faces {
            triangles: (2..count).map(|n| [n - 2, n - 1, n]).collect(),
            quads: vec![[0, 1, 3, 2]],
        },
    }
}

fn written(surface: &dyn Surface, format: Format) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    write(surface, format, &mut file).expect("written");
    file.into_inner()
}

#[neurotess_testing::test]
fn files_hold_numbers_of_ones_own_and_read_as_before() {
    const COUNT: u32 = 10_000;
    let far: Vec<f32> = (0..COUNT).map(|n| 0.25 * n as f32 - 7.0).collect();
    let colors: Vec<f32> = (0..4 * COUNT).map(|n| (n % 11) as f32 / 11.0).collect();
    for origin in [DVec3::ZERO, DVec3::new(1e6, 0.0, 3.0)] {
        let plain = strip(COUNT, origin);
        let own = vec![
            VertexAttribute {
                name: "far",
                components: 1,
                values: &far,
            },
            VertexAttribute {
                name: "COLOR_0",
                components: 4,
                values: &colors,
            },
        ];
        let surface = With(plain.clone(), own);
        for format in [Format::Ply, Format::Vtu, Format::Glb] {
            let (before, after) = (written(&plain, format), written(&surface, format));
            let grown = after.len() - before.len();
            let numbers = 20 * COUNT as usize;
            assert!(
                (numbers..numbers + 1000).contains(&grown),
                "{format}: {grown}"
            );
            let read = |bytes: &[u8]| read_bytes(bytes, format).expect("read");
            assert_eq!(read(&after), read(&before), "{format}");
        }
        for format in [Format::Obj, Format::Stl, Format::Off] {
            assert_eq!(
                written(&plain, format),
                written(&surface, format),
                "{format}"
            );
        }
    }
}

/// Numbers with one, two, three and four of a vertex, with names that files write in several ways.
fn of_ones_own(numbers: &[f32]) -> Vec<VertexAttribute<'_>> {
    let of = |name, components| VertexAttribute {
        name,
        components,
        values: &numbers[..numbers.len() / 4 * components],
    };
    vec![
        of("far", 1),
        of("voltage_mV", 1),
        of("FAR", 1),
        of("uv", 2),
        of("uv_0", 1),
        of("direction", 3),
        of("weights", 4),
    ]
}

/// A small file with numbers of one's own.
pub(crate) fn with_numbers(format: Format) -> Vec<u8> {
    let numbers: Vec<f32> = (0..40).map(|n| n as f32).collect();
    let surface = With(strip(10, DVec3::ZERO), of_ones_own(&numbers));
    written(&surface, format)
}

#[neurotess_testing::test]
fn numbers_of_ones_own_are_read_back() {
    const COUNT: u32 = 5000;
    let mut numbers: Vec<f32> = (0..4 * COUNT).map(|n| (n as f32).sin()).collect();
    numbers[7] = f32::NAN;
    let own = of_ones_own(&numbers);
    let mesh = strip(COUNT, DVec3::new(1e6, 0.5, 3.0));
    let surface = With(mesh, own.clone());
    for format in [Format::Ply, Format::Vtu, Format::Glb] {
        let bytes = written(&surface, format);
        let (read, mut found) = read_bytes_with_attributes(&bytes, format).expect("read");
        assert_eq!(
            Ok(read),
            read_bytes(&bytes, format).map_err(drop),
            "{format}"
        );
        // The JSON of a GLB has no order.
        let place = |name: &str| own.iter().position(|a| a.name == name);
        found.sort_by_key(|a| place(&a.name));
        assert_eq!(found.len(), own.len(), "{format}");
        for (found, own) in found.iter().zip(&own) {
            assert_eq!(
                (&found.name[..], found.components),
                (own.name, own.components)
            );
            let bits = found.values.iter().map(|&v| (v as f32).to_bits());
            assert!(
                bits.eq(own.values.iter().map(|v| v.to_bits())),
                "{format}: {}",
                own.name
            );
            assert!(found.single);
        }
    }
}

#[neurotess_testing::test]
fn attributes_of_other_programs_are_read() {
    let text = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nproperty uchar red\nproperty list uchar int ring\nproperty double von-Mises\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 255 2 7 8 0.1\n1 0 0 0 0 1e300\n0 1 0 9 1 4 -1\n3 0 1 2\n";
    let (mesh, found) = read_bytes_with_attributes(text, Format::Ply).expect("read");
    assert_eq!((mesh.vertices.len(), mesh.faces.triangles.len()), (3, 1));
    let told = found.iter().map(|a| (&a.name[..], a.single, &a.values[..]));
    let expected = [
        ("red", true, &[255.0, 0.0, 9.0][..]),
        ("von_Mises", false, &[0.1, 1e300, -1.0]),
    ];
    assert!(told.eq(expected), "{found:?}");

    let text = br#"<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece>
        <PointData><DataArray type="Float64" Name="charge density" format="ascii">1 2 3</DataArray>
        <DataArray type="String" Name="notes" format="ascii">a b c</DataArray>
        <DataArray type="Float32" Name="stress" NumberOfComponents="9" format="ascii">1</DataArray></PointData>
        <Points><DataArray type="Float32" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>
        <Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>
        <DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells>
        </Piece></UnstructuredGrid></VTKFile>"#;
    let (_, found) = read_bytes_with_attributes(text, Format::Vtu).expect("read");
    assert_eq!(found.len(), 1);
    assert_eq!(
        (&found[0].name[..], &found[0].values[..]),
        ("charge_density", &[1.0, 2.0, 3.0][..])
    );
    let wrong = String::from_utf8_lossy(text).replace("1 2 3", "1 2");
    let error = read_bytes_with_attributes(wrong.as_bytes(), Format::Vtu).expect_err("too few");
    let told = error.to_string();
    assert!(
        told.contains("2 numbers of 'charge density' for 3 points"),
        "{told}"
    );
}

#[neurotess_testing::test]
fn too_few_numbers_are_an_error() {
    let own = VertexAttribute {
        name: "few",
        components: 1,
        values: &[1.0],
    };
    let surface = With(strip(5, DVec3::ZERO), vec![own]);
    let failed = write(&surface, Format::Ply, &mut Cursor::new(Vec::new()));
    assert!(matches!(
        failed,
        Err(WriteError::Inconsistent {
            announced: 5,
            found: 1,
            ..
        })
    ));
}
