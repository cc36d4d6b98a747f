//! Standard input and output: `-`, one JSON document, and what is said when it cannot be written.

use std::fs::{self, File};
use std::io::Write;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::work::{BROKEN, Run, SMALL, Work};

fn fed(mut command: Command, input: &[u8]) -> Run {
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn().expect("it starts");
    // A program that refuses its arguments does not read.
    drop(child.stdin.take().expect("piped").write_all(input));
    Run(child.wait_with_output().expect("it ends"))
}

#[neurotess_testing::test]
fn minus_is_standard_input_and_output() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let json = fed(work.command("info - --json"), SMALL.as_bytes())
        .exits(0)
        .json();
    assert_eq!(
        (&json[0]["file"], &json[0]["n_points"]),
        (&"-".into(), &6.into())
    );
    let error = fed(work.command("info -"), BROKEN.as_bytes())
        .exits(1)
        .stderr();
    assert!(error.starts_with("error: -:2: 6 columns"), "{error}");

    let asc = fed(
        work.command("convert - -o - --format asc"),
        SMALL.as_bytes(),
    )
    .exits(0);
    let back = fed(
        work.command("info - --json --format asc"),
        asc.stdout().as_bytes(),
    );
    assert_eq!(back.exits(0).json()[0]["n_ends"], 3);

    work.run("mesh cell.swc -o file.glb --level 2").exits(0);
    let glb = fed(
        work.command("mesh - -o - --format glb --level 2"),
        SMALL.as_bytes(),
    )
    .exits(0);
    assert!(glb.0.stdout == fs::read(work.path("file.glb")).expect("there"));
    let verdict = fed(work.command("check - --format glb --json"), &glb.0.stdout).exits(0);
    assert_eq!(verdict.json()[0]["closed"], true);

    let grown = work.run("synth granule --points 60 -o -").exits(0);
    assert!(
        fed(work.command("info -"), &grown.0.stdout)
            .exits(0)
            .stdout()
            .contains("points")
    );
    for wrong in [
        "mesh cell.swc -o -",
        "mesh . -o - --format ply",
        "mesh cell.swc -o - --format ply --json",
        "synth star -o - --count 2",
        "synth circuit -o -",
    ] {
        work.run(wrong).exits(2);
    }
    work.run("check - ").exits(1);
}

#[cfg(target_os = "linux")]
#[neurotess_testing::test]
fn a_full_disk_behind_standard_output_is_an_error() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for command in [
        "info cell.swc",
        "info cell.swc --json",
        "mesh cell.swc -o a.ply --json",
        "mesh cell.swc -o - --format ply",
        "convert cell.swc -o - --format swc",
        "completions bash",
        "man",
        "--version",
        "--help",
    ] {
        let full = File::options()
            .write(true)
            .open("/dev/full")
            .expect("there");
        let mut command_line = work.command(command);
        let run = Run(command_line.stdout(full).output().expect("it runs"));
        assert_eq!(run.code(), 1, "{command}");
        let said = run.stderr();
        assert!(
            said.contains("standard output cannot be written"),
            "{command}: {said}"
        );
    }
}

#[cfg(unix)]
#[neurotess_testing::test]
fn a_reader_that_has_gone_is_no_error() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for arguments in ["info cell.swc", "mesh cell.swc -o - --format ply -q", "man"] {
        let mut command = work.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        drop(child.stdout.take());
        let run = Run(child.wait_with_output().expect("it ends"));
        assert_eq!((run.code(), run.stderr().as_str()), (0, ""), "{arguments}");
    }
}

#[neurotess_testing::test]
fn whatever_fails_json_is_one_document() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("broken.neurotess", "version = ");
    work.file("circuit/circuit_config.json", r#"{"networks": 3}"#);
    work.file("report.h5", "no report");
    work.run("synth circuit -o good --neurons 3 --morphologies 1 --reported 2")
        .exits(0);
    for (command, code) in [
        ("render broken.neurotess -o a.png", 1),
        ("render circuit -o a.png", 1),
        ("render good -o a.png --report report.h5", 1),
        ("render cell.swc -o a.jpg", 2),
        ("render cell.swc -o a.png --adapter none-such", 1),
        ("info circuit", 1),
        ("info missing.swc nothing/*.swc", 1),
        ("mesh circuit -o out", 1),
        ("mesh circuit -o out.glb", 1),
        ("mesh cell.swc cell.swc circuit -o out", 2),
        ("mesh cell.swc -o out.xyz", 2),
        ("mesh cell.swc -o out.ply --nonsense", 2),
        ("check missing.ply", 1),
        ("convert missing.swc -o a.asc", 1),
        ("synth star -o cell.swc", 1),
        ("synth circuit -o cell.swc", 2),
        ("synth circuit -o good", 1),
        ("nonsense", 2),
        ("completions bash", 0),
        ("man mesh", 0),
        ("man nonsense", 2),
        ("--version", 0),
    ] {
        let run = work.run(&format!("{command} --json"));
        assert_eq!(run.code(), code, "{command}: {}", run.stderr());
        let document: Result<Value, _> = serde_json::from_slice(&run.0.stdout);
        let document = document.unwrap_or_else(|e| panic!("{command}: {e}: {}", run.stdout()));
        assert!(
            code == 0 || document.to_string().contains("error"),
            "{command}: {document}"
        );
    }
}

#[neurotess_testing::test]
fn errors_name_file_and_line_one_way() {
    let work = Work::new();
    work.file("broken.swc", BROKEN);
    work.file("broken.neurotess", "version = ");
    work.file("circuit.json", "{\n\"networks\": 3,}");
    work.file("cells.scene.toml", "cells = []\nx");
    work.file("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0\n");
    for (command, file_and_line) in [
        ("info broken.swc", "error: broken.swc:2: "),
        (
            "render broken.neurotess -o a.png",
            "error: broken.neurotess:1: ",
        ),
        ("info circuit.json", "error: circuit.json:2: "),
        ("info cells.scene.toml", "error: cells.scene.toml:2: "),
        ("check mesh.off", "error: mesh.off:4: "),
    ] {
        let said = work.run(command).exits(1).stderr();
        assert!(said.starts_with(file_and_line), "{command}: {said}");
    }
}

#[neurotess_testing::test]
fn pages_of_the_manual_are_roff() {
    let work = Work::new();
    for (command, title) in [("man", "neurotess"), ("man mesh", "neurotess-mesh")] {
        let page = work.run(command).exits(0).stdout();
        assert!(page.contains(&format!(".TH {title} 1")), "{page}");
        assert!(page.contains(".SH SYNOPSIS") && page.contains(".SH OPTIONS"));
    }
}

#[neurotess_testing::test]
fn shells_complete_palettes_and_color_maps() {
    let work = Work::new();
    let script = work.run("completions bash").exits(0).stdout();
    assert!(script.contains("viridis magma") && script.contains("neurom neuromorpho"));
}

/// Mesa's layer that selects devices says an error where there is no display and nothing keeps it away.
#[cfg(target_os = "linux")]
#[neurotess_testing::test(needs(crate::needs::gpu))]
fn pictures_without_a_window_ask_for_no_display() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut command = work.command("render cell.swc -o a.png --size 64x48 --samples 1 -q");
    for name in [
        "NODEVICE_SELECT",
        "XDG_RUNTIME_DIR",
        "DISPLAY",
        "WAYLAND_DISPLAY",
    ] {
        command.env_remove(name);
    }
    let run = Run(command.output().expect("it runs")).exits(0);
    assert_eq!(run.stderr(), "");
}
