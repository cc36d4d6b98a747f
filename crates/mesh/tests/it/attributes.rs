//! Numbers of one's own in files.

use std::io::Cursor;

use glam::{DVec3, Vec3};
use neurotess_mesh::{
    Faces, Format, Surface, SurfaceMesh, SurfaceVertex, VertexAttribute, WriteError,
    forward_surface, read_bytes, write,
};

/// A surface with numbers of one's own.
struct With<'a>(SurfaceMesh, Vec<VertexAttribute<'a>>);

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
