//! How files of sessions are named.

use std::path::Path;

/// Extension of sessions.
pub const EXTENSION: &str = "neurotess";

/// Whether a file has the extension of sessions.
pub fn is_session(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(EXTENSION))
}
