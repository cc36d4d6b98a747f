//! The `neurotess` command as a library, for programs that bring it along, like the Python package: the program is
//! [`main`]. What commands do is in the crate `neurotess`, with their options.
#![forbid(unsafe_code)]

mod cli;
mod commands;
#[cfg(feature = "gpu")]
mod headless;
mod interrupt;
mod io;
mod options;
mod report;

use std::ffi::OsString;

use clap::Parser;

use cli::Cli;
use report::{Reporter, Usage};

/// Runs the command with these arguments, of which the first is the program's name, and returns the exit
/// code. It may end the process when it is interrupted, and runs once in a process.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(e) => return report::report_parser_error(&e, &arguments),
    };
    if cli.common.allow_large {
        neurotess::formats::budget::allow_large();
    }
    let threads = cli.common.threads;
    let reporter = Reporter::new(cli.common);
    if threads.is_some() {
        // What is drawn or checked shares these threads. A program that has its own already keeps them.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(reporter.threads());
        let _ = pool.build_global();
    }
    let mut code = 1;
    if let Err(e) = run(&cli, &reporter) {
        if e.is::<Usage>() {
            code = 2;
        }
        reporter.error(&report::told(&e));
    }
    if let Err(e) = reporter.close() {
        reporter.error(&report::told(&e));
    }
    match reporter.failures() {
        0 => u8::from(reporter.found_differences()),
        _ => code,
    }
}

fn run(cli: &Cli, reporter: &Reporter) -> anyhow::Result<()> {
    #[cfg(feature = "gpu")]
    if cli.draws() {
        headless::stay_away_from_windows();
    }
    interrupt::watch(reporter.on_interrupt())?;
    cli.run(reporter)
}
