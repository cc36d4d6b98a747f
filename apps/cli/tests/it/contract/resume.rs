//! `mesh --resume`: other options, other inputs, several runs at a time, and the log.

use std::collections::BTreeMap;
use std::fs;
use std::process::Stdio;

use serde_json::Value;

use crate::work::{SMALL, Work, long_cell};

fn vertices(json: &Value) -> Vec<&Value> {
    let entries = json.as_array().expect("a list");
    entries.iter().map(|entry| &entry["vertices"]).collect()
}

#[neurotess_testing::test]
fn outputs_of_other_options_are_made_again() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", SMALL);
    let first = work
        .run("mesh cells -o out --level 1 --json")
        .exits(0)
        .json();
    let run = work
        .run("mesh cells -o out --level 3 --resume --json")
        .exits(0);
    assert!(
        run.stderr()
            .contains("2 outputs made with other options or by another build: made again")
    );
    let finer = run.json();
    assert!(
        vertices(&finer)
            .iter()
            .all(|n| n.as_u64() > first[0]["vertices"].as_u64())
    );
    // What changes nothing in the files changes nothing here.
    let again = "mesh cells -o out --level 3 --resume --threads 1 --strict --json";
    let json = work.run(again).exits(0).json();
    assert!(
        json[0]["skipped"] == true && json[1]["skipped"] == true,
        "{json}"
    );

    // An older file in the place of an input is seen, too.
    let other = work.file("other.swc", SMALL.replace(" 5 -1", " 6 -1"));
    let past = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    let file = fs::File::options()
        .append(true)
        .open(&other)
        .expect("opened");
    file.set_modified(past).expect("set");
    fs::rename(other, work.path("cells/a.swc")).expect("moved");
    let json = work
        .run("mesh cells -o out --level 3 --resume --json")
        .exits(0)
        .json();
    assert!(
        json[0]["vertices"].is_u64() && json[1]["skipped"] == true,
        "{json}"
    );
}

#[neurotess_testing::test]
fn what_nothing_is_known_of_stays_and_that_is_said() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.run("mesh cells -o out --level 1").exits(0);
    fs::remove_file(work.path("out/.neurotess-made")).expect("removed");
    let run = work
        .run("mesh cells -o out --level 3 --resume --json")
        .exits(0);
    assert_eq!(run.json()[0]["skipped"], true);
    assert!(
        run.stderr().contains("1 output kept, though"),
        "{}",
        run.stderr()
    );
    let forced = work
        .run("mesh cells -o out --level 3 --force --json")
        .exits(0)
        .json();
    assert!(forced[0]["vertices"].is_u64());
}

#[neurotess_testing::test]
fn several_runs_share_a_folder() {
    let work = Work::new();
    for i in 0..8 {
        work.file(&format!("cells/{i}.swc"), long_cell(100 + i));
    }
    let start = || {
        let mut command =
            work.command("mesh cells -o out --level 6 --resume --json --log log.jsonl");
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().expect("it starts")
    };
    let runs = [start(), start(), start()].map(|child| {
        let run = crate::work::Run(child.wait_with_output().expect("it ends"));
        run.exits(0).json()
    });
    // Each cell was made once, and skipped by the others.
    let mut made = BTreeMap::<String, usize>::new();
    for entry in runs
        .iter()
        .flat_map(|json| json.as_array().expect("a list"))
    {
        let file = entry["file"].as_str().expect("a name").to_owned();
        *made.entry(file).or_default() += usize::from(entry["vertices"].is_u64());
    }
    assert!(
        made.len() == 8 && made.values().all(|&times| times == 1),
        "{made:?}"
    );
    work.run("mesh cells -o alone --level 6").exits(0);
    let bytes = |folder: &str| work.files(folder).into_values().collect::<Vec<_>>();
    assert!(bytes("out") == bytes("alone"));
}

#[neurotess_testing::test]
fn a_log_that_lacks_lines_gets_them() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", SMALL);
    let log = || {
        let text = work.text("log.jsonl");
        let lines = text
            .lines()
            .map(|line| serde_json::from_str::<Value>(line).expect("JSON"));
        lines.collect::<Vec<_>>()
    };
    work.run("mesh cells -o out --level 1 --log log.jsonl")
        .exits(0);
    let text = work.text("log.jsonl");
    let b: String = text.lines().filter(|l| l.contains("b.ply")).collect();
    fs::write(work.path("log.jsonl"), b + "\n").expect("written");
    work.run("mesh cells -o out --level 1 --log log.jsonl --resume")
        .exits(0);
    let lines = log();
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(lines[1]["out"] == "out/a.ply" && lines[1]["skipped"] == true);
    work.run("mesh cells -o out --level 1 --log log.jsonl --resume")
        .exits(0);
    assert_eq!(log().len(), 2);
}

/// A soma's surface is an input as the tracing is.
#[neurotess_testing::test]
fn outputs_of_another_soma_mesh_are_made_again() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    let octahedron = |r: f64| {
        let corners = [
            [r, 0.0, 0.0],
            [-r, 0.0, 0.0],
            [0.0, r, 0.0],
            [0.0, -r, 0.0],
            [0.0, 0.0, r],
            [0.0, 0.0, -r],
        ];
        let corners = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
        let faces = "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
        corners + faces
    };
    work.file("soma.obj", octahedron(6.0));
    let mesh = "mesh a.swc -o a.ply --level 1 --soma-mesh soma.obj --resume --json";
    let volume = |json: &Value| json[0]["soma_volume"].as_f64();
    let first = work.run(mesh).exits(0).json();
    assert_eq!(work.run(mesh).exits(0).json()[0]["skipped"], true);
    work.file("soma.obj", octahedron(6.5));
    let run = work.run(mesh).exits(0);
    assert!(
        run.stderr().contains("made of another input"),
        "{}",
        run.stderr()
    );
    assert!(volume(&run.json()) > volume(&first), "{first}");
    // A tracing of another name is another input, even if nothing else tells them apart.
    let moved = work.path("b.swc");
    fs::rename(work.path("a.swc"), moved).expect("moved");
    let run = work.run(&mesh.replace("a.swc", "b.swc")).exits(0);
    assert!(run.json()[0]["vertices"].is_u64(), "{}", run.stdout());
}

/// Records of builds that made other meshes have another hash.
#[neurotess_testing::test]
fn outputs_of_an_earlier_build_are_made_again() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.run("mesh cells -o out --level 1").exits(0);
    let record = work.text("out/.neurotess-made");
    let mut line: Value = serde_json::from_str(record.trim()).expect("JSON");
    line["options"] = "0123456789abcdef".into();
    fs::write(work.path("out/.neurotess-made"), format!("{line}\n")).expect("written");
    let run = work
        .run("mesh cells -o out --level 1 --resume --json")
        .exits(0);
    assert!(run.json()[0]["vertices"].is_u64(), "{}", run.stdout());
}
