//! What work costs, in instructions: the same on a busy machine as on a quiet one, unlike any time.

use std::process::Command;

/// The variable in which a program that is run again finds its case.
const CASE: &str = "NEUROTESS_COUNTED_CASE";

/// The need of tests that count instructions.
///
/// # Errors
/// Where Valgrind is not installed.
pub fn valgrind() -> Result<(), String> {
    let there = Command::new("valgrind").arg("--version").output();
    let there = there.is_ok_and(|output| output.status.success());
    there
        .then_some(())
        .ok_or_else(|| "no Valgrind: cargo xtask setup --full installs it".into())
}

/// The case that this process is to run, and nothing else: it was started by [`instructions`].
pub fn counted_case() -> Option<String> {
    std::env::var(CASE).ok()
}

/// Runs a test of this program again, in a process whose instructions Valgrind counts. There
/// [`counted_case`] returns `case`, and the test does what it stands for. What is counted is the whole process, on
/// one thread.
///
/// # Panics
/// Where Valgrind cannot be started, or the test fails.
pub fn instructions(test: &str, case: &str) -> u64 {
    let this = std::env::current_exe().expect("a test program");
    let mut command = Command::new("valgrind");
    command
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(this)
        .args(["--exact", test])
        .env(CASE, case)
        // Threads that look for work take instructions, too, and never the same number.
        .env("RAYON_NUM_THREADS", "1");
    let output = command.output().expect("the test has needs(valgrind)");
    let said = String::from_utf8_lossy(&output.stderr);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(
        printed.contains("1 passed"),
        "{test}, {case}: {printed}{said}"
    );
    let counted = said.lines().find_map(|line| line.split_once("Collected :"));
    let counted = counted.and_then(|(_, number)| number.trim().parse().ok());
    counted.unwrap_or_else(|| panic!("Valgrind counted nothing: {said}"))
}
