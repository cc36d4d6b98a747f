//! Interrupted and killed runs.
#![cfg(unix)]

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::work::{SMALL, Work, long_cell};

fn start(work: &Work, arguments: &str) -> Child {
    let mut command = work.command(arguments);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("it starts")
}

/// Waits until the folder has a file.
fn wait_for_a_file(work: &Work, folder: &str) {
    let clock = Instant::now();
    while work.names(folder).is_empty() {
        assert!(
            clock.elapsed() < Duration::from_secs(60),
            "nothing is written"
        );
        sleep(Duration::from_millis(2));
    }
}

fn send(signal: &str, child: &Child) {
    let status = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status();
    assert!(status.expect("kill runs").success());
}

#[neurotess_testing::test]
fn interrupted_runs_leave_nothing_and_exit_with_130() {
    let work = Work::new();
    work.file("cell.swc", long_cell(3000));
    for signal in ["-INT", "-TERM"] {
        let mut child = start(&work, "mesh cell.swc -o out/cell.obj --level 64");
        wait_for_a_file(&work, "out");
        assert_eq!(work.names("out"), [".cell.obj.neurotess-part"]);
        send(signal, &child);
        let status = child.wait().expect("it ends");
        assert_eq!(status.code(), Some(130), "{signal}");
        assert!(work.files("out").is_empty(), "{:?}", work.names("out"));
    }
}

#[neurotess_testing::test]
fn an_interrupted_run_says_so_in_its_document() {
    let work = Work::new();
    work.file("cell.swc", long_cell(3000));
    let mut command = work.command("mesh cell.swc -o out/cell.obj --level 64 --json");
    command.stdout(Stdio::piped()).stderr(Stdio::null());
    let child = command.spawn().expect("it starts");
    wait_for_a_file(&work, "out");
    send("-INT", &child);
    let out = child.wait_with_output().expect("it ends");
    assert_eq!(out.status.code(), Some(130));
    let document: serde_json::Value = serde_json::from_slice(&out.stdout).expect("one document");
    let error = document["errors"][0].as_str().unwrap_or_default();
    assert!(error.starts_with("interrupted"), "{document}");
}

#[neurotess_testing::test]
fn killed_and_started_again_gives_the_same_files() {
    let work = Work::new();
    for i in 0..12 {
        let text = if i % 3 == 0 {
            long_cell(200 + i)
        } else {
            SMALL.to_owned()
        };
        work.file(&format!("cells/{i}.swc"), text);
    }
    work.run("mesh cells -o whole --level 8").exits(0);
    // At several times: while the first files are written, and a little later.
    for pause in [0, 15, 60] {
        let mut child = start(
            &work,
            "mesh cells -o again --level 8 --resume --log log.jsonl",
        );
        wait_for_a_file(&work, "again");
        sleep(Duration::from_millis(pause));
        // It may have ended by itself.
        drop(child.kill());
        child.wait().expect("it ends");
    }
    work.run("mesh cells -o again --level 8 --resume --log log.jsonl")
        .exits(0);
    assert_eq!(work.names("whole"), work.names("again"));
    // Whenever it ends, no output lacks its line.
    let log = work.text("log.jsonl");
    for name in work.names("again") {
        assert!(log.contains(&format!("\"again/{name}\"")), "{name}");
    }
    let bytes = |folder: &str| work.files(folder).into_values().collect::<Vec<_>>();
    assert!(bytes("whole") == bytes("again"));
}
