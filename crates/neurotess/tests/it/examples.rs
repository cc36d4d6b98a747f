//! The examples run, and write what they say.

use std::path::{Path, PathBuf};
use std::process::Command;

use neurotess::render::Gpu;

/// The need of examples that draw.
fn gpu() -> Result<(), String> {
    Gpu::open(None).map(drop).map_err(|error| error.to_string())
}

/// Runs an example, which the full lane builds beside the tests, on a sample. `flag`: what stands before the output.
fn run(example: &str, flag: Option<&str>, out: &str) -> PathBuf {
    let this = std::env::current_exe().expect("a test program");
    let folder = this
        .parent()
        .and_then(Path::parent)
        .expect("the target folder");
    let program = folder.join("examples").join(example);
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(out);
    let _ = std::fs::remove_file(&out);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let done = Command::new(program)
        .current_dir(root)
        .arg("samples/granule.swc")
        .args(flag)
        .arg(&out)
        .output()
        .expect("the example was built");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{example}: {said}");
    out
}

fn begins_with(file: &Path, magic: &[u8]) -> bool {
    let bytes = std::fs::read(file).expect("it was written");
    bytes.len() > 1000 && bytes.starts_with(magic)
}

#[neurotess_testing::test(needs(neurotess_testing::full))]
fn one_cell_is_meshed() {
    assert!(begins_with(&run("mesh_one_cell", None, "cell.ply"), b"ply"));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn one_cell_is_drawn_in_its_own_and_in_other_colors() {
    for example in ["draw_one_cell", "own_colors"] {
        let picture = run(example, None, &format!("{example}.png"));
        assert!(begins_with(&picture, b"\x89PNG"), "{example}");
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn cells_are_drawn_in_the_pass_of_another_program() {
    let picture = run("in_another_window", Some("--out"), "in_another_window.png");
    assert!(begins_with(&picture, b"\x89PNG"));
}
