//! Shapes for tests of files.

use std::io::Cursor;

use glam::{DVec3, Vec3};
use neurotess_mesh::{Format, SurfaceMesh, SurfaceVertex, write};

/// A torus of quads, each third of them as two triangles; attributes differ from vertex to vertex.
pub(crate) fn torus(around: u32, across: u32, origin: DVec3) -> SurfaceMesh {
    let mut mesh = SurfaceMesh {
        origin,
        ..SurfaceMesh::default()
    };
    for i in 0..around {
        for j in 0..across {
            let turn = std::f32::consts::TAU;
            let (su, cu) = (turn * i as f32 / around as f32).sin_cos();
            let (sv, cv) = (turn * j as f32 / across as f32).sin_cos();
            let n = mesh.vertices.len() as i32;
            mesh.vertices.push(SurfaceVertex {
                position: Vec3::new((20.0 + 5.0 * cv) * cu, (20.0 + 5.0 * cv) * su, 5.0 * sv),
                normal: Vec3::new(cv * cu, cv * su, sv),
                kind: 1 + n % 4,
                point: n - 1,
                section: n / 7,
                radius: 5.0 + n as f32 / 64.0,
            });
        }
    }
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    for i in 0..around {
        for j in 0..across {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if (i + j) % 3 == 0 {
                mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                mesh.faces.quads.push([a, b, c, d]);
            }
        }
    }
    mesh
}

/// The bytes of a file.
pub(crate) fn written(mesh: &SurfaceMesh, format: Format) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    write(mesh, format, &mut file).expect("a surface in memory is written");
    file.into_inner()
}
