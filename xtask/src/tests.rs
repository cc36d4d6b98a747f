//! `cargo xtask test`: set-up and every check.

use anyhow::bail;

use crate::counts::Counts;
use crate::steps::{self, Steps, cargo, run_listening};
use crate::{architecture, extension, harness, licenses, metadata, packages, setup};

/// Runs the command. The last lines tell how many tests there were, which were skipped and why, and which
/// failed.
pub(crate) fn run() -> anyhow::Result<()> {
    let mut steps = Steps::default();
    let counts = all(&mut steps)?;
    steps.summary();
    print!("\n{}", counts.skipped_tests());
    if counts.failures().is_empty() {
        println!("all checks passed: {counts}");
        return Ok(());
    }
    println!("{counts}; these failed:");
    for failure in counts.failures() {
        println!("   {failure}");
    }
    bail!("{} failed", counts.failures().len());
}

/// Runs all steps, the cheap ones first.
fn all(steps: &mut Steps) -> anyhow::Result<Counts> {
    let mut counts = Counts::default();
    steps.step("setup", setup::run)?;
    steps.step("format", || {
        steps::run(&mut cargo("fmt --all --check")).map(|()| "as rustfmt has it".into())
    })?;
    let metadata = metadata::read()?;
    steps.step("architecture", || architecture::check(&metadata))?;
    steps.step("harness", harness::check)?;
    steps.step("licenses", || licenses::check(&metadata))?;
    steps.step("clippy", || {
        let clippy = "clippy --workspace --all-targets --locked -- -D warnings";
        steps::run(&mut cargo(clippy)).map(|()| "no warning".into())
    })?;
    steps.step("doc", || {
        let mut doc = cargo("doc --workspace --no-deps --locked");
        steps::run(doc.env("RUSTDOCFLAGS", "-D warnings")).map(|()| "no warning".into())
    })?;
    steps.step("features", packages::features)?;
    steps.step("package", packages::package)?;
    steps.step("test", || {
        let mut tests = cargo("test --workspace --locked --no-fail-fast");
        // Lines are read: without colors.
        tests.env("CARGO_TERM_COLOR", "never").env("NO_COLOR", "1");
        tests.env_remove("CLICOLOR_FORCE");
        let ended = run_listening(&mut tests, |line| counts.hear(line));
        match ended {
            // What failed stands at the end of everything.
            Err(_) if !counts.failures().is_empty() => Ok(counts.to_string()),
            ended => ended.map(|()| counts.to_string()),
        }
    })?;
    steps.step("python", || extension::test(&mut counts))?;
    Ok(counts)
}
