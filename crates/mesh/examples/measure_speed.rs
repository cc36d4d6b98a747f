//! How fast are checks and writers? `cargo run --release -p neurotess-mesh --example measure_speed`
//! prints seconds for a torus of a million triangles and MB/s of each writer, to a file and to
//! memory.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "an example prints and may panic"
)]

use std::io::Cursor;
use std::time::Instant;

use glam::{DVec3, Vec3};
use neurotess_mesh::{Format, SurfaceMesh, SurfaceVertex, measure, read_bytes, write};

fn torus(around: u32, across: u32) -> SurfaceMesh {
    let mut mesh = SurfaceMesh {
        origin: DVec3::ZERO,
        ..SurfaceMesh::default()
    };
    let turn = std::f32::consts::TAU;
    for n in 0..around * across {
        let (su, cu) = (turn * (n / across) as f32 / around as f32).sin_cos();
        let (sv, cv) = (turn * (n % across) as f32 / across as f32).sin_cos();
        mesh.vertices.push(SurfaceVertex {
            position: Vec3::new((90.0 + 50.0 * cv) * cu, (90.0 + 50.0 * cv) * su, 50.0 * sv),
            normal: Vec3::new(cv * cu, cv * su, sv),
            kind: 3,
            point: n as i32,
            section: 7,
            radius: 5.0,
        });
    }
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    for n in 0..around * across {
        let (i, j) = (n / across, n % across);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

fn timed<T>(what: &str, bytes: usize, run: impl Fn() -> T) -> T {
    let mut best = f64::INFINITY;
    let mut result = run();
    for _ in 0..3 {
        let start = Instant::now();
        result = run();
        best = best.min(start.elapsed().as_secs_f64());
    }
    let rate = bytes as f64 / 1e6 / best;
    println!(
        "{what:20} {best:8.3} s {}",
        if bytes > 0 {
            format!("{rate:8.0} MB/s")
        } else {
            String::new()
        }
    );
    result
}

fn main() {
    let mesh = torus(1000, 500);
    let topology = timed("topology", 0, || mesh.topology());
    assert!(topology.closed && topology.genus == Some(1));
    timed("measure", 0, || measure(&mesh.positions(), &mesh.faces));
    let crossing = timed("self-intersections", 0, || mesh.self_intersections());
    assert!(crossing.is_empty());
    let mut double = mesh.clone();
    let shift = mesh.vertices.len() as u32;
    double
        .vertices
        .extend(mesh.vertices.iter().map(|v| SurfaceVertex {
            position: v.position + Vec3::new(3.3, 2.2, 1.1),
            ..*v
        }));
    double
        .faces
        .triangles
        .extend(mesh.faces.triangles.iter().map(|f| f.map(|v| v + shift)));
    let crossing = timed("… of two tori, 2 M", 0, || double.self_intersections());
    println!("{} pairs", crossing.len());

    let folder = tempfile::tempdir().unwrap();
    for format in Format::ALL {
        let mut file = Cursor::new(Vec::new());
        write(&mesh, format, &mut file).unwrap();
        let bytes = file.into_inner();
        let path = folder.path().join("mesh");
        timed(&format!("{format} to memory"), bytes.len(), || {
            let mut file = Cursor::new(Vec::with_capacity(bytes.len()));
            write(&mesh, format, &mut file).unwrap();
        });
        timed(&format!("{format} to a file"), bytes.len(), || {
            write(&mesh, format, &mut std::fs::File::create(&path).unwrap()).unwrap();
        });
        timed(&format!("{format} read"), bytes.len(), || {
            read_bytes(&bytes, format).unwrap()
        });
    }
}
