//! Writes the page that takes tracings: `dropping_page CORE.wasm LICENSES.txt SAMPLE.swc OUT.html`. `cargo xtask web` makes
//! the core and the licenses, and runs this.

#![allow(clippy::print_stderr, reason = "an example tells what failed")]

use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

use neurotess_web::dropping_page;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match written(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::FAILURE
        }
    }
}

fn written(arguments: &[String]) -> Result<(), String> {
    let [core, licenses, sample, out] = arguments else {
        return Err("CORE.wasm LICENSES.txt SAMPLE.swc OUT.html are needed".into());
    };
    let read = |path: &str| fs::read(path).map_err(|e| format!("{path}: {e}"));
    let text = |path: &str| fs::read_to_string(path).map_err(|e| format!("{path}: {e}"));
    let name = Path::new(sample).file_name().unwrap_or_default();
    let page = dropping_page(
        &read(core)?,
        &text(licenses)?,
        (&name.to_string_lossy(), &text(sample)?),
    );
    let page = page.map_err(|e| e.to_string())?;
    fs::write(out, page).map_err(|e| format!("{out}: {e}"))
}
