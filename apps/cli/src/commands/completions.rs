//! `neurotess completions`: completion scripts for shells.

use clap_complete::Shell;

use crate::report::Reporter;

/// Runs the command. `program`: the whole command line.
pub(crate) fn run(
    shell: Shell,
    program: &mut clap::Command,
    reporter: &Reporter,
) -> anyhow::Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(shell, program, "neurotess", &mut text);
    let text = String::from_utf8_lossy(&text);
    reporter.answer(text.trim_end());
    reporter.document(&serde_json::json!({ "completions": text }))
}
