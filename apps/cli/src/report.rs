//! Who hears what: results on standard output, everything else on standard error.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use indicatif::ProgressBar;
use serde::Serialize;

use crate::args::{Color, Common};

/// Wrong usage: exit code 2.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// Stops a function with a [`Usage`] error.
pub(crate) fn usage<T>(message: impl Into<String>) -> anyhow::Result<T> {
    Err(Usage(message.into()).into())
}

/// An input that failed: `FILE:LINE: what: what to do`.
#[derive(Clone, Debug)]
pub(crate) struct Failure(pub(crate) String);

/// What is told to people and machines. Messages never tear: one at a time, around the bar.
pub(crate) struct Reporter {
    common: Common,
    color: bool,
    bar: Mutex<Option<ProgressBar>>,
    failures: AtomicUsize,
}

impl Reporter {
    /// Obeys the common options.
    pub(crate) fn new(common: Common) -> Self {
        let color = match common.color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
        };
        Self {
            common,
            color,
            bar: Mutex::new(None),
            failures: AtomicUsize::new(0),
        }
    }

    /// Whether results are wanted as JSON.
    pub(crate) fn json(&self) -> bool {
        self.common.json
    }

    /// Whether everything shall be told.
    pub(crate) fn verbose(&self) -> bool {
        self.common.verbose
    }

    /// Whether a progress bar may appear.
    pub(crate) fn wants_progress(&self) -> bool {
        !self.common.no_progress && !self.common.quiet && io::stderr().is_terminal()
    }

    /// Number of threads to use.
    pub(crate) fn threads(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        self.common.threads.unwrap_or_else(cores)
    }

    /// Puts messages above this bar from now on, or under none.
    pub(crate) fn set_bar(&self, bar: Option<ProgressBar>) {
        *self.bar.lock().unwrap_or_else(PoisonError::into_inner) = bar;
    }

    /// Tells of an input that failed, and counts it.
    pub(crate) fn failure(&self, failure: &Failure) {
        self.failures.fetch_add(1, Ordering::Relaxed);
        self.say("error", "31", &failure.0);
    }

    /// How many failed.
    pub(crate) fn failures(&self) -> usize {
        self.failures.load(Ordering::Relaxed)
    }

    /// Tells of an error that is no input's.
    pub(crate) fn error(&self, message: &str) {
        self.say("error", "31", message);
    }

    /// Tells of something odd.
    pub(crate) fn warning(&self, message: &str) {
        if !self.common.quiet {
            self.say("warning", "33", message);
        }
    }

    /// Tells how it went, on standard error.
    pub(crate) fn note(&self, message: &str) {
        if !self.common.quiet {
            self.print(|| drop(writeln!(io::stderr(), "{message}")));
        }
    }

    /// A result for people; silent where JSON is wanted.
    pub(crate) fn result(&self, text: &str) {
        if !self.common.json && !self.common.quiet {
            self.print(|| to_stdout(text));
        }
    }

    /// The one JSON document.
    pub(crate) fn document(&self, value: &impl Serialize) -> anyhow::Result<()> {
        if self.common.json {
            let text = serde_json::to_string_pretty(value)?;
            self.print(|| to_stdout(&text));
        }
        Ok(())
    }

    fn say(&self, word: &str, color: &str, message: &str) {
        // One failure is one line, whatever a file's name or content holds.
        let line: String = message
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let word = if self.color {
            format!("\x1b[1;{color}m{word}:\x1b[0m")
        } else {
            format!("{word}:")
        };
        self.print(|| drop(writeln!(io::stderr(), "{word} {line}")));
    }

    fn print(&self, write: impl FnOnce()) {
        let bar = self.bar.lock().unwrap_or_else(PoisonError::into_inner);
        match &*bar {
            Some(bar) => bar.suspend(write),
            None => write(),
        }
    }
}

/// A reader that has gone away, as in `neurotess info … | head`, is no error.
fn to_stdout(text: &str) {
    drop(writeln!(io::stdout(), "{text}"));
}

/// A number of things, for people: `1 cell`, `3 cells`.
pub(crate) fn count(number: usize, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}
