//! `mesh --parts`, `--materials`, `--color-by` and `--compress`: files of types, groups, colors; small ones.

use std::fs;

use neurotess::mesh::Format;
use serde_json::Value;

use crate::work::{SMALL, Work};

fn check(work: &Work, arguments: &str) -> Value {
    let run = work.run(&format!("check --json {arguments}")).exits(0);
    run.json()
}

fn sum(of: &Value, key: &str) -> f64 {
    let entries = of.as_array().expect("a list").iter();
    entries.filter_map(|entry| entry[key].as_f64()).sum()
}

#[neurotess_testing::test]
fn each_type_gets_a_file_in_every_format() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for format in Format::ALL {
        let (name, extension) = (format.name(), format.extension());
        let out = format!("{name}/cell.{extension}");
        let run = format!("mesh cell.swc -o {out} --format {name} --parts --json");
        let json = work.run(&run).exits(0).json();
        let files =
            ["soma", "axon", "basal_dendrite"].map(|part| format!("cell_{part}.{extension}"));
        let mut sorted = files.clone();
        sorted.sort_unstable();
        assert_eq!(work.names(name), sorted);
        let parts = &json[0]["parts"];
        assert_eq!(parts[1]["type"], "axon");
        assert_eq!(
            parts[1]["out"].as_str(),
            Some(&*format!("{name}/{}", files[1]))
        );
        // The whole is closed, its parts are not.
        assert_eq!(json[0]["closed"], true);
        let found = check(&work, &format!("--merge {name} --format {name}"));
        assert_eq!(sum(&found, "triangles"), sum(&json, "triangles"), "{name}");
        for part in found.as_array().expect("a list") {
            assert_eq!(
                (&part["closed"], &part["oriented"]),
                (&false.into(), &true.into())
            );
        }
        let area = sum(&json, "area");
        assert!((sum(&found, "area") / area - 1.0).abs() < 1e-4, "{name}");
    }
}

#[neurotess_testing::test]
fn walls_close_parts_in_every_format() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for name in ["ply", "stl", "obj", "msh"] {
        let run = format!("mesh cell.swc -o {name}/cell.{name} --parts --walls --json");
        let json = work.run(&run).exits(0).json();
        assert_eq!(json[0]["parts"].as_array().map(Vec::len), Some(3));
        let found = check(&work, &format!("--merge {name}"));
        for part in found.as_array().expect("a list") {
            assert_eq!(
                (&part["closed"], &part["oriented"]),
                (&true.into(), &true.into())
            );
            assert!(part["volume"].as_f64() > Some(0.0));
        }
        let volume = sum(&json, "volume");
        assert!(
            (sum(&found, "volume") / volume - 1.0).abs() < 1e-4,
            "{name}"
        );
    }
}

#[neurotess_testing::test]
fn materials_of_an_obj_are_beside_it() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.run("mesh cell.swc -o plain/cell.obj").exits(0);
    assert_eq!(work.names("plain"), ["cell.obj"]);
    let plain = work.text("plain/cell.obj");
    assert!(plain.contains("\ng axon\n") && !plain.contains("mtl"));
    let json = work.run("mesh cell.swc -o with/cell.obj --materials --json");
    let json = json.exits(0).json();
    assert_eq!(json[0]["materials"], "with/cell.mtl");
    assert_eq!(work.names("with"), ["cell.mtl", "cell.obj"]);
    let text = work.text("with/cell.obj");
    assert!(text.contains("\nmtllib cell.mtl\n") && text.contains("\nusemtl axon\n"));
    let materials = work.text("with/cell.mtl");
    for name in ["soma", "axon", "basal_dendrite"] {
        assert!(materials.contains(&format!("newmtl {name}\n")));
    }
    let found = check(&work, "plain/cell.obj with/cell.obj");
    assert_eq!(found[0]["closed"], true);
    assert_eq!(found[0]["vertices"], found[1]["vertices"]);
    assert_eq!(found[0]["area"], found[1]["area"]);
    // Neither is replaced unless it is asked for.
    fs::remove_file(work.path("with/cell.obj")).expect("removed");
    work.run("mesh cell.swc -o with/cell.obj --materials")
        .exits(1);
    assert_eq!(work.names("with"), ["cell.mtl"]);
    work.run("mesh cell.swc -o with/cell.obj --materials --force")
        .exits(0);
    // Parts have one file of materials together.
    work.run("mesh cell.swc -o parts/cell.obj --materials --parts")
        .exits(0);
    let part = work.text("parts/cell_axon.obj");
    assert!(part.contains("mtllib cell.mtl\n") && part.contains("usemtl axon\n"));
    assert!(!part.contains("usemtl soma"));
    assert!(work.path("parts/cell.mtl").exists());
}

#[neurotess_testing::test]
fn a_glb_is_closed_with_materials_and_without() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.run("mesh cell.swc -o cell.glb --materials").exits(0);
    work.run("mesh cell.swc -o plain.glb").exits(0);
    work.run("mesh cell.swc -o told.glb --table told.csv")
        .exits(0);
    let found = check(&work, "cell.glb plain.glb told.glb");
    for n in 0..3 {
        assert_eq!(found[n]["closed"], true);
        assert_eq!(found[n]["vertices"], found[0]["vertices"]);
    }
    let bytes = |name: &str| fs::read(work.path(name)).expect("there");
    let has = |name: &str| {
        bytes(name)
            .windows(14)
            .any(|text| text == b"\"name\":\"axon\",")
    };
    assert!(has("cell.glb") && !has("plain.glb"));
    assert_eq!(bytes("plain.glb"), bytes("told.glb"));
}

#[neurotess_testing::test]
fn a_compressed_glb_is_closed_and_has_all_in_fewer_bytes() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.run("mesh cell.swc -o plain.glb").exits(0);
    work.run("mesh cell.swc -o small.glb --compress draco --color-by type")
        .exits(0);
    let [plain, small] =
        ["plain.glb", "small.glb"].map(|file| fs::read(work.path(file)).expect("there"));
    assert!(
        8 * small.len() < plain.len(),
        "{} {}",
        small.len(),
        plain.len()
    );
    let report = work.run("check plain.glb small.glb --json").exits(0).json();
    for key in ["closed", "vertices", "triangles", "euler", "components"] {
        assert_eq!(report[0][key], report[1][key], "{key}");
    }
    assert_eq!(report[1]["closed"], true);
    // Other options, another file.
    let skipped = |options: &str| {
        let run = work.run(&format!(
            "mesh cell.swc -o again.glb --resume --json {options}"
        ));
        run.exits(0).json()[0]["skipped"] == true
    };
    assert!(!skipped(""));
    assert!(!skipped("--compress draco"));
    assert!(skipped("--compress draco"));
    assert!(!skipped("--compress draco --color-by type"));
}

#[neurotess_testing::test]
fn resuming_knows_parts_and_materials() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", SMALL);
    let mesh = "mesh cells -o out --format obj --materials --resume --json --level 1";
    let skipped = |json: &Value| json[0]["skipped"] == true && json[1]["skipped"] == true;
    work.run(mesh).exits(0);
    let all = ["a.mtl", "a.obj", "b.mtl", "b.obj"];
    assert_eq!(work.names("out"), all);
    assert!(skipped(&work.run(mesh).exits(0).json()));
    fs::remove_file(work.path("out/a.mtl")).expect("removed");
    let json = work.run(mesh).exits(0).json();
    assert!(
        json[0]["vertices"].is_u64() && json[1]["skipped"] == true,
        "{json}"
    );
    fs::remove_file(work.path("out/b.obj")).expect("removed");
    let json = work.run(mesh).exits(0).json();
    assert!(
        json[1]["vertices"].is_u64() && json[0]["skipped"] == true,
        "{json}"
    );
    assert_eq!(work.names("out"), all);

    let mesh = "mesh cells -o parts --format stl --parts --resume --json --level 1";
    for shard in ["1/2", "2/2"] {
        work.run(&format!("{mesh} --shard {shard}")).exits(0);
    }
    assert_eq!(work.names("parts").len(), 6);
    assert!(skipped(&work.run(mesh).exits(0).json()));
    fs::remove_file(work.path("parts/a_axon.stl")).expect("removed");
    let json = work.run(mesh).exits(0).json();
    assert!(
        json[0]["vertices"].is_u64() && json[1]["skipped"] == true,
        "{json}"
    );
    let finer = format!("{mesh} --level 2");
    let finer = finer.replacen(" --level 1", "", 1);
    let run = work.run(&finer).exits(0);
    assert!(
        run.stderr().contains("2 outputs made with other options"),
        "{}",
        run.stderr()
    );
    assert!(skipped(&work.run(&finer).exits(0).json()));
    assert_eq!(work.names("parts").len(), 6);
}

#[neurotess_testing::test]
fn what_cannot_be_is_wrong_usage() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for (arguments, told) in [
        ("-o a.ply --materials", "knows no materials"),
        (
            "-o - --format obj --materials",
            "no place for the file of materials",
        ),
        ("-o a.mtl --format obj --materials", "the name of the mesh"),
        ("-o - --format obj --parts", "--parts writes several files"),
        (
            "-o a.glb --materials --table a.csv",
            "another order than the rows",
        ),
        ("-o a.ply --parts --table a.csv", "cannot be used with"),
        ("-o a.obj --color-by type", "use --materials"),
        ("-o a.ply --color-by radius", "files have colors by type"),
        ("-o a.ply --compress draco", "only glb is compressed"),
        ("-o a.glb --compress zip", "use draco"),
        (
            "-o a.glb --compress draco --materials",
            "use --color-by type instead",
        ),
        (
            "-o a.glb --compress draco --table a.csv",
            "cannot be used with",
        ),
        ("-o a.ply --walls", "cannot tell walls"),
        ("-o a.ply --walls --parts --quads", "made of triangles"),
    ] {
        let run = work.run(&format!("mesh cell.swc {arguments}")).exits(2);
        assert!(run.stderr().contains(told), "{arguments}: {}", run.stderr());
    }
    let text = work.run("mesh cell.swc -o - --format obj").exits(0);
    assert!(text.stdout().contains("\ng axon\n"));
    assert_eq!(work.names(""), ["cell.swc"]);
}
