//! What the writers write, the readers read.

use std::io::{Cursor, Seek, SeekFrom, Write};

use crate::shapes::{Blocks, torus, written};
use glam::DVec3;
use neurotess_mesh::{
    Faces, Format, Surface, SurfaceMesh, SurfaceVertex, WriteError, check, merge_identical,
    read_bytes, write,
};

fn round(mesh: &SurfaceMesh, format: Format) -> SurfaceMesh {
    read_bytes(&written(mesh, format), format).expect("our own file reads")
}

/// Quads as the triangles that formats without them hold, after the triangles.
fn split(mesh: &SurfaceMesh) -> SurfaceMesh {
    let mut mesh = mesh.clone();
    for [a, b, c, d] in std::mem::take(&mut mesh.faces.quads) {
        mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

#[neurotess_testing::test]
fn ply_and_vtu_keep_everything() {
    let mesh = torus(40, 12, DVec3::ZERO);
    assert_eq!(round(&mesh, Format::Ply), mesh);
    assert_eq!(round(&mesh, Format::Vtu), mesh);
}

#[neurotess_testing::test]
fn glb_keeps_everything_but_quads() {
    let mut expected = split(&torus(40, 12, DVec3::ZERO));
    let mut found = round(&torus(40, 12, DVec3::ZERO), Format::Glb);
    for (vertex, expected) in found.vertices.iter_mut().zip(&expected.vertices) {
        // The reader makes normals unit length again.
        assert!((vertex.normal - expected.normal).length() < 1e-6);
        vertex.normal = expected.normal;
    }
    expected.faces.triangles.sort_unstable();
    found.faces.triangles.sort_unstable();
    assert_eq!(found, expected);
}

#[neurotess_testing::test]
fn text_keeps_positions_exactly() {
    let mesh = torus(40, 12, DVec3::ZERO);
    for format in [Format::Obj, Format::Off] {
        let found = round(&mesh, format);
        assert_eq!(found.faces, mesh.faces, "{format}");
        assert_eq!(found.positions(), mesh.positions(), "{format}");
    }
}

#[neurotess_testing::test]
fn origin_keeps_its_precision() {
    let mesh = torus(24, 8, DVec3::new(123_456_789.125, -4_000_000.5, 0.25));
    for format in Format::ALL
        .into_iter()
        .filter(|&format| format != Format::Stl)
    {
        let found = round(&mesh, format);
        for (vertex, expected) in found.vertices.iter().zip(&mesh.vertices) {
            let at = vertex.position.as_dvec3() + found.origin;
            let distance = at.distance(expected.position.as_dvec3() + mesh.origin);
            assert!(distance < 1e-5, "{format}: {distance}");
        }
    }
}

#[neurotess_testing::test]
fn stl_closes_again_when_merged() {
    let mesh = torus(40, 12, DVec3::ZERO);
    let mut found = round(&mesh, Format::Stl);
    assert_eq!(found.vertices.len(), 3 * split(&mesh).faces.triangles.len());
    let report = check(&found);
    assert!(!report.closed);
    assert_eq!(
        report.self_intersections, 0,
        "equal positions are neighbors"
    );
    merge_identical(&mut found);
    let report = check(&found);
    assert!(report.closed && report.oriented && report.vertex_manifold);
    assert_eq!((report.vertices, report.genus), (480, Some(1)));
}

#[neurotess_testing::test]
fn checks_agree_over_all_formats() {
    let expected = check(&torus(60, 20, DVec3::ZERO));
    assert!(expected.closed && expected.oriented && expected.self_intersections == 0);
    for format in Format::ALL {
        let mut mesh = round(&torus(60, 20, DVec3::ZERO), format);
        merge_identical(&mut mesh);
        let found = check(&mesh);
        assert!(
            found.closed && found.oriented && found.vertex_manifold,
            "{format}"
        );
        assert_eq!((found.euler, found.genus), (0, Some(1)), "{format}");
        assert!(
            (found.volume / expected.volume - 1.0).abs() < 1e-9,
            "{format}"
        );
        assert!((found.area / expected.area - 1.0).abs() < 1e-9, "{format}");
    }
}

#[neurotess_testing::test]
fn empty_surface_is_a_valid_file() {
    for format in Format::ALL {
        let found = round(&SurfaceMesh::default(), format);
        assert_eq!(found, SurfaceMesh::default(), "{format}");
    }
}

#[neurotess_testing::test]
fn vertices_without_faces_are_kept() {
    let mesh = SurfaceMesh {
        faces: Faces::default(),
        ..torus(5, 5, DVec3::ZERO)
    };
    for format in Format::ALL
        .into_iter()
        .filter(|&format| format != Format::Stl)
    {
        assert_eq!(round(&mesh, format).vertices.len(), 25, "{format}");
    }
}

#[neurotess_testing::test]
fn writing_begins_where_the_stream_is() {
    let mesh = torus(9, 9, DVec3::ZERO);
    for format in Format::ALL {
        let mut file = Cursor::new(Vec::new());
        file.write_all(b"before").expect("memory");
        write(&mesh, format, &mut file).expect("memory");
        let end = file.position() as usize;
        let bytes = file.into_inner();
        assert_eq!(end, bytes.len(), "{format}");
        assert_eq!(bytes[6..], written(&mesh, format), "{format}");
    }
}

#[neurotess_testing::test]
fn blocks_leave_no_trace_in_binary_files() {
    let mesh = torus(300, 200, DVec3::ZERO);
    for format in [Format::Ply, Format::Vtu] {
        let mut file = Cursor::new(Vec::new());
        write(&Blocks(mesh.clone(), 77), format, &mut file).expect("memory");
        assert!(file.into_inner() == written(&mesh, format), "{format}");
    }
}

/// Labels of faces are looked up in blocks that are made again: 77 vertices each, or all in one.
#[neurotess_testing::test]
fn blocks_leave_no_trace_in_files_with_types() {
    let mesh = split(&torus(300, 200, DVec3::new(9000.5, 0.0, -1.0)));
    for format in [
        Format::Obj,
        Format::Glb,
        Format::Msh,
        Format::Poly,
        Format::Smesh,
    ] {
        let mut file = Cursor::new(Vec::new());
        write(&Blocks(mesh.clone(), 77), format, &mut file).expect("memory");
        assert!(file.into_inner() == written(&mesh, format), "{format}");
    }
}

/// Announces what it likes.
struct Claims {
    vertices: usize,
    triangles: usize,
}

impl Surface for Claims {
    fn origin(&self) -> DVec3 {
        DVec3::ZERO
    }
    fn vertex_count(&self) -> usize {
        self.vertices
    }
    fn triangle_count(&self) -> usize {
        self.triangles
    }
    fn quad_count(&self) -> usize {
        0
    }
    fn vertex_blocks(&self) -> usize {
        0
    }
    fn vertices(&self, _: usize, _: &mut Vec<SurfaceVertex>) {}
    fn face_blocks(&self) -> usize {
        0
    }
    fn faces(&self, _: usize, _: &mut Faces) {}
}

/// Takes everything and keeps nothing.
struct Nowhere(u64);

impl Write for Nowhere {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Nowhere {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        if let SeekFrom::Start(at) = to {
            self.0 = at;
        }
        Ok(self.0)
    }
}

#[neurotess_testing::test]
fn what_does_not_fit_is_an_error() {
    let many = Claims {
        vertices: 1 << 32,
        triangles: 0,
    };
    for format in Format::ALL {
        let result = write(&many, format, &mut Nowhere(0));
        assert!(
            matches!(result, Err(WriteError::TooManyVertices(_))),
            "{format}"
        );
    }
    let long = Claims {
        vertices: 1 << 27,
        triangles: 1 << 32,
    };
    for format in [Format::Glb, Format::Stl] {
        let result = write(&long, format, &mut Nowhere(0));
        let Err(error @ WriteError::TooLarge { .. }) = result else {
            panic!("{format}")
        };
        assert!(error.to_string().contains("write ply or vtu"));
    }
}

#[neurotess_testing::test]
fn a_vertex_that_is_not_finite_is_an_error() {
    let mut mesh = torus(4, 3, DVec3::ZERO);
    mesh.vertices[7].position.y = f32::NAN;
    for format in Format::ALL {
        let result = write(&mesh, format, &mut Nowhere(0));
        assert!(
            matches!(result, Err(WriteError::NotFinite(7))),
            "{format}: {result:?}"
        );
    }
}

#[neurotess_testing::test]
fn blocks_that_hold_less_than_announced_are_an_error() {
    for format in Format::ALL {
        let result = write(
            &Claims {
                vertices: 3,
                triangles: 1,
            },
            format,
            &mut Nowhere(0),
        );
        assert!(
            matches!(result, Err(WriteError::Inconsistent { found: 0, .. })),
            "{format}"
        );
    }
}
