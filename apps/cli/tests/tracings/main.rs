//! Tracings mended, compared and measured on the command line: `convert` with edits, `diff`, packed files,
//! tables of `info`.
//! Nothing here needs the features of pictures and windows.

mod compare;
mod mend;
mod neurom;
mod packed;
mod page;
mod spines;
mod table;

#[path = "../common/work.rs"]
#[allow(
    dead_code,
    reason = "the program of the whole command line uses the rest"
)]
mod work;

use std::path::Path;

/// The path of a sample of the repository.
fn sample(name: &str) -> String {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    samples.join(name).display().to_string()
}

neurotess_testing::main!();
