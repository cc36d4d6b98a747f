//! Interrupted: no half-written file, the window's settings kept, exit code 130, at once.

use neurotess::output;

/// Exit code of an interrupted run.
const INTERRUPTED: i32 = 130;

/// From now on, Ctrl-C and requests to end remove what is half written, say the last words and leave.
pub(crate) fn watch(on_interrupt: impl Fn() + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(move || {
        // First: afterwards nothing is written any more.
        #[cfg(feature = "view")]
        drop(neurotess_viewer::settings::write_noted());
        let _ended = output::remove_unfinished();
        on_interrupt();
        std::process::exit(INTERRUPTED);
    })
}
