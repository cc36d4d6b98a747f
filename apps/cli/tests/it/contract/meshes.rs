//! Meshes beside the cells of pictures.

use crate::needs::gpu;
use crate::work::{SMALL, Work};

/// A box of 60 µm as quads, around the cell or away from it.
fn cube(from: f64, unit: f64) -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let place = |bit: u32| (from + 60.0 * f64::from(corner >> bit & 1)) / unit;
        text += &format!("v {} {} {}\n", place(0), place(1), place(2));
    }
    for face in [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ] {
        text += &format!("f {face}\n");
    }
    text
}

#[neurotess_testing::test(needs(gpu))]
fn meshes_of_any_format_are_drawn_with_any_source() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.file("cube.obj", cube(-30.0, 1.0));
    work.run("mesh a.swc -o segment.stl").exits(0);
    let options = "--size 160x120 --samples 4 --no-legend --json";
    let draw = |name: &str, more: &str| {
        let run = work.run(&format!("render a.swc -o {name}.png {more} {options}"));
        let document = run.exits(0).json();
        let picture = work.files(".")[&work.path(&format!("{name}.png"))].clone();
        (document, picture)
    };
    let (none, plain) = draw("plain", "");
    assert!(none["meshes"].is_null(), "{none}");
    let mut all = vec![plain];
    for (name, more) in [
        ("solid", "--mesh cube.obj"),
        ("glass", "--mesh cube.obj,opacity=0.3,color=#00aa55"),
        ("wires", "--mesh cube.obj,edges"),
        ("explored", "--mesh cube.obj,opacity=0.3 --lod exploration"),
        (
            "prerefined",
            "--mesh cube.obj,opacity=0.3 --lod prerefined --level 1",
        ),
        (
            "both",
            "--mesh cube.obj,opacity=0.3 --mesh segment.stl,color=#cc2200",
        ),
    ] {
        let (document, picture) = draw(name, more);
        let count = 1 + u64::from(name == "both");
        assert_eq!(document["meshes"]["count"], count, "{document}");
        let triangles = document["meshes"]["triangles"].as_u64();
        assert!(triangles >= Some(12), "{document}");
        assert!(!all.contains(&picture), "{name} is like another");
        all.push(picture);
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_scaled_mesh_is_the_same_and_only_opaque_ones_move_the_camera() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.file("um.obj", cube(-30.0, 1.0));
    work.file("nm.obj", cube(-30.0, 1e-3));
    work.file("far.obj", cube(500.0, 1.0));
    let draw = |more: &str| {
        let options = "--size 160x120 --samples 4 --no-legend --no-recipe --force";
        let run = work.run(&format!("render a.swc -o x.png {more} {options}"));
        run.exits(0);
        work.files(".")[&work.path("x.png")].clone()
    };
    let plain = draw("");
    let micrometers = draw("--mesh um.obj,opacity=0.5");
    assert!(micrometers != plain);
    assert!(micrometers == draw("--mesh nm.obj,opacity=0.5,scale=0.001"));
    // The picture shows the cell, beside which the mesh is.
    assert!(draw("--mesh far.obj,opacity=0.5") == plain);
    assert!(draw("--mesh far.obj,edges") == plain);
    let away = draw("--mesh far.obj,opacity=0.5,fit");
    let opaque = draw("--mesh far.obj");
    assert!(away != plain && opaque != plain && opaque != away);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn films_are_colored_anew_with_their_meshes() {
    let work = Work::new();
    work.run("synth circuit -o c --neurons 5 --morphologies 2 --points 80 --reported 5")
        .exits(0);
    work.file("cube.obj", cube(-30.0, 1.0));
    let report = "c/reports/voltage.h5";
    let options = format!(
        "--report {report} --mesh cube.obj,opacity=0.4,scale=5 --range=-80,30 --no-legend \
         --size 96x64 --samples 4 --json"
    );
    let film = work.run(&format!("render c -o film.png --time 0:4:2 {options}"));
    let film = film.exits(0).json();
    assert!(film["film"]["visible_keys"].is_number(), "{film}");
    work.run(&format!("render c -o one.png --time 2 {options}"))
        .exits(0);
    let files = work.files(".");
    let [second, alone] = ["film_0001.png", "one.png"].map(|f| files[&work.path(f)].clone());
    let [second, alone] = [second, alone].map(|png| pixels(&png));
    let apart = second.iter().zip(&alone).map(|(a, b)| a.abs_diff(*b));
    assert!(apart.max() <= Some(2));
}

fn pixels(png: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png))
        .read_info()
        .expect("a picture");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("pixels");
    pixels
}

#[neurotess_testing::test]
fn what_is_no_mesh_says_why_and_leaves_no_picture() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.file("cube.obj", cube(0.0, 1.0));
    work.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    work.file("broken.obj", "v 0 0 0\nv 1 0 up\n");
    work.file("index.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n");
    work.file(
        "huge.stl",
        format!("{:80}\u{7f}\u{7f}\u{7f}\u{7f}", "binary"),
    );
    for (mesh, code, said) in [
        ("none.obj", 1, "none.obj: cannot be read"),
        ("points.obj", 1, "points.obj: has no faces"),
        ("broken.obj", 1, "broken.obj:2:"),
        ("index.obj", 1, "index.obj:3: a face names vertex 6"),
        ("huge.stl", 1, "huge.stl: "),
        ("a.swc", 1, "unknown mesh format 'swc'"),
        ("cube.obj,opacity=3", 2, "from 0 to 1"),
        ("cube.obj,shiny", 2, "'shiny' is no option of a mesh"),
    ] {
        let run = work.run(&format!("render a.swc -o x.png --size 64x48 --mesh {mesh}"));
        let run = run.exits(code);
        assert!(run.stderr().contains(said), "{mesh}: {}", run.stderr());
        assert!(!work.path("x.png").exists(), "{mesh}");
    }
}
