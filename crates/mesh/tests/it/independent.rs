//! Our files in the hands of others: trimesh, meshio, pygltflib, Gmsh and TetGen must read what we wrote.

use std::io::Cursor;
use std::path::Path;
use std::process::Command;

use crate::shapes::{neuron, torus, written};
use glam::DVec3;
use neurotess_mesh::palette::{Palette, linear};
use neurotess_mesh::{
    ColorBy, Format, SurfaceMesh, WriteOptions, obj_materials, region_name, write_with,
};
use neurotess_testing::python_with;
use serde_json::Value;

/// The need of this test; its environment has the other readers too.
fn python() -> Result<(), String> {
    python_with("trimesh").map(drop)
}

/// The need of the test of simulators.
fn mesh_generators() -> Result<(), String> {
    python_with("gmsh")?;
    python_with("tetgen").map(drop)
}

/// What the readers say of files of a mesh in all formats.
fn judge(python: &Path, flag: Option<&str>, name: &str, mesh: &SurfaceMesh) -> Vec<Value> {
    let folder = tempfile::tempdir().expect("a folder");
    let files = Format::ALL.map(|format| {
        // Both versions of MSH have one extension.
        let stem = match format {
            Format::Msh2 => format!("{name}2"),
            _ => name.to_owned(),
        };
        let path = folder.path().join(format!("{stem}.{}", format.extension()));
        std::fs::write(&path, written(mesh, format)).expect("written");
        path
    });
    run(
        python,
        "read_meshes.py",
        flag.map(Path::new)
            .into_iter()
            .chain(files.iter().map(|file| &**file)),
    )
}

/// What a script prints of some files.
fn run<'a>(python: &Path, script: &str, arguments: impl Iterator<Item = &'a Path>) -> Vec<Value> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    let output = Command::new(python)
        .arg(folder.join(script))
        .args(arguments.map(Path::as_os_str))
        .output()
        .expect("Python runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    // Readers may print warnings before the JSON.
    let start = output
        .stdout
        .windows(2)
        .position(|pair| pair == b"[{")
        .expect("JSON");
    serde_json::from_slice(&output.stdout[start..]).expect("JSON")
}

fn assert_near(found: &Value, expected: f64, tolerance: f64, what: &str) {
    let found = found.as_f64().expect("a number");
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found}, expected {expected}"
    );
}

fn compare(mesh: &SurfaceMesh, results: &[Value]) {
    let (triangles, quads) = (mesh.faces.triangles.len(), mesh.faces.quads.len());
    let expected = mesh.measure().volume;
    // Coordinates of 32 bits, far from the origin, lose this much.
    let rounding = mesh.origin.abs().max_element() * f64::from(f32::EPSILON);
    for result in results {
        let what = format!("{} by {}", result["file"], result["reader"]);
        assert_eq!(result["vertices"], mesh.vertices.len(), "{what}");
        let found = [&result["triangles"], &result["quads"]].map(Value::as_u64);
        let split = (triangles + 2 * quads) as u64;
        let whole = [Some(triangles as u64), Some(quads as u64)];
        assert!(
            found == [Some(split), Some(0)] || found == whole,
            "{what}: {found:?}"
        );
        let keeps = result["file"]
            .as_str()
            .is_some_and(|file| !file.ends_with(".msh"));
        if result["reader"] == "meshio" && keeps {
            assert_eq!(found, whole, "{what}");
        }
        assert_eq!(result["watertight"], true, "{what}");
        assert_eq!(result["winding"], true, "{what}");
        let single = result["file"]
            .as_str()
            .is_some_and(|file| file.ends_with(".stl"));
        let tolerance = if single {
            expected * (1e-6 + rounding)
        } else {
            expected * 1e-4
        };
        assert_near(&result["volume"], expected, tolerance, &what);
        let near = if single { rounding + 1e-5 } else { 2e-5 };
        for axis in 0..3 {
            let positions = mesh.vertices.iter().map(|v| f64::from(v.position[axis]));
            let low = positions.fold(f64::INFINITY, f64::min) + mesh.origin[axis];
            assert_near(&result["low"][axis], low, near, &what);
        }
        attributes(mesh, result, &what);
    }
}

fn attributes(mesh: &SurfaceMesh, result: &Value, what: &str) {
    let found = &result["attributes"];
    let file = result["file"].as_str().unwrap_or_default();
    let kept = [".ply", ".glb", ".vtu"]
        .iter()
        .any(|end| file.ends_with(end));
    if !kept {
        return;
    }
    let last = mesh.vertices.last().expect("vertices");
    for (name, low, high) in [
        ("type", 1.0, 4.0),
        ("point", -1.0, f64::from(last.point)),
        ("section", 0.0, f64::from(last.section)),
        ("radius", 5.0, f64::from(last.radius)),
    ] {
        assert_near(&found[name][0], low, 0.0, what);
        assert_near(&found[name][1], high, 0.0, what);
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, python))]
fn others_read_what_we_write() {
    let python = python_with("trimesh").expect("the test has needs(python)");
    for origin in [DVec3::ZERO, DVec3::new(5000.125, -3000.5, 12000.0625)] {
        let mixed = torus(48, 16, origin);
        let results = judge(&python, None, "mixed", &mixed);
        assert_eq!(results.len(), 10);
        compare(&mixed, &results);

        let mut triangles = mixed.clone();
        for [a, b, c, d] in std::mem::take(&mut triangles.faces.quads) {
            triangles.faces.triangles.extend([[a, b, c], [a, c, d]]);
        }
        let results = judge(&python, None, "triangles", &triangles);
        assert_eq!(results.len(), 12);
        compare(&triangles, &results);
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, python))]
fn others_see_the_colors_of_types() {
    let python = python_with("trimesh").expect("the test has needs(python)");
    let mut mesh = neuron(DVec3::ZERO);
    for [a, b, c, d] in std::mem::take(&mut mesh.faces.quads) {
        mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let options = WriteOptions {
        material_file: Some("colored.mtl".into()),
        ..WriteOptions::default()
    };
    let mut colored = Cursor::new(Vec::new());
    let kinds = write_with(&mesh, Format::Obj, &options, &mut colored).expect("written");
    let files = ["plain.obj", "colored.obj", "cell.glb"].map(at);
    std::fs::write(&files[0], written(&mesh, Format::Obj)).expect("written");
    std::fs::write(&files[1], colored.into_inner()).expect("written");
    std::fs::write(at("colored.mtl"), obj_materials(&kinds)).expect("written");
    let options = WriteOptions {
        glb_materials: true,
        ..WriteOptions::default()
    };
    let mut glb = Cursor::new(Vec::new());
    write_with(&mesh, Format::Glb, &options, &mut glb).expect("written");
    std::fs::write(&files[2], glb.into_inner()).expect("written");
    let results = run(
        &python,
        "read_materials.py",
        files.iter().map(|file| &**file),
    );
    let by = results
        .iter()
        .map(|found| [&found["file"], &found["reader"]].map(|name| name.as_str().expect("a name")));
    let by: Vec<_> = by.collect();
    let (trimesh, meshio) = ("trimesh", "meshio");
    assert_eq!(
        by,
        [
            ["plain.obj", trimesh],
            ["plain.obj", meshio],
            ["colored.obj", trimesh],
            ["colored.obj", meshio],
            ["cell.glb", trimesh]
        ]
    );
    for (found, whole) in results.iter().zip([true, true, false, true, false]) {
        assert_eq!(
            (&found["watertight"], &found["merged"]),
            (&whole.into(), &true.into()),
            "{found}"
        );
        if whole {
            assert_eq!(found["vertices"], mesh.vertices.len(), "{found}");
        }
    }
    for (found, is_linear) in [(&results[2], false), (&results[4], true)] {
        let materials = found["materials"].as_object().expect("an object");
        assert_eq!(materials.len(), 4);
        for kind in 1..=4 {
            let rgb = Palette::default().of_type(kind);
            let of = &materials[&*region_name(kind)][0];
            for (n, light) in linear(rgb).into_iter().enumerate() {
                let expected = if is_linear {
                    255.0 * f64::from(light)
                } else {
                    f64::from(rgb[n])
                };
                assert_near(&of[n], expected, 1.0, "color");
            }
        }
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, python))]
fn others_see_the_colors_of_vertices() {
    let python = python_with("trimesh").expect("the test has needs(python)");
    let mut mesh = neuron(DVec3::ZERO);
    // trimesh reads no binary PLY with faces of both kinds.
    for [a, b, c, d] in std::mem::take(&mut mesh.faces.quads) {
        mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let options = WriteOptions {
        color_by: Some(ColorBy::Type),
        ..WriteOptions::default()
    };
    let files = [Format::Ply, Format::Vtu].map(|format| {
        let mut file = Cursor::new(Vec::new());
        write_with(&mesh, format, &options, &mut file).expect("written");
        let path = folder.path().join(format!("cell.{format}"));
        std::fs::write(&path, file.into_inner()).expect("written");
        path
    });
    let results = run(&python, "read_colors.py", files.iter().map(|file| &**file));
    let colors = mesh
        .vertices
        .iter()
        .map(|v| Palette::default().of_type(v.kind));
    let colors: Value = colors.map(|rgb| rgb.to_vec()).collect();
    assert_eq!(results.len(), 2);
    for found in &results {
        assert_eq!(
            found["colors"], colors,
            "{} by {}",
            found["file"], found["reader"]
        );
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, mesh_generators))]
fn mesh_generators_take_what_we_write() {
    let python = python_with("gmsh").expect("the test has needs(mesh_generators)");
    for origin in [DVec3::ZERO, DVec3::new(5000.125, -3000.5, 12000.0625)] {
        let mut mesh = torus(48, 16, origin);
        for vertex in &mut mesh.vertices {
            vertex.kind = 1 + vertex.section % 4;
        }
        let results = judge(&python, Some("--simulators"), "mixed", &mesh);
        assert_eq!(results.len(), 4);
        compare(&mesh, &results);
        for result in &results {
            let found = &result["attributes"]["type"];
            assert_eq!(
                (found[0].as_f64(), found[1].as_f64()),
                (Some(1.0), Some(4.0))
            );
        }
        // Both versions of MSH.
        for result in &results[..2] {
            let sections = &result["attributes"]["section"];
            assert_eq!(result["reader"], "gmsh");
            assert_near(&sections[0], 0.0, 0.0, "section");
            let vertices = &mesh.vertices;
            let last = vertices.last().map_or(0.0, |last| f64::from(last.section));
            assert!(
                sections[1]
                    .as_f64()
                    .is_some_and(|found| found > 0.8 * last && found <= last)
            );
        }
    }
}
