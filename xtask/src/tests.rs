//! `cargo xtask test`: set-up and every check.

use std::fmt;

use crate::steps::{self, Steps, cargo, run_listening};
use crate::{architecture, licences, metadata, setup};

/// Runs the command. The last line tells how many tests there were.
pub(crate) fn run() -> anyhow::Result<()> {
    let mut steps = Steps::default();
    let counts = all(&mut steps)?;
    steps.summary();
    println!("\nall checks passed: {counts}");
    Ok(())
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
    steps.step("licences", || licences::check(&metadata))?;
    steps.step("clippy", || {
        let clippy = "clippy --workspace --all-targets --locked -- -D warnings";
        steps::run(&mut cargo(clippy)).map(|()| "no warning".into())
    })?;
    steps.step("doc", || {
        let mut doc = cargo("doc --workspace --no-deps --locked");
        steps::run(doc.env("RUSTDOCFLAGS", "-D warnings")).map(|()| "no warning".into())
    })?;
    steps.step("test", || {
        run_listening(&mut cargo("test --workspace --locked"), |line| {
            counts.hear(line);
        })?;
        Ok(counts.to_string())
    })?;
    Ok(counts)
}

/// What the test programs said of themselves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    programs: u64,
    passed: u64,
    failed: u64,
    ignored: u64,
}

impl Counts {
    /// Counts a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; …`.
    fn hear(&mut self, line: &str) {
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
        assert_eq!(
            counts.to_string(),
            "5 tests passed, 0 failed, 1 ignored in 2 programs"
        );
    }
}
