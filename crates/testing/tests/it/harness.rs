//! The harness, seen from outside: what it prints and how it ends.

use std::process::Command;

/// What the sample program prints, and whether it ends well.
fn sample(arguments: &[&str], variables: &[(&str, &str)]) -> (String, bool) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sample-tests"));
    command
        .env_remove("NEUROTESS_REQUIRE_MOON")
        .env_remove("NEUROTESS_REQUIRE_SHARED")
        .env("NEUROTESS_SHARED", "/nowhere")
        .env_remove("RUST_BACKTRACE")
        .args(arguments)
        .envs(variables.iter().copied());
    let output = command.output().expect("the sample runs");
    let printed = String::from_utf8(output.stdout).expect("text");
    (printed, output.status.success())
}

/// The outcome of a test, as its line says it.
fn outcome<'t>(printed: &'t str, name: &str) -> &'t str {
    let outcome = |line: &'t str| {
        let (test, outcome) = line.strip_prefix("test ")?.split_once(" ... ")?;
        (test.trim_end() == name).then_some(outcome)
    };
    let found = printed.lines().find_map(outcome);
    found.unwrap_or_else(|| panic!("no test {name}:\n{printed}"))
}

#[neurotess_testing::test]
fn what_is_missing_is_skipped_with_its_reason() {
    let (printed, ended_well) = sample(&[], &[]);
    assert!(ended_well, "{printed}");
    assert_eq!(outcome(&printed, "what_needs_nothing_runs"), "ok");
    assert_eq!(outcome(&printed, "what_is_there_is_used"), "ok");
    assert_eq!(outcome(&printed, "inner::has_its_modules_name"), "ok");
    assert_eq!(
        outcome(&printed, "what_is_missing_is_skipped"),
        "ignored (no moon tonight)"
    );
    assert_eq!(
        outcome(&printed, "reference_data_are_there"),
        "ignored (no reference data in /nowhere)"
    );
    assert!(
        printed.contains("ok. 4 passed; 0 failed; 2 ignored"),
        "{printed}"
    );
    assert!(!printed.contains("a note"), "{printed}");
}

#[neurotess_testing::test]
fn what_is_required_and_missing_fails() {
    let (printed, ended_well) = sample(&[], &[("NEUROTESS_REQUIRE_MOON", "1")]);
    assert!(!ended_well, "{printed}");
    assert_eq!(outcome(&printed, "what_is_missing_is_skipped"), "FAILED");
    assert!(
        printed.contains("no moon tonight, and NEUROTESS_REQUIRE_MOON=1"),
        "{printed}"
    );
    let (printed, ended_well) = sample(&[], &[("NEUROTESS_REQUIRE_MOON", "0")]);
    assert!(ended_well, "{printed}");
    let (_, ended_well) = sample(&[], &[("NEUROTESS_REQUIRE_SHARED", "1")]);
    assert!(!ended_well);
}

#[neurotess_testing::test]
fn a_failure_shows_its_place_and_its_notes() {
    let (printed, ended_well) = sample(&[], &[("SAMPLE_FAILS", "1")]);
    assert!(!ended_well);
    assert_eq!(outcome(&printed, "fails_if_asked_to"), "FAILED");
    assert!(printed.contains("a note with 7\npanicked at "), "{printed}");
    assert!(printed.contains("main.rs:"), "{printed}");
    assert!(printed.contains("as asked"), "{printed}");
}

#[neurotess_testing::test]
fn arguments_select_as_those_of_libtest() {
    let (printed, _) = sample(&["what_is"], &[]);
    assert!(
        printed.contains("1 passed; 0 failed; 1 ignored"),
        "{printed}"
    );
    let (printed, _) = sample(&["inner::has_its_modules_name", "--exact"], &[]);
    assert!(
        printed.contains("1 passed; 0 failed; 0 ignored"),
        "{printed}"
    );
    let (printed, _) = sample(&["--skip", "what", "--test-threads", "1"], &[]);
    assert!(
        printed.contains("2 passed; 0 failed; 1 ignored"),
        "{printed}"
    );
    let (printed, _) = sample(&["--list"], &[]);
    assert_eq!(printed.lines().count(), 6, "{printed}");
    assert!(
        printed.contains("inner::has_its_modules_name: test\n"),
        "{printed}"
    );
    let (printed, _) = sample(&["--nocapture", "fails"], &[]);
    assert!(printed.contains("a note with 7"), "{printed}");
}
