//! The `neurotess` command.
#![forbid(unsafe_code)]

mod cli;
mod commands;
mod headless;
mod interrupt;
mod io;
mod options;
mod report;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use cli::{Cli, Command};
use commands::{bench, check, convert, info, man, mesh, render, synth, version, view};
use report::{Reporter, Usage};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(e) => return ExitCode::from(report::told_by_parser(&e)),
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
    let draws = matches!(cli.command, Some(Command::Render(_) | Command::Bench(_)));
    if draws || cli.version {
        headless::stay_away_from_windows();
    }
    interrupt::watch(reporter.last_words())?;
    if cli.version {
        return version::run(reporter);
    }
    match &cli.command {
        Some(Command::Info(args)) => info::run(args, reporter),
        Some(Command::Mesh(args)) => mesh::run(args, reporter),
        Some(Command::Check(args)) => check::run(args, reporter),
        Some(Command::Convert(args)) => convert::run(args, reporter),
        Some(Command::Render(args)) => render::run(args, reporter),
        Some(Command::View(args)) => view::run(args, reporter),
        Some(Command::Bench(args)) => bench::run(args, reporter),
        Some(Command::Synth(args)) => synth::run(args, reporter),
        Some(Command::Completions { shell }) => {
            let mut text = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "neurotess", &mut text);
            let text = String::from_utf8_lossy(&text);
            reporter.answer(text.trim_end());
            reporter.document(&serde_json::json!({ "completions": text }))
        }
        Some(Command::Man { command }) => {
            let text = man::page(command.as_deref())?;
            reporter.answer(text.trim_end());
            reporter.document(&serde_json::json!({ "man": text }))
        }
        None => report::usage("no command: neurotess --help lists them"),
    }
}
