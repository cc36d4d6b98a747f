//! A progress bar on a terminal, for work that takes longer than a second.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::reporter::Reporter;

/// Time before the bar is shown.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between updates of the bar.
const TICK: Duration = Duration::from_millis(200);

/// Counts what is done, whether the bar is visible or not.
pub(crate) struct Progress<'r> {
    reporter: &'r Reporter,
    bar: ProgressBar,
}

impl<'r> Progress<'r> {
    /// Counts `total` things named `unit`.
    pub(crate) fn new(reporter: &'r Reporter, total: usize, unit: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::hidden());
        let template =
            format!("{{bar:30}} {{human_pos}}/{{human_len}} {unit} · {{per_sec}} · {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        if reporter.wants_progress() {
            reporter.set_bar(Some(bar.clone()));
            appear_later(bar.clone());
        }
        Self { reporter, bar }
    }

    /// Says how many of how many things are done.
    pub(crate) fn at(&self, done: usize, all: usize) {
        self.bar.set_length(all as u64);
        self.bar.set_position(done as u64);
    }

    /// Counts one thing as done.
    pub(crate) fn done(&self) {
        self.bar.inc(1);
    }
}

impl Drop for Progress<'_> {
    fn drop(&mut self) {
        self.reporter.set_bar(None);
        self.bar.finish_and_clear();
    }
}

fn appear_later(bar: ProgressBar) {
    std::thread::spawn(move || {
        std::thread::sleep(PATIENCE);
        if !bar.is_finished() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(TICK);
        }
    });
}
