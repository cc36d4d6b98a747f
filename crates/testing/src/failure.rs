//! What a failed test says: its panic, with file and line, and the notes that it kept.

use std::backtrace::{Backtrace, BacktraceStatus};
use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    /// What the test of this thread said so far; nothing on threads that run no test.
    static SAID: RefCell<Option<String>> = const { RefCell::new(None) };
}

static AT_ONCE: AtomicBool = AtomicBool::new(false);

/// Keeps a line for the test's failure, or prints it; see [`note!`](crate::note).
#[expect(clippy::print_stdout, reason = "it was asked for by --nocapture")]
pub fn keep_note(line: &str) {
    if AT_ONCE.load(Ordering::Relaxed) {
        println!("{line}");
    }
    say(line);
}

/// From now on panics of tests are kept with their tests.
pub(crate) fn listen(notes_at_once: bool) {
    AT_ONCE.store(notes_at_once, Ordering::Relaxed);
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        // A thread that a test began has no test of its own: its panic goes to standard error.
        if !say(&described(info)) {
            usual(info);
        }
    }));
}

/// Runs a test. The error is all that it said.
pub(crate) fn catch(test: fn()) -> Result<(), String> {
    SAID.set(Some(String::new()));
    let ended = panic::catch_unwind(AssertUnwindSafe(test));
    let said = SAID.take().unwrap_or_default();
    ended.map_err(|_| said)
}

/// Whether this thread runs a test.
fn say(line: &str) -> bool {
    SAID.with_borrow_mut(|said| {
        let Some(said) = said else { return false };
        *said += line;
        said.push('\n');
        true
    })
}

fn described(info: &PanicHookInfo<'_>) -> String {
    let text = info.payload_as_str().unwrap_or("a panic without text");
    let place = info.location().map(ToString::to_string).unwrap_or_default();
    let trace = Backtrace::capture();
    match trace.status() {
        BacktraceStatus::Captured => format!("panicked at {place}:\n{text}\n{trace}"),
        _ => format!("panicked at {place}:\n{text}"),
    }
}
