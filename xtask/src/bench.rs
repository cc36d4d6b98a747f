//! `cargo xtask bench`: times every stage beside other tools, all in one run.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::bail;

use crate::python::{self, BENCHMARKS};
use crate::steps::{self, Steps, cargo, root, target_folder};

/// Tracings with fewer bytes say more about the clock than about the program.
const SMALLEST: u64 = 4096;

/// Runs the command.
pub(crate) fn run() -> anyhow::Result<()> {
    let mut steps = Steps::default();
    steps.step("build", || {
        steps::run(&mut cargo("build --release --locked -p neurotess-cli"))?;
        steps::run(&mut cargo(
            "build --release --locked -p neurotess --example stages",
        ))?;
        Ok("the program and the stopwatch".into())
    })?;
    steps.step("setup", || python::set_up(&BENCHMARKS))?;
    let mut samples = tracings(&root().join("samples"));
    samples.extend(tracings(&root().join("../shared/data/swc")));
    let Some(python) = python::interpreter(&BENCHMARKS) else {
        bail!(
            "the benchmarks are run by Python 3 with the packages of benchmarks/requirements.txt"
        );
    };
    steps.step("bench", || {
        let mut command = Command::new(&python);
        command
            .current_dir(root())
            .arg("benchmarks/bench.py")
            .arg("--bin")
            .arg(target_folder()?.join("release"))
            .args(["--out", "out/bench", "--peers"])
            .arg(&python)
            .arg("--samples")
            .args(&samples);
        steps::run(&mut command)?;
        Ok("figures in out/bench/benchmarks.md".into())
    })?;
    steps.summary();
    Ok(())
}

fn tracings(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        println!(
            "   no folder {}: benchmarks do without it",
            folder.display()
        );
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries
        .filter_map(Result::ok)
        .filter(|entry| entry.metadata().is_ok_and(|m| m.len() >= SMALLEST))
        .filter_map(|entry| entry.path().canonicalize().ok())
        .filter(|path| path.extension().is_some_and(|e| e == "swc"))
        .collect();
    files.sort();
    files
}
