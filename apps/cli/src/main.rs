//! The `neurotess` command.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(neurotess_cli::main(std::env::args_os()))
}
