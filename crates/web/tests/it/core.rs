//! The core for browsers, run here: what it answers is what the library makes, in the command's words.

use neurotess_formats::{ReadOptions, read_bytes};
use neurotess_mesh::{Format, write};
use neurotess_morphology::Measures;
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_wasm::Calls;
use neurotess_web::MAX_KEYS;
use serde_json::Value;

use crate::written::Meshed;

/// The text of a sample.
pub(crate) fn sample(name: &str) -> Vec<u8> {
    let samples = neurotess_testing::workspace().join("samples");
    std::fs::read(samples.join(format!("{name}.swc"))).expect("a sample")
}

/// Files that cannot be shown, and what is told of them.
pub(crate) fn bad_files() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("empty.swc", Vec::new()),
        ("comments.swc", b"# a cell without points\n".to_vec()),
        (
            "row.swc",
            b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 x 0 1 2\n".to_vec(),
        ),
        ("parent.swc", b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 7\n".to_vec()),
        ("page.swc", b"<!doctype html><html></html>".to_vec()),
        ("text.asc", b"((Dendrite) (0 0 0 1".to_vec()),
        ("broken.h5", b"\x89HDF\r\n\x1a\nnothing more".to_vec()),
        ("other.nml", b"<svg></svg>".to_vec()),
        ("cut.swc.gz", b"\x1f\x8b\x08\x00\x00".to_vec()),
        ("picture.png", b"\x89PNG\r\n\x1a\n\0\0".to_vec()),
    ]
}

#[neurotess_testing::test]
fn a_cell_is_told_of_as_the_command_tells() {
    let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 0 1\n3 3 0 30 0 1 2\n".to_vec();
    let mut calls = Calls::default();
    let answer = calls.open("a b.swc", text.clone()).expect("a cell");
    let told: Value = serde_json::from_slice(&answer.told).expect("JSON");
    assert_eq!(told["name"], "a b");
    let read = read_bytes(text, "a b.swc", None, &ReadOptions::default()).expect("a cell");
    assert!(!read.warnings.is_empty());
    for (warning, told) in read
        .warnings
        .iter()
        .zip(told["warnings"].as_array().expect("a list"))
    {
        let place = warning
            .line
            .map_or(String::new(), |line| format!("{line}:"));
        let ours = format!("a b.swc:{place} {} ({})", warning.message, warning.code);
        assert_eq!(*told, ours);
    }
    let rows = serde_json::to_value(Measures::of(&read.morphology).rows()).expect("JSON");
    assert_eq!(told["measures"], rows);
    assert!(
        told["sholl"]
            .as_str()
            .is_some_and(|svg| svg.starts_with("<svg"))
    );
}

#[neurotess_testing::test]
fn what_cannot_be_read_is_told_in_the_words_of_the_readers_and_the_cell_before_stays() {
    let mut calls = Calls::default();
    assert!(calls.tracing().is_err(), "there is no cell yet");
    calls
        .open("granule.swc", sample("granule"))
        .expect("a cell");
    for (name, bytes) in bad_files() {
        let extension = name.trim_end_matches(".gz").rsplit('.').next();
        let format = extension.and_then(neurotess_formats::Format::of_extension);
        let ours = read_bytes(bytes.clone(), name, format, &ReadOptions::default());
        let ours = ours.expect_err(name).to_string();
        assert_eq!(calls.open(name, bytes).expect_err(name), ours);
        assert!(calls.tracing().is_ok(), "{name}");
    }
}

/// A straight axon of more points than a page can have.
pub(crate) fn too_many_points() -> Vec<u8> {
    let mut text = String::new();
    for k in 1..=MAX_KEYS as i64 + 10 {
        let parent = if k == 1 { -1 } else { k - 1 };
        text += &format!("{k} 2 0 {k} 0 1 {parent}\n");
    }
    text.into_bytes()
}

#[neurotess_testing::test(needs(neurotess_testing::full))]
fn too_many_points_are_told_before_they_are_meshed() {
    let told = Calls::default().open("long.swc", too_many_points());
    let told = told.expect_err("too many");
    assert!(
        told.ends_with(
            "tracing points are too many for a page, which may have 1048576: leave out cells"
        ),
        "{told}"
    );
}

#[neurotess_testing::test]
fn saved_meshes_are_those_of_the_library() {
    let cell = Meshed::sample("granule");
    let mut calls = Calls::default();
    calls
        .open("granule.swc", sample("granule"))
        .expect("a cell");
    let options = RefineOptions::default();
    let surface = Refinement::new(&cell.mesh, LodCriterion::Homogeneous(3), &options);
    for (extension, format) in [
        ("ply", Format::Ply),
        ("glb", Format::Glb),
        ("stl", Format::Stl),
    ] {
        let mut ours = std::io::Cursor::new(Vec::new());
        write(&surface, format, &mut ours).expect("written");
        let answer = calls.mesh(extension, 3).expect("a file");
        assert!(answer.bytes == ours.into_inner(), "{extension}");
    }
    assert!(calls.mesh("xyz", 3).is_err());
    let told = calls.mesh("ply", 64).map(|answer| answer.bytes.len());
    assert!(told.is_ok() || told.is_err_and(|told| told.contains("choose a lower one")));
}
