//! The reporter: results on standard output, everything else on standard error.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use indicatif::ProgressBar;
use serde::Serialize;
use serde_json::json;

use super::common::{Color, Common};
use super::failure::{Failure, usage};
use super::text::plain;

/// This number of threads is always allowed.
const THREADS: usize = 16;
/// Most threads per core: more gain nothing, and each has a cell in memory.
const PER_CORE: usize = 4;

/// Prints all messages and results: one at a time, so that they are not mixed, and above the
/// progress bar.
pub(crate) struct Reporter {
    common: Common,
    color: bool,
    bar: Mutex<Option<ProgressBar>>,
    errors: Mutex<Vec<String>>,
    /// Whether the JSON document has been printed.
    documented: Arc<AtomicBool>,
    /// Whether a file goes to standard output, so that nothing else does.
    occupied: AtomicBool,
    /// Whether writing to standard output failed.
    broken: AtomicBool,
    /// Whether what was compared differs.
    different: AtomicBool,
    /// Set by another thread that asks to stop.
    stopped: AtomicBool,
}

impl Reporter {
    /// A reporter with these options.
    pub(crate) fn new(common: Common) -> Self {
        let color = match common.color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
        };
        let reporter = Self {
            common,
            color,
            bar: Mutex::new(None),
            errors: Mutex::default(),
            documented: Arc::default(),
            occupied: AtomicBool::new(false),
            broken: AtomicBool::new(false),
            different: AtomicBool::new(false),
            stopped: AtomicBool::new(false),
        };
        if let Some(threads) = common.threads.filter(|&n| n > most_threads()) {
            let most = most_threads();
            reporter.warning(&format!(
                "--threads {threads}: {most} are used, more gain nothing here"
            ));
        }
        reporter
    }

    /// Set by another thread that asks to stop.
    pub(crate) fn stopped(&self) -> &AtomicBool {
        &self.stopped
    }

    /// Reserves standard output for a file.
    ///
    /// # Errors
    /// Wrong usage: JSON is to be printed there too.
    pub(crate) fn leave_output(&self) -> anyhow::Result<()> {
        if self.common.json {
            return usage("--json and -o - both want standard output: leave one of them out");
        }
        self.occupied.store(true, Ordering::Relaxed);
        Ok(())
    }

    /// Warns if OUT's name is that of another format than the one that is written.
    pub(crate) fn warn_of_name(&self, out: &Path, written: &str, named: Option<&str>) {
        if let Some(named) = named.filter(|&named| named != written && !out.is_dir()) {
            let out = out.display();
            self.warning(&format!(
                "{out} will hold {written}, as --format says, not {named}"
            ));
        }
    }

    /// What to do if the program is interrupted: prints the JSON document, unless that is done.
    pub(crate) fn on_interrupt(&self) -> impl Fn() + Send + use<> {
        let (json, documented) = (self.common.json, Arc::clone(&self.documented));
        move || {
            if json && !documented.swap(true, Ordering::Relaxed) {
                let errors = json!({ "errors": ["interrupted: not all inputs are done"] });
                drop(write_line(&format!("{errors:#}")));
            }
        }
    }

    /// Whether results are printed as JSON.
    pub(crate) fn json(&self) -> bool {
        self.common.json
    }

    /// Whether every warning is printed.
    pub(crate) fn verbose(&self) -> bool {
        self.common.verbose
    }

    /// Whether a progress bar may appear.
    pub(crate) fn wants_progress(&self) -> bool {
        !self.common.no_progress && !self.common.quiet && io::stderr().is_terminal()
    }

    /// Number of threads to use.
    pub(crate) fn threads(&self) -> usize {
        self.common
            .threads
            .map_or_else(cores, |threads| threads.min(most_threads()))
    }

    /// Sets the bar that messages are printed above, or none.
    pub(crate) fn set_bar(&self, bar: Option<ProgressBar>) {
        *self.bar.lock().unwrap_or_else(PoisonError::into_inner) = bar;
    }

    /// Reports an input that failed, and counts it.
    pub(crate) fn failure(&self, failure: &Failure) {
        self.error(&failure.0);
    }

    /// Makes the exit code 1 without an error: what was compared differs.
    pub(crate) fn differs(&self) {
        self.different.store(true, Ordering::Relaxed);
    }

    /// Whether what was compared differs.
    pub(crate) fn found_differences(&self) -> bool {
        self.different.load(Ordering::Relaxed)
    }

    /// Number of errors that were printed.
    pub(crate) fn failures(&self) -> usize {
        self.errors().len()
    }

    /// Reports an error, and counts it.
    pub(crate) fn error(&self, message: &str) {
        self.errors().push(message.to_owned());
        self.say("error", "31", message);
    }

    fn errors(&self) -> MutexGuard<'_, Vec<String>> {
        self.errors.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Prints a warning.
    pub(crate) fn warning(&self, message: &str) {
        if !self.common.quiet {
            self.say("warning", "33", message);
        }
    }

    /// Prints a note on standard error.
    pub(crate) fn note(&self, message: &str) {
        if !self.common.quiet {
            self.print(|| drop(writeln!(io::stderr(), "{}", plain(message))));
        }
    }

    /// Prints what was done; nothing with --json and --quiet.
    pub(crate) fn result(&self, text: &str) {
        if self.common.quiet || self.common.json {
            return;
        }
        if self.occupied.load(Ordering::Relaxed) {
            return self.note(text);
        }
        self.to_stdout(&plain(text));
    }

    /// Prints the answer that the command is for, also with --quiet.
    pub(crate) fn answer(&self, text: &str) {
        if !self.common.json {
            self.to_stdout(&plain(text));
        }
    }

    /// Prints the JSON document, of which there is only one.
    pub(crate) fn document(&self, value: &impl Serialize) -> anyhow::Result<()> {
        if self.common.json && !self.documented.swap(true, Ordering::Relaxed) {
            self.to_stdout(&serde_json::to_string_pretty(value)?);
        }
        Ok(())
    }

    /// Ends the output. With --json, if there was no document, prints the errors as one.
    pub(crate) fn close(&self) -> anyhow::Result<()> {
        let errors = self.errors().clone();
        self.document(&json!({ "errors": errors }))
    }

    /// Prints to standard output. A closed pipe, as in `neurotess info … | head`, is no error;
    /// other errors are reported once.
    fn to_stdout(&self, text: &str) {
        let mut failed = None;
        self.print(|| failed = write_line(text).err());
        let Some(e) = failed.filter(|e| e.kind() != io::ErrorKind::BrokenPipe) else {
            return;
        };
        if !self.broken.swap(true, Ordering::Relaxed) {
            self.error(&unwritable(&e));
        }
    }

    fn say(&self, word: &str, color: &str, message: &str) {
        // One failure is one line, whatever characters a file's name or content has.
        let line = plain(message).replace(['\n', '\t'], " ");
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

pub(super) fn write_line(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "{text}")?;
    out.flush()
}

pub(super) fn unwritable(error: &io::Error) -> String {
    format!("standard output cannot be written ({error}): check where it goes")
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn most_threads() -> usize {
    THREADS.max(PER_CORE * cores())
}
