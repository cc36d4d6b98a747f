//! Files for simulators: what `docs/simulation.md` shows, and what `--unit`, `--table` and `--walls` write, and
//! that real cells have no handles.

mod handles;
mod page;
mod radii;
mod table;
mod unit;
mod walls;

use std::path::PathBuf;
use std::process::Command;

/// The repository's folder.
fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs the command in a folder; what it prints, or what is wrong.
fn neurotess(folder: &std::path::Path, arguments: &str) -> Result<String, String> {
    let output = Command::new(env!("CARGO_BIN_EXE_neurotess"))
        .args(arguments.split(' '))
        .current_dir(folder)
        .output()
        .expect("the command starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match output.status.success() {
        true => Ok(text(&output.stdout)),
        false => Err(text(&output.stderr)),
    }
}

/// The path of a sample.
fn sample(name: &str) -> String {
    root().join("samples").join(name).display().to_string()
}

neurotess_testing::main!();
