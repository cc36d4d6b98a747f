//! Output of the program: results on standard output, everything else on standard error.

mod common;
mod failure;
mod log;
mod parser;
mod progress;
mod reporter;
mod text;

pub(crate) use common::{Common, at_least_one};
pub(crate) use failure::{Entry, Failed, Failure, Usage, bug, told, usage};
pub(crate) use log::Log;
pub(crate) use parser::report_parser_error;
pub(crate) use progress::Progress;
pub(crate) use reporter::Reporter;
pub(crate) use text::{count, place};
