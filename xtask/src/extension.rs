//! The Python package's tests: its extension module is built beside all else, and pytest runs in the
//! environment that other readers have.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, bail};

use crate::counts::Counts;
use crate::lane::Lane;
use crate::programs;
use crate::python;
use crate::steps::{root, run_listening, target_folder};

/// The package's sources, into which the module is put, as `maturin develop` does.
const PACKAGE: &str = "bindings/python/python";

/// Sets up the environment and runs the package's tests alone.
pub(crate) fn run_alone(lane: Lane) -> anyhow::Result<()> {
    println!("   {}", python::set_up(python::of_tests(lane))?);
    let mut counts = Counts::default();
    programs::build(lane)?;
    test(lane, &mut counts)?;
    print!("\n{}", counts.skipped_tests());
    println!("{counts}");
    match counts.failures() {
        [] => Ok(()),
        failures => bail!("{} failed", failures.len()),
    }
}

/// Puts the module that was built into the package, and runs the package's tests of a lane.
pub(crate) fn test(lane: Lane, counts: &mut Counts) -> anyhow::Result<String> {
    let Some(python) = python::interpreter(python::of_tests(lane)) else {
        counts.hear("     Running tests/python (pytest-0)");
        counts.hear("test all ... ignored (no Python environment)");
        counts.hear("test result: ok. 0 passed; 0 failed; 1 ignored");
        return Ok("skipped: no Python environment".into());
    };
    place()?;
    let mut pytest = Command::new(python);
    pytest
        .args([
            "-m",
            "pytest",
            "-q",
            "-p",
            "no:cacheprovider",
            // As many at once as there are processors; one that is free takes from those that are not.
            "-n",
            "auto",
            "--dist",
            "worksteal",
            "tests/python",
        ])
        .current_dir(root())
        .envs(lane.variables())
        .env("PYTHONPATH", root().join(PACKAGE))
        // Beside the sources they would stay.
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("MPLBACKEND", "agg");
    let before = counts.failures().len();
    let ended = run_listening(&mut pytest, |line| counts.hear(line));
    match counts.failures().len() - before {
        // What failed stands at the end of everything.
        0 => ended.map(|()| "as documented".into()),
        failed => Ok(format!("{failed} failed")),
    }
}

/// Puts the extension module where Python looks for it.
fn place() -> anyhow::Result<()> {
    let (built, named) = if cfg!(windows) {
        ("neurotess_python.dll", "_neurotess.pyd")
    } else if cfg!(target_os = "macos") {
        ("libneurotess_python.dylib", "_neurotess.abi3.so")
    } else {
        ("libneurotess_python.so", "_neurotess.abi3.so")
    };
    let from = target_folder()?.join("debug").join(built);
    let to: PathBuf = root().join(PACKAGE).join("neurotess").join(named);
    // Not over the old one: a program that has it open would see it change.
    if to.exists() {
        fs::remove_file(&to).with_context(|| to.display().to_string())?;
    }
    fs::copy(&from, &to).with_context(|| from.display().to_string())?;
    Ok(())
}
