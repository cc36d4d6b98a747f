//! The `neurotess` command.
#![forbid(unsafe_code)]

mod cli;
mod commands;
#[cfg(feature = "render")]
mod headless;
mod interrupt;
mod io;
mod options;
mod report;

use std::process::ExitCode;

use clap::Parser;

use cli::Cli;
use report::{Reporter, Usage};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(e) => return ExitCode::from(report::report_parser_error(&e)),
    };
    let reporter = Reporter::new(cli.common);
    let mut code = 1;
    if let Err(e) = run(&cli, &reporter) {
        if e.is::<Usage>() {
            code = 2;
        }
        reporter.error(&format!("{e:#}"));
    }
    if let Err(e) = reporter.close() {
        reporter.error(&format!("{e:#}"));
    }
    match reporter.failures() {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::from(code),
    }
}

fn run(cli: &Cli, reporter: &Reporter) -> anyhow::Result<()> {
    #[cfg(feature = "render")]
    if cli.draws() {
        headless::stay_away_from_windows();
    }
    interrupt::watch(reporter.on_interrupt())?;
    cli.run(reporter)
}
