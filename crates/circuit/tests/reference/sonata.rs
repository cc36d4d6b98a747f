//! The data sets that lie beside the repository, where there are any.

use std::path::{Path, PathBuf};

/// `../shared/data/sonata` from the workspace's root; says so if it is absent.
pub(crate) fn sonata() -> Option<PathBuf> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if data.join("sonata_reference.json").is_file() {
        return Some(data.join("sonata"));
    }
    #[expect(clippy::print_stderr, reason = "nothing is skipped in silence")]
    {
        eprintln!("skipped: no shared data beside the workspace");
    }
    None
}
