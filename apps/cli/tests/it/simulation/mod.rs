//! Files for simulators: what `docs/simulation.md` shows, what `--unit`, `--table`, `--areas` and `--walls` write, and
//! that real cells have no handles.

mod areas;
mod handles;
mod page;
mod radii;
mod table;
mod unit;
mod walls;

use std::process::Command;

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
