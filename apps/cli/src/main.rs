//! The `neurotess` command.
#![forbid(unsafe_code)]

mod args;
mod bench;
mod check;
mod circuit;
mod convert;
mod info;
mod inputs;
mod interrupt;
mod mesh;
mod output;
mod progress;
mod render;
mod report;
mod rings;
mod synth;
mod targets;
mod version;
mod view;
mod workers;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use args::{Cli, Command};
use report::{Reporter, Usage};

fn main() -> ExitCode {
    let cli = Cli::parse();
    let reporter = Reporter::new(cli.common);
    match run(&cli, &reporter) {
        Ok(()) if reporter.failures() == 0 => ExitCode::SUCCESS,
        Ok(()) => ExitCode::from(1),
        Err(e) => {
            reporter.error(&format!("{e:#}"));
            ExitCode::from(if e.is::<Usage>() { 2 } else { 1 })
        }
    }
}

fn run(cli: &Cli, reporter: &Reporter) -> anyhow::Result<()> {
    interrupt::watch()?;
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
            reporter.result(String::from_utf8_lossy(&text).trim_end());
            Ok(())
        }
        None => report::usage("no command: neurotess --help lists them"),
    }
}
