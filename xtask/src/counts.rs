//! What test programs print, added up: how many tests passed, failed and were skipped, and why.

use std::collections::BTreeMap;
use std::fmt;

/// What all test programs of a run said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    programs: u64,
    passed: u64,
    failed: u64,
    skipped: u64,
    /// The program that speaks, by its source.
    program: String,
    failures: Vec<String>,
    /// Names of skipped tests by reason.
    reasons: BTreeMap<String, Vec<String>>,
    /// Tests that took long: milliseconds, and the name after its program.
    long: Vec<(u64, String)>,
}

/// How many of the slowest tests are told of.
const SLOWEST: usize = 3;

impl Counts {
    /// Lines that follow are of this program.
    pub(crate) fn begin(&mut self, program: &str) {
        program.clone_into(&mut self.program);
    }

    /// Takes a line of standard output or of standard error.
    pub(crate) fn hear(&mut self, line: &str) {
        let line = line.trim_end();
        if let Some(program) = started(line) {
            self.program = program;
        } else if let Some(numbers) = line.strip_prefix("test result: ") {
            self.add(numbers);
        } else if let Some((milliseconds, name)) = took(line) {
            self.long.push((milliseconds, self.of_program(name)));
        } else if let Some((name, outcome)) = outcome(line) {
            let name = self.of_program(name);
            match skip_reason(outcome) {
                Some(reason) => self.reasons.entry(reason.into()).or_default().push(name),
                None if outcome == "FAILED" => self.failures.push(name),
                None => {}
            }
        }
    }

    /// The name of a test after its program.
    fn of_program(&self, test: &str) -> String {
        match &self.program {
            program if program.is_empty() => test.to_owned(),
            program => format!("{program}: {test}"),
        }
    }

    /// `ok. 3 passed; 0 failed; 1 ignored; …`
    fn add(&mut self, numbers: &str) {
        let Some((_, numbers)) = numbers.split_once(". ") else {
            return;
        };
        self.programs += 1;
        for part in numbers.split(';') {
            let Some((number, what)) = part.trim().split_once(' ') else {
                continue;
            };
            let number = number.parse().unwrap_or(0);
            match what {
                "passed" => self.passed += number,
                "failed" => self.failed += number,
                "ignored" => self.skipped += number,
                _ => {}
            }
        }
    }

    /// The tests that failed, each after its program, in the order of their lines.
    pub(crate) fn failures(&self) -> &[String] {
        &self.failures
    }

    /// The slowest tests with their times, as lines.
    pub(crate) fn slowest(&self) -> String {
        let mut long = self.long.clone();
        long.sort_by(|a, b| b.cmp(a));
        let line = |(ms, name): &(u64, String)| format!("   {:.1} s: {name}\n", *ms as f64 / 1e3);
        let lines: String = long.iter().take(SLOWEST).map(line).collect();
        match lines.is_empty() {
            true => lines,
            false => format!("slowest tests\n{lines}"),
        }
    }

    /// Every skipped test under its reason, as lines; nothing where none was skipped.
    pub(crate) fn skipped_tests(&self) -> String {
        let mut text = String::new();
        for (reason, names) in &self.reasons {
            text += &format!("{} skipped: {reason}\n", names.len());
            for name in names {
                text += &format!("   {name}\n");
            }
        }
        let named = self.reasons.values().map(|names| names.len() as u64).sum();
        if let Some(unnamed) = self.skipped.checked_sub(named).filter(|&count| count > 0) {
            text += &format!("{unnamed} skipped without a line of their own\n");
        }
        text
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            programs,
            passed,
            failed,
            skipped,
            ..
        } = self;
        write!(
            f,
            "{passed} passed, {failed} failed, {skipped} skipped in {programs} programs"
        )
    }
}

/// The program in Cargo's `Running tests/closed.rs (target/debug/deps/closed-0123)`, which is
/// `closed tests/closed.rs`; libraries and their documentation likewise.
fn started(line: &str) -> Option<String> {
    let line = line.trim_start();
    if let Some(library) = line.strip_prefix("Doc-tests ") {
        return Some(format!("{library} doc"));
    }
    let (source, file) = line.strip_prefix("Running ")?.split_once(" (")?;
    let file = file.strip_suffix(')')?.rsplit(['/', '\\']).next()?;
    let (program, _) = file.rsplit_once('-')?;
    Some(format!(
        "{program} {}",
        source.trim_start_matches("unittests ")
    ))
}

/// Name and outcome in `test name ... outcome`. Our harness pads names; libtest adds to the names of
/// tests that should panic.
fn outcome(line: &str) -> Option<(&str, &str)> {
    let (name, outcome) = line.strip_prefix("test ")?.split_once(" ... ")?;
    Some((name.trim_end(), outcome))
}

/// Milliseconds and name in `took 3.214 s name`.
fn took(line: &str) -> Option<(u64, &str)> {
    let (seconds, name) = line.strip_prefix("took ")?.split_once(" s ")?;
    let seconds: f64 = seconds.parse().ok()?;
    Some(((1e3 * seconds) as u64, name))
}

/// The reason in `ignored, reason` (libtest) or `ignored (reason)` (ours).
fn skip_reason(outcome: &str) -> Option<&str> {
    let rest = outcome.strip_prefix("ignored")?;
    let inner = rest.strip_prefix(" (").and_then(|r| r.strip_suffix(')'));
    let reason = inner.or_else(|| rest.strip_prefix(", "));
    Some(reason.unwrap_or("for no reason that is given"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(lines: &[&str]) -> Counts {
        let mut counts = Counts::default();
        for line in lines {
            counts.hear(line);
        }
        counts
    }

    #[test]
    fn results_are_added_up() {
        let counts = heard(&[
            "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out",
            "test result: FAILED. 2 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out",
            "test nonsense ... ok",
        ]);
        assert_eq!(
            counts.to_string(),
            "5 passed, 1 failed, 1 skipped in 2 programs"
        );
        assert_eq!(
            counts.skipped_tests(),
            "1 skipped without a line of their own\n"
        );
    }

    #[test]
    fn the_slowest_tests_are_named() {
        let mut counts = Counts::default();
        counts.begin("neurotess-render it");
        assert_eq!(counts.slowest(), "");
        for (seconds, name) in [(0.7, "a"), (11.5, "b"), (2.25, "c"), (0.5, "d")] {
            counts.hear(&format!("took {seconds} s {name}"));
        }
        let text = "\
slowest tests
   11.5 s: neurotess-render it: b
   2.2 s: neurotess-render it: c
   0.7 s: neurotess-render it: a
";
        assert_eq!(counts.slowest(), text);
    }

    #[test]
    fn skipped_tests_stand_under_their_reason() {
        let counts = heard(&[
            "     Running tests/cracks.rs (target/debug/deps/cracks-32e2f1a3a44b3a8f)",
            "test an_edge   ... ignored (no graphics adapter (none at all))",
            "test a_surface ... ignored (no graphics adapter (none at all))",
            "test result: ok. 0 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out",
            "     Running unittests src/lib.rs (target/debug/deps/neurotess_mesh-0a)",
            "test tests::slow ... ignored, takes an hour",
            "test tests::other ... ignored",
            "test result: ok. 0 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out",
        ]);
        let text = "\
1 skipped: for no reason that is given
   neurotess_mesh src/lib.rs: tests::other
2 skipped: no graphics adapter (none at all)
   cracks tests/cracks.rs: an_edge
   cracks tests/cracks.rs: a_surface
1 skipped: takes an hour
   neurotess_mesh src/lib.rs: tests::slow
";
        assert_eq!(counts.skipped_tests(), text);
        assert_eq!(counts.skipped, 4);
    }

    #[test]
    fn failures_are_named_with_their_program() {
        let counts = heard(&[
            "   Doc-tests neurotess",
            "test crates/neurotess/src/lib.rs - (line 9) ... FAILED",
        ]);
        assert_eq!(
            counts.failures(),
            ["neurotess doc: crates/neurotess/src/lib.rs - (line 9)"]
        );
    }
}
