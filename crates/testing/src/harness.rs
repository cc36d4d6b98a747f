//! Runs the tests of a program: filters, threads and lines are those of libtest.

use std::panic::resume_unwind;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use libtest_mimic::{Arguments, Completion, Failed, Trial};

use crate::{Need, failure};

/// A test that the attribute registered.
#[derive(Clone, Copy, Debug)]
pub struct Test {
    path: &'static str,
    run: fn(),
    needs: &'static [Need],
}

inventory::collect!(Test);

impl Test {
    /// `path`: crate, modules and function.
    pub const fn new(path: &'static str, run: fn(), needs: &'static [Need]) -> Self {
        Self { path, run, needs }
    }

    /// As libtest names it: without the crate.
    fn name(&self) -> &'static str {
        self.path
            .split_once("::")
            .map_or(self.path, |(_, name)| name)
    }

    fn attempt(&self) -> Result<Completion, Failed> {
        let clock = Instant::now();
        let ended = self.attempt_untimed();
        let took = (clock.elapsed(), self.name());
        TOOK.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(took);
        ended
    }

    fn attempt_untimed(&self) -> Result<Completion, Failed> {
        for need in self.needs {
            let Some(reason) = need.missing() else {
                continue;
            };
            return match need.requirement() {
                Some(requirement) => Err(format!("{reason}, and {requirement}").into()),
                None => Ok(Completion::ignored_with(reason)),
            };
        }
        failure::catch(self.run)?;
        Ok(Completion::Completed)
    }
}

/// What the tests that ended took.
static TOOK: Mutex<Vec<(Duration, &str)>> = Mutex::new(Vec::new());

/// Tests that take less are not listed: most do, and what they take says little.
const LISTED: Duration = Duration::from_millis(500);

/// Prints what took longest, for `cargo xtask test`, which compares programs.
#[expect(
    clippy::print_stdout,
    reason = "a test program reports on standard output"
)]
fn list_slow_tests() {
    let mut took = std::mem::take(&mut *TOOK.lock().unwrap_or_else(PoisonError::into_inner));
    took.retain(|(time, _)| *time >= LISTED);
    took.sort_by(|a, b| b.cmp(a));
    for (time, name) in took {
        println!("took {:.3} s {name}", time.as_secs_f64());
    }
}

/// Runs a test on a thread that is joined. libtest-mimic waits for the work of its own threads only; what a driver
/// keeps for one is freed after that, and where the program ends meanwhile it crashes.
fn joined<T: Send + 'static>(test: impl FnOnce() -> T + Send + 'static) -> T {
    let ended = std::thread::spawn(test).join();
    ended.unwrap_or_else(|panic| resume_unwind(panic))
}

/// Runs the tests of this program that its arguments select.
pub fn run() -> ExitCode {
    let mut arguments = Arguments::from_args();
    let threads = std::env::var("RUST_TEST_THREADS");
    let threads = threads.ok().and_then(|threads| threads.parse().ok());
    arguments.test_threads = arguments.test_threads.or(threads);
    failure::listen(arguments.nocapture);
    let mut tests: Vec<&Test> = inventory::iter::<Test>.into_iter().collect();
    // The linker's order is no order.
    tests.sort_by_key(|test| test.name());
    let trials = tests.into_iter().map(|test| {
        let test = *test;
        Trial::ignorable_test(test.name(), move || joined(move || test.attempt()))
    });
    let ended = libtest_mimic::run(&arguments, trials.collect());
    list_slow_tests();
    ended.exit_code()
}
