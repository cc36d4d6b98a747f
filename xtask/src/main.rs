//! `cargo xtask COMMAND`: what the README's commands run.
//!
//! Each command is a list of steps; the first that fails ends it and is shown as it could be typed.
#![forbid(unsafe_code)]
#![allow(
    clippy::print_stdout,
    reason = "telling what is done is what this program is for"
)]

mod architecture;
mod bench;
mod counts;
mod demo;
mod extension;
mod gpu;
mod harness;
mod lane;
mod licenses;
mod metadata;
mod modules;
mod named_files;
mod packages;
mod pictures;
mod programs;
mod python;
mod python_modules;
mod quality;
mod scenery;
mod setup;
mod soak;
mod steps;
mod tests;
mod third_party;
mod wasm;
mod web;
mod wheel;

use std::process::ExitCode;

use lane::Lane;

const USAGE: &str = "cargo xtask COMMAND

  demo      mesh and draw the built-in samples into out/, check the meshes, say where to look
  test      set up, then what every change must pass: formatting, clippy, tests, docs, licenses,
            architecture, features; with --full everything: what takes long, other programs that read our
            files, every feature alone, packages
  features  check each feature of the library and the command line alone
  package   pack every crate as for a registry
  python    the Python package's tests alone; with --full those beside other packages, too
  wheel     the Python package as a wheel in out/wheel, with all licenses, and a trial of it in a fresh
            environment; with --from-source also `pip install bindings/python/` (builds all again)
  web       the page that takes tracings and meshes them in the browser: out/web/index.html, one file
  soak      property tests and fuzzers with new seeds, for MINUTES (10): more than 100,000 trees
  gpu-bundle
            a folder that tests and measures on a machine with graphics hardware and nothing but a driver:
            out/gpu-bundle, to be started by its run.sh
  gpu-page  put the figures of such a run, FILE.json, into benchmarks/gpu.md
  sweep     which numbers of generate and union move these figures: each times 0.7 and 1.3, or as in
            generate/plan/zone 0.5 2; one copy is built, the checkout stays as it is
  quality   what meshes of real cells are worth, as a table: crossings, folds, meshes for simulations; and
            whether sums got worse by more than 5 % than the recorded base, with --against BEFORE.json
            also than those; with --page benchmarks/quality.md, with --base a new base
  bench     time reading and meshing beside other tools; figures in out/bench/benchmarks.md
  architecture
            who knows whom among crates, folders and files; whether the files that pages name are there
  setup     a software Vulkan driver where there is none, a virtual display, and the Python environment
            of the package's tests (where Python 3 is); with --full other programs that read our
            files, Chromium, Valgrind and Rust's library for WebAssembly
  pictures  draw the README's pictures; with --golden those that tests compare with
";

fn main() -> ExitCode {
    let command = std::env::args().nth(1);
    let lane = match std::env::args().any(|argument| argument == "--full") {
        true => Lane::Full,
        false => Lane::Quick,
    };
    let done = match command.as_deref() {
        Some("demo") => demo::run(),
        Some("test") => tests::run(lane),
        Some("features") => packages::features(Lane::Full).map(|said| println!("{said}")),
        Some("package") => packages::package().map(|said| println!("{said}")),
        Some("python") => extension::run_alone(lane),
        Some("wheel") => {
            wheel::run_all(std::env::args().nth(2).as_deref() == Some("--from-source"))
        }
        Some("web") => web::run_all(),
        Some("soak") => soak::run(std::env::args().nth(2).as_deref()),
        Some("gpu-bundle") => gpu::bundle::run(),
        // In the bundle, where run.sh calls it.
        Some("gpu-run") => gpu::run::run(std::env::args().skip(2)),
        Some("gpu-page") => gpu::publish::run(std::env::args().skip(2)),
        Some("bench") => bench::run(),
        Some("quality") => quality::run(std::env::args().skip(2)),
        Some("sweep") => quality::sweep::run(std::env::args().skip(2)),
        Some("architecture") => architecture(),
        Some("setup") => setup::run(lane).map(|said| println!("{said}")),
        Some("pictures") => pictures::run(std::env::args().nth(2).as_deref() == Some("--golden")),
        _ => {
            println!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            println!("\nFAILED: {e:#}");
            ExitCode::FAILURE
        }
    }
}

fn architecture() -> anyhow::Result<()> {
    architecture::check(&metadata::read()?).map(|said| println!("{said}"))
}
