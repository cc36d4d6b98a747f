//! `cargo xtask test`: set-up and every check of a lane.

use anyhow::bail;

use crate::counts::Counts;
use crate::lane::Lane;
use crate::programs;
use crate::steps::{self, Steps, cargo, run_listening};
use crate::{architecture, extension, harness, licenses, metadata, packages, setup, web};

/// Runs the command. The last lines tell what the steps took, which tests took longest, how many there were, which
/// were skipped and why, and which failed.
pub(crate) fn run(lane: Lane) -> anyhow::Result<()> {
    let mut steps = Steps::default();
    let counts = all(lane, &mut steps)?;
    steps.summary();
    steps.record(lane.name())?;
    print!("\n{}{}", counts.slowest(), counts.skipped_tests());
    if counts.failures().is_empty() {
        println!("all checks of the {} lane passed: {counts}", lane.name());
        return Ok(());
    }
    println!("{counts}; these failed:");
    for failure in counts.failures() {
        println!("   {failure}");
    }
    bail!("{} failed", counts.failures().len());
}

/// Runs all steps, the cheap ones first.
fn all(lane: Lane, steps: &mut Steps) -> anyhow::Result<Counts> {
    let mut counts = Counts::default();
    steps.step("setup", || setup::run(lane))?;
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
    steps.step("features", || packages::features(lane))?;
    if lane == Lane::Full {
        steps.step("package", packages::package)?;
        steps.step("web", web::check)?;
    }
    let mut built = Vec::new();
    steps.step("build", || {
        built = programs::build(lane)?;
        Ok(format!("{} test programs", built.len()))
    })?;
    steps.step("test", || {
        programs::run(&built, lane, &mut counts)?;
        Ok(counts.to_string())
    })?;
    steps.step("doc tests", || doc_tests(&mut counts))?;
    steps.step("python", || extension::test(lane, &mut counts))?;
    Ok(counts)
}

/// Runs the examples in documentation.
fn doc_tests(counts: &mut Counts) -> anyhow::Result<String> {
    let mut tests = cargo("test --workspace --locked --doc --no-fail-fast");
    // Lines are read: without colors.
    tests.env("CARGO_TERM_COLOR", "never").env("NO_COLOR", "1");
    tests.env_remove("CLICOLOR_FORCE");
    let failed_before = counts.failures().len();
    match run_listening(&mut tests, |line| counts.hear(line)) {
        // What failed stands at the end of everything.
        Err(_) if counts.failures().len() > failed_before => Ok("some failed".into()),
        ended => ended.map(|()| "they do what they show".into()),
    }
}
