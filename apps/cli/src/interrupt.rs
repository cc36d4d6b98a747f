//! Interrupts: leave no half-written file, keep the window's settings, and exit at once with code
//! 130.

use neurotess::output;

/// Exit code of an interrupted run.
const INTERRUPTED: i32 = 130;

/// From now on, Ctrl-C and termination requests remove half-written files, call `on_interrupt` and
/// exit.
pub(crate) fn watch(on_interrupt: impl Fn() + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(move || {
        // First, since afterwards no file is written any more.
        #[cfg(feature = "view")]
        drop(neurotess_viewer::settings::write_noted());
        let _ended = output::remove_unfinished();
        on_interrupt();
        std::process::exit(INTERRUPTED);
    })
}
