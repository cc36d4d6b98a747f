//! The reference data: files of others, with what other programs say of them.

use std::path::{Path, PathBuf};

/// The need of tests that use the reference data.
///
/// # Errors
/// Names the folder in which they are not.
pub fn shared() -> Result<(), String> {
    let folder = folder();
    if folder.join("reference.tsv").is_file() {
        return Ok(());
    }
    // Absolute, but for the dots that lead out of the workspace.
    Err(format!("no reference data in {}", folder.display()))
}

/// The folder of the reference data.
///
/// # Panics
/// Where it is not: a test that calls this has `needs(neurotess_testing::shared)`.
pub fn shared_data() -> PathBuf {
    if let Err(missing) = shared() {
        panic!("{missing}: the test lacks needs(neurotess_testing::shared)");
    }
    folder()
}

/// The workspace's folder: `NEUROTESS_WORKSPACE`, for programs that run on another machine than they were built on, or
/// where they were built.
pub fn workspace() -> PathBuf {
    let built = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    std::env::var_os("NEUROTESS_WORKSPACE").map_or_else(built, PathBuf::from)
}

/// `NEUROTESS_SHARED`, or `shared/data` beside the workspace.
fn folder() -> PathBuf {
    let workspace = workspace();
    let beside = || {
        let workspace = workspace.canonicalize().unwrap_or(workspace);
        workspace.with_file_name("shared").join("data")
    };
    std::env::var_os("NEUROTESS_SHARED").map_or_else(beside, PathBuf::from)
}
