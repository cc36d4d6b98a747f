//! `cargo xtask web`: the page that takes tracings, as one file: the core as WebAssembly, the page around it.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::Context;

use crate::programs::executable;
use crate::steps::{Steps, root, run, target_folder};
use crate::third_party::{self, Module};
use crate::wasm::{BY_HAND, Library, TARGET};

/// Where it goes, from the workspace.
const FOLDER: &str = "out/web";
const PAGE: &str = "out/web/index.html";
/// The cell that is there before a file is: small.
const SAMPLE: &str = "samples/granule.swc";

/// What is compiled into the page.
const CORE: Module = Module {
    package: "neurotess-wasm",
    target: Some(TARGET),
    what: "Its core for browsers",
};

/// Runs the command.
pub(crate) fn run_all() -> anyhow::Result<()> {
    let mut steps = Steps::default();
    steps.step("setup", || Ok(crate::wasm::set_up()))?;
    let library = Library::find()?;
    let library = library.with_context(|| format!("there is no library: {BY_HAND}"))?;
    steps.step("core", || core(&library).map(|(_, said)| said))?;
    steps.step("page", || page(&library))?;
    steps.summary();
    Ok(())
}

/// The core without warnings, the renderer, and the page, for the full lane. Without the library, the page is taken away, so that no
/// test takes an old one for it.
pub(crate) fn check() -> anyhow::Result<String> {
    let Some(library) = Library::find()? else {
        let page = root().join(PAGE);
        if page.exists() {
            fs::remove_file(page)?;
        }
        return Ok(format!(
            "skipped: there is no library for WebAssembly: {BY_HAND}"
        ));
    };
    let clippy = "clippy --locked --package neurotess-wasm";
    run(library.cargo(clippy).args(["--", "-D", "warnings"]))?;
    let renderer = "check --locked --package neurotess-render --features webgpu";
    run(&mut library.cargo(renderer))?;
    page(&library)
}

/// Builds the core. Says how large it is.
fn core(library: &Library) -> anyhow::Result<(PathBuf, String)> {
    let build = "rustc --locked --package neurotess-wasm --lib --crate-type cdylib --profile wasm";
    run(&mut library.cargo(build))?;
    let core = target_folder()?
        .join(TARGET)
        .join("wasm/neurotess_wasm.wasm");
    let bytes = fs::metadata(&core).context("the core")?.len();
    Ok((core, format!("{:.1} MB", bytes as f64 / 1e6)))
}

/// Builds the page.
fn page(library: &Library) -> anyhow::Result<String> {
    let (core, _) = core(library)?;
    fs::create_dir_all(root().join(FOLDER))?;
    let licenses = target_folder()?.join("wasm/LICENSE-THIRD-PARTY.txt");
    fs::create_dir_all(licenses.parent().context("a folder")?)?;
    let collected = third_party::collect(&CORE)?;
    fs::write(&licenses, &collected.text)?;
    let page = root().join(PAGE);
    // With the features of the whole workspace: so all that is built already is used.
    let program = executable("build --locked --workspace --example dropping_page")?;
    let mut write = Command::new(program);
    write.current_dir(root());
    run(write.arg(&core).arg(&licenses).args([SAMPLE, PAGE]))?;
    let bytes = fs::metadata(&page)?.len();
    Ok(format!("{PAGE} ({:.1} MB)", bytes as f64 / 1e6))
}
