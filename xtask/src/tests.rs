//! `cargo xtask test`: set-up and every check.

use std::fmt;

use anyhow::bail;

use crate::steps::{self, Steps, cargo, run_listening};
use crate::{architecture, licenses, metadata, packages, setup};

/// Runs the command. The last line tells how many tests there were.
pub(crate) fn run() -> anyhow::Result<()> {
    let mut steps = Steps::default();
    let counts = all(&mut steps)?;
    steps.summary();
    if counts.failures.is_empty() {
        println!("\nall checks passed: {counts}");
        return Ok(());
    }
    println!("\n{counts}; these failed:");
    for failure in &counts.failures {
        println!("   {failure}");
    }
    bail!("{} failed", counts.failures.len());
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
        let ended = run_listening(&mut tests, |line| counts.hear(line));
        match ended {
            // What failed stands at the end of everything.
            Err(_) if !counts.failures.is_empty() => Ok(counts.to_string()),
            ended => ended.map(|()| counts.to_string()),
        }
    })?;
    Ok(counts)
}

/// What the test programs said of themselves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    programs: u64,
    passed: u64,
    failed: u64,
    ignored: u64,
    /// Names of the tests that failed, in order.
    failures: Vec<String>,
}

impl Counts {
    /// Counts a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; …`, and remembers one such
    /// as `test name ... FAILED`.
    fn hear(&mut self, line: &str) {
        let test = line.strip_prefix("test ");
        if let Some(name) = test.and_then(|test| test.strip_suffix(" ... FAILED")) {
            self.failures.push(name.to_owned());
        }
        let Some((_, numbers)) = line
            .strip_prefix("test result: ")
            .and_then(|rest| rest.split_once(". "))
        else {
            return;
        };
        self.programs += 1;
        for part in numbers.split(';') {
            let mut words = part.split_whitespace();
            let number = words.next().and_then(|word| word.parse::<u64>().ok());
            match (number, words.next()) {
                (Some(number), Some("passed")) => self.passed += number,
                (Some(number), Some("failed")) => self.failed += number,
                (Some(number), Some("ignored")) => self.ignored += number,
                _ => {}
            }
        }
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            programs,
            passed,
            failed,
            ignored,
            ..
        } = self;
        write!(
            f,
            "{passed} tests passed, {failed} failed, {ignored} ignored in {programs} programs"
        )
    }
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn results_are_added_up() {
        let mut counts = Counts::default();
        counts.hear("test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out");
        counts.hear("test result: ok. 2 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out");
        counts.hear("test nonsense ... ok");
        counts.hear("test sense ... FAILED");
        assert_eq!(counts.failures, ["sense"]);
        assert_eq!(
            counts.to_string(),
            "5 tests passed, 0 failed, 1 ignored in 2 programs"
        );
    }
}
