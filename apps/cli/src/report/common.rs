//! Options that every command has.

use clap::{Args, ValueEnum};

/// Options that every command has.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct Common {
    /// Print one JSON document on standard output, everything else on standard error
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    #[cfg_attr(
        feature = "view",
        doc = "Say more: every warning of every input; of `view`, every command that the window runs"
    )]
    #[cfg_attr(not(feature = "view"), doc = "Say more: every warning of every input")]
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// Threads to use [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = at_least_one,
          allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,
    /// Show no progress bar, not even on a terminal
    #[arg(long, global = true)]
    pub(crate) no_progress: bool,
    /// Read files that are packed so well that more than 20 times their size and 100 MB is made of them
    #[arg(long, global = true)]
    pub(crate) allow_large: bool,
    /// Color messages
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    pub(crate) color: Color,
}

/// When messages are colored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

pub(crate) fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if number >= 1 => Ok(number),
        _ => Err("a whole number from 1 on is needed".into()),
    }
}
