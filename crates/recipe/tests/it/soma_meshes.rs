//! Somata whose surface is in a file beside the tracing.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use neurotess_mesh::{Role, SurfaceMesh};
use neurotess_recipe::{MeshOptions, NamedOptions, Spelling, mesh};

use crate::{SMALL, cell};

/// Writes an ellipsoid with these half axes (µm).
fn ellipsoid(folder: &Path, center: [f64; 3], half: [f64; 3]) -> PathBuf {
    let (rows, columns) = (24, 36);
    let mut text = String::new();
    let mut vertex = |unit: [f64; 3]| {
        let place = [0, 1, 2].map(|axis| center[axis] + half[axis] * unit[axis]);
        let _ = writeln!(text, "v {} {} {}", place[0], place[1], place[2]);
    };
    vertex([0.0, 0.0, 1.0]);
    vertex([0.0, 0.0, -1.0]);
    for row in 1..rows {
        for column in 0..columns {
            let (sin, cos) = (PI * f64::from(row) / f64::from(rows)).sin_cos();
            let (y, x) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
            vertex([sin * x, sin * y, cos]);
        }
    }
    let at = |row: i32, column: i32| 3 + (row - 1) * columns + column % columns;
    for column in 0..columns {
        let next = column + 1;
        let _ = writeln!(text, "f 1 {} {}", at(1, column), at(1, next));
        let _ = writeln!(text, "f 2 {} {}", at(rows - 1, next), at(rows - 1, column));
        for row in 1..rows - 1 {
            let [a, b, c, d] = [
                at(row, column),
                at(row + 1, column),
                at(row + 1, next),
                at(row, next),
            ];
            let _ = writeln!(text, "f {a} {b} {c} {d}");
        }
    }
    let file = folder.join("soma.obj");
    std::fs::write(&file, text).expect("written");
    file
}

fn told(file: &Path, text: &str) -> String {
    let options = MeshOptions::default().with_soma_mesh(file);
    let Err(error) = mesh(&cell(text), &options) else {
        panic!("{} was taken", file.display());
    };
    error.told(Spelling::Flag)
}

#[neurotess_testing::test]
fn the_soma_has_the_surface_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let half = [5.0, 7.0, 9.0];
    let file = ellipsoid(folder.path(), [0.5, 0.0, 0.0], half);
    let options = MeshOptions::default().with_soma_mesh(&file);
    let made = mesh(&cell(SMALL), &options).expect("meshed");
    let report = made.report();
    assert!(report.closed && report.components == 1);
    let volume = 4.0 / 3.0 * PI * half[0] * half[1] * half[2];
    let traced = report.soma_volume_traced / volume;
    assert!((traced - 1.0).abs() < 0.02, "{traced}");
    let kept = report.soma_volume / report.soma_volume_traced;
    assert!((kept - 1.0).abs() < 5e-3, "{kept}");
    // Seen along the axis of the neurites, which draw it out, the soma has the half axes of the ellipsoid, but for the size
    // that makes up for what they add.
    let coarse = &made.generated.mesh;
    let is_soma = |tracing: u32| coarse.tracing[tracing as usize].role == Role::Soma;
    let mut farthest = glam::DVec3::ZERO;
    for vertex in coarse.vertices.iter().filter(|v| is_soma(v.tracing)) {
        let place = vertex.position.as_dvec3() - glam::DVec3::X * 0.5;
        farthest = farthest.max(place.abs());
    }
    let [x, z] = [farthest.x / half[0], farthest.z / half[2]];
    assert!((x / z - 1.0).abs() < 0.03, "{farthest}");
    assert!((0.95..1.01).contains(&x), "{farthest}");
    assert!(
        !SurfaceMesh::collect(made.surface().surface())
            .faces
            .triangles
            .is_empty()
    );
}

#[neurotess_testing::test]
fn a_file_that_is_not_the_somas_is_told_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let elsewhere = ellipsoid(folder.path(), [900.0, 0.0, 0.0], [5.0; 3]);
    let said = told(&elsewhere, SMALL);
    let expected = "soma.obj: it goes around (900.00, 0.00, 0.00) µm and no soma is there, the first is at (0.00, 0.00, 0.00)";
    assert!(said.contains(expected), "{said}");
    let without = "1 3 0 0 0 1 -1\n2 3 20 0 0 1 1\n";
    let said = told(&elsewhere, without);
    assert!(said.contains("the tracing has no soma"), "{said}");
    let said = told(&folder.path().join("none.ply"), SMALL);
    assert!(said.contains("none.ply: "), "{said}");
    std::fs::write(&elsewhere, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let said = told(&elsewhere, SMALL);
    assert!(said.contains("at least four triangles"), "{said}");
}

#[neurotess_testing::test]
fn files_of_options_name_it() {
    let options: MeshOptions =
        serde_json::from_str(r#"{"soma_mesh":"soma.ply"}"#).expect("options");
    assert_eq!(options.soma_mesh.as_deref(), Some(Path::new("soma.ply")));
    let named = NamedOptions::of(&options).expect("named");
    assert_eq!(named.options().expect("options"), options);
    let other = r#"{"soma_mesh":"soma.ply","soma":"sphere"}"#;
    let error = serde_json::from_str::<MeshOptions>(other).expect_err("only one of them");
    let expected = "'soma_mesh' cannot be used with 'soma'";
    assert!(error.to_string().contains(expected), "{error}");
}
