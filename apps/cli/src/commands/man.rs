//! `neurotess man`: manual pages with the text of --help.

use crate::report::{Reporter, usage};

/// Runs the command. `program`: the whole command line.
pub(crate) fn run(
    command: Option<&str>,
    program: clap::Command,
    reporter: &Reporter,
) -> anyhow::Result<()> {
    let text = page(command, program)?;
    reporter.answer(text.trim_end());
    reporter.document(&serde_json::json!({ "man": text }))
}

/// The page of a command, or of the program, as roff.
///
/// # Errors
/// Wrong usage: there is no such command.
fn page(command: Option<&str>, mut program: clap::Command) -> anyhow::Result<String> {
    program.build();
    let shown = match command {
        None => Some(&program),
        Some(name) => program.find_subcommand(name),
    };
    let Some(shown) = shown else {
        return usage("no such command: neurotess --help lists them");
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(shown.clone()).render(&mut text)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
