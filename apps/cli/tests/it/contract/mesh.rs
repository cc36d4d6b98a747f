//! `neurotess mesh`

use std::fs;

use neurotess::mesh::Format;
use serde_json::Value;

use crate::work::{BROKEN, SMALL, Work};

/// A folder with one cell and the JSON object of its mesh.
fn meshed(arguments: &str) -> (Work, Value) {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work
        .run(&format!("mesh cell.swc --json {arguments}"))
        .exits(0);
    let json = run.json();
    assert_eq!(json.as_array().map(Vec::len), Some(1));
    let object = json[0].clone();
    (work, object)
}

/// What `check` says of a file.
fn checked(work: &Work, arguments: &str) -> Value {
    work.run(&format!("check --json {arguments}"))
        .exits(0)
        .json()[0]
        .clone()
}

#[neurotess_testing::test]
fn report_has_the_keys_and_agrees_with_check() {
    let (work, mesh) = meshed("-o cell.ply");
    let check = checked(&work, "cell.ply");
    for key in [
        "vertices",
        "triangles",
        "quads",
        "closed",
        "euler",
        "components",
    ] {
        assert_eq!(mesh[key], check[key], "{key}");
    }
    for key in ["volume", "area"] {
        let (a, b) = (mesh[key].as_f64(), check[key].as_f64());
        let (a, b) = (a.expect("a number"), b.expect("a number"));
        assert!((a - b).abs() < 1e-4 * b, "{key}: {a} {b}");
    }
    assert_eq!((&mesh["closed"], &mesh["euler"]), (&true.into(), &2.into()));
    assert!(mesh["soma_volume"].as_f64().is_some_and(|v| v > 100.0));
    for stage in ["read", "soma", "coarse", "refine", "write"] {
        assert!(
            mesh["seconds"][stage].as_f64().is_some_and(|s| s >= 0.0),
            "{stage}"
        );
    }
    assert!(mesh["warnings"].is_array());
    assert_eq!(
        (&mesh["file"], &mesh["out"]),
        (&"cell.swc".into(), &"cell.ply".into())
    );
}

#[neurotess_testing::test]
fn every_format_is_written_and_closed() {
    for format in Format::ALL.map(Format::name) {
        let (work, mesh) = meshed(&format!("-o cell.{format} --level 2"));
        let merge = if format == "stl" { "--merge" } else { "" };
        let check = checked(&work, &format!("cell.{format} {merge}"));
        assert_eq!(check["closed"], true, "{format}: {check}");
        assert_eq!(check["triangles"], mesh["triangles"], "{format}");
    }
}

#[neurotess_testing::test]
fn msh2_is_written_into_files_that_end_in_msh() {
    let (work, mesh) = meshed("-o cell.msh --format msh2 --level 1");
    let text = fs::read_to_string(work.path("cell.msh")).expect("text");
    assert!(
        text.starts_with("$MeshFormat\n2.2 0 8\n"),
        "{}",
        &text[..40]
    );
    for part in ["2 1 \"soma\"\n", "$Nodes\n", "$EndElements\n"] {
        assert!(text.contains(part), "{part}");
    }
    // The file says itself which version it is of.
    let check = checked(&work, "cell.msh");
    assert_eq!(
        (&check["closed"], &check["triangles"]),
        (&true.into(), &mesh["triangles"])
    );
    let run = work
        .run("mesh cell.swc -o cell.msh --format msh2 --level 1 --force")
        .exits(0);
    assert!(
        !run.stderr().contains("as --format says"),
        "{}",
        run.stderr()
    );
    fs::create_dir(work.path("in")).expect("a folder");
    fs::copy(work.path("cell.swc"), work.path("in/a.swc")).expect("copied");
    work.run("mesh in -o out --format msh2 --level 1").exits(0);
    assert_eq!(
        work.names("out")
            .iter()
            .filter(|name| *name == "a.msh")
            .count(),
        1
    );
}

#[neurotess_testing::test]
fn format_decides_before_the_extension() {
    let (work, _) = meshed("-o cell.data --format off --level 1");
    assert!(
        fs::read(work.path("cell.data"))
            .expect("there")
            .starts_with(b"OFF")
    );
}

#[neurotess_testing::test]
fn levels_and_errors_set_the_number_of_faces() {
    let faces = |arguments: &str| {
        let (_, mesh) = meshed(arguments);
        let count = |key: &str| mesh[key].as_u64().expect("a count");
        (count("triangles"), count("quads"))
    };
    let (triangles, coarse) = faces("-o cell.ply --level 0");
    assert_eq!(triangles, 0);
    assert_eq!(faces("-o cell.stl --level 0"), (2 * coarse, 0));
    let (one, _) = faces("-o cell.ply --level 1");
    let (four, _) = faces("-o cell.ply");
    assert!(one <= 2 * coarse && 8 * one < four, "{coarse} {one} {four}");
    let (rough, fine) = (
        faces("-o cell.ply --max-error 1").0,
        faces("-o cell.ply --max-error 0.01").0,
    );
    assert!(rough < fine, "{rough} {fine}");
    let (_, quads) = faces("-o cell.ply --quads");
    assert!(quads > 10 * coarse);
}

#[neurotess_testing::test]
fn options_change_the_shape() {
    let volume = |arguments: &str| {
        let (_, mesh) = meshed(&format!("-o cell.ply {arguments}"));
        assert_eq!(mesh["closed"], true, "{arguments}");
        mesh["volume"].as_f64().expect("a number")
    };
    let default = volume("");
    let near = |other: f64| (other - default).abs() < 1e-9 * default;
    assert!(near(volume(
        "--soma fem --poisson 0.3 --path hermite --caps round"
    )));
    for other in [
        "--soma sphere",
        "--soma profile",
        "--soma none",
        "--poisson 0.45",
        "--soma-scale 1.2",
        "--ring 1=0",
        "--soma-sphere octahedron --soma-level 3",
        "--path linear",
        "--caps flat",
        "--types axon",
    ] {
        assert!(!near(volume(other)), "{other}");
    }
    assert!(volume("--types 2") < default);
    assert!(near(volume("--types axon,basal,apical_dendrite")));
}

#[neurotess_testing::test]
fn the_soma_can_be_that_of_a_mesh() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("ball.swc", "1 1 0 0 0 8 -1\n");
    work.run("mesh ball.swc -o ball.ply").exits(0);
    let run = work.run("mesh cell.swc -o cell.ply --soma-mesh ball.ply --json");
    let told = run.exits(0).json();
    let traced = told[0]["soma_volume_traced"].as_f64().expect("a number");
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 512.0;
    assert!((traced / ball - 1.0).abs() < 0.01, "{traced} of {ball}");
    for (arguments, expected) in [
        ("cell.swc -o o.ply --soma-mesh none.ply", "none.ply: "),
        (
            "cell.swc -o o.ply --soma-mesh cell.swc",
            "unknown mesh format",
        ),
    ] {
        let run = work.run(&format!("mesh {arguments}")).exits(1);
        assert!(run.errors()[0].contains(expected), "{}", run.stderr());
    }
    for (arguments, expected) in [
        (
            "cell.swc ball.swc -o out --soma-mesh ball.ply",
            "is of one cell",
        ),
        (
            "cell.swc -o o.ply --soma-mesh ball.ply --soma none",
            "cannot be used with '--soma'",
        ),
    ] {
        let run = work.run(&format!("mesh {arguments}")).exits(2);
        assert!(run.errors()[0].contains(expected), "{}", run.stderr());
    }
}

#[neurotess_testing::test]
fn free_neurites_are_components() {
    let (_, mesh) = meshed("-o cell.ply --soma none");
    assert_eq!(mesh["components"], 2);
    assert_eq!(mesh["euler"], 4);
    assert_eq!(mesh["soma_volume"], 0.0);
}

#[neurotess_testing::test]
fn nothing_left_is_a_failure() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work
        .run("mesh cell.swc -o cell.ply --soma none --types custom_9")
        .exits(1);
    assert!(
        run.errors()[0].contains("nothing is left"),
        "{}",
        run.stderr()
    );
    assert_eq!(work.names("."), ["cell.swc"]);
}

#[neurotess_testing::test]
fn existing_files_stay_without_force() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("cell.ply", "precious");
    let run = work.run("mesh cell.swc -o cell.ply").exits(1);
    assert!(run.errors()[0].contains("--force"), "{}", run.stderr());
    assert_eq!(fs::read(work.path("cell.ply")).expect("there"), b"precious");
    work.run("mesh cell.swc -o cell.ply --force").exits(0);
    assert!(
        fs::read(work.path("cell.ply"))
            .expect("there")
            .starts_with(b"ply")
    );
}

#[neurotess_testing::test]
fn a_broken_cell_does_not_stop_the_others() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", BROKEN);
    work.file("cells/c.swc", SMALL);
    let run = work
        .run("mesh cells -o out --json --log log.jsonl")
        .exits(1);
    assert_eq!(run.errors().len(), 1, "{}", run.stderr());
    assert_eq!(work.names("out"), ["a.ply", "c.ply"]);
    let json = run.json();
    assert!(json[1]["error"].is_string() && json[2]["closed"] == true);
    let log = work.text("log.jsonl");
    let lines: Vec<Value> = log
        .lines()
        .map(|l| serde_json::from_str(l).expect("JSON"))
        .collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines.iter().filter(|l| l["volume"].is_f64()).count(), 2);
}

#[neurotess_testing::test]
fn strict_refuses_warnings() {
    let work = Work::new();
    work.file("cell.swc", "1 3 0 0 0 1 -1\n2 3 0 9 0 1 1\n");
    work.run("mesh cell.swc -o cell.ply --strict").exits(1);
    work.run("mesh cell.swc -o cell.ply").exits(0);
}

#[neurotess_testing::test]
fn shards_partition_the_inputs() {
    let work = Work::new();
    for i in 0..5 {
        work.file(&format!("cells/{i}.swc"), SMALL);
    }
    work.run("mesh cells -o whole --level 1").exits(0);
    let mut count = 0;
    for i in 1..=3 {
        let run = work
            .run(&format!(
                "mesh cells -o parts --level 1 --shard {i}/3 --json"
            ))
            .exits(0);
        count += run.json().as_array().map_or(0, Vec::len);
    }
    assert_eq!(count, 5);
    let bytes = |folder: &str| work.files(folder).into_values().collect::<Vec<_>>();
    assert_eq!(work.names("whole"), work.names("parts"));
    assert!(bytes("whole") == bytes("parts"));
}

#[neurotess_testing::test]
fn resume_does_only_what_is_missing() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", SMALL);
    work.run("mesh cells -o out --level 1").exits(0);
    fs::remove_file(work.path("out/b.ply")).expect("removed");
    let json = work
        .run("mesh cells -o out --level 1 --resume --json")
        .exits(0)
        .json();
    assert_eq!(json[0]["skipped"], true);
    assert_eq!(json[1]["closed"], true);
    assert_eq!(work.names("out"), ["a.ply", "b.ply"]);

    // An output that is older than its input is out of date: not skipped, and not lost either.
    let past = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    let old = fs::File::options()
        .append(true)
        .open(work.path("out/a.ply"))
        .expect("opened");
    old.set_modified(past).expect("set");
    let run = work.run("mesh cells -o out --level 1 --resume").exits(1);
    assert!(run.errors()[0].contains("--force"), "{}", run.stderr());
    work.run("mesh cells -o out --level 1 --resume --force")
        .exits(0);
}

#[neurotess_testing::test]
fn threads_do_not_change_the_files() {
    let work = Work::new();
    work.file("cell.swc", crate::work::long_cell(300));
    work.run("mesh cell.swc -o one.ply --threads 1").exits(0);
    work.run("mesh cell.swc -o three.ply --threads 3").exits(0);
    let read = |name: &str| fs::read(work.path(name)).expect("there");
    assert!(read("one.ply") == read("three.ply"));
}
