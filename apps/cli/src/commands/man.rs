//! `neurotess man`: manual pages, made of what --help says.

use clap::CommandFactory;

use crate::cli::Cli;
use crate::report::usage;

/// The page of a command, or of the program, as roff.
///
/// # Errors
/// Wrong usage: there is no such command.
pub(crate) fn page(command: Option<&str>) -> anyhow::Result<String> {
    let mut program = Cli::command();
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
