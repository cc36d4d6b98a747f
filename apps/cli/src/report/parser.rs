//! Help and errors of the command line's parser.

use std::ffi::OsString;
use std::io::{self, Write};

use serde_json::json;

use super::reporter::{unwritable, write_line};

/// Prints what the command line's parser returns instead of a command: help or an error. Returns
/// the exit code. With --json among the arguments, an error is also a document.
pub(crate) fn report_parser_error(error: &clap::Error, arguments: &[OsString]) -> u8 {
    let printed = error.print();
    let json = arguments
        .iter()
        .take_while(|argument| *argument != "--")
        .any(|argument| argument == "--json");
    let document = match error.use_stderr() && json {
        true => write_line(&format!("{:#}", json!({ "errors": [error.to_string()] }))),
        false => Ok(()),
    };
    match printed.and(document) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            drop(writeln!(io::stderr(), "error: {}", unwritable(&e)));
            1
        }
        _ => u8::try_from(error.exit_code()).unwrap_or(2),
    }
}
