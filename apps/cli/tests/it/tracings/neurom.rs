//! `info` beside NeuroM, on our samples

use std::path::{Path, PathBuf};
use std::process::Command;

use neurotess_testing::python_with;
use serde_json::Value;

use crate::work::{Work, sample};

/// Distance of spheres (µm).
const STEP: f64 = 25.0;

/// The need of tests that ask NeuroM.
fn neurom() -> Result<(), String> {
    python_with("neurom").map(drop)
}

/// What NeuroM measures of a file.
fn asked(file: &str, spheres: usize) -> Value {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/neurom_features.py");
    let python: PathBuf = python_with("neurom").expect("the need");
    let output = Command::new(python)
        .arg(script)
        .args([file, &STEP.to_string(), &spheres.to_string()])
        .output()
        .expect("Python starts");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Asserts that NeuroM's numbers are ours, each by its name, to 10⁻⁵.
fn assert_same(theirs: &Value, ours: &Value, place: &str) {
    for (name, theirs) in theirs.as_object().expect("an object") {
        let ours = &ours[name];
        match (theirs.as_f64(), ours.as_f64()) {
            (Some(a), Some(b)) => {
                let tolerance = 1e-5 * a.abs().max(1.0);
                assert!(
                    (a - b).abs() <= tolerance,
                    "{place} {name}: {a} there, {b} here"
                );
            }
            (None, None) if theirs.is_array() => {
                let whole = |list: &Value| -> Vec<u64> {
                    let list = list.as_array().expect("a list").iter();
                    list.map(|n| n.as_f64().expect("a number") as u64).collect()
                };
                assert_eq!(whole(theirs), whole(ours), "{place} {name}");
            }
            _ => assert!(
                theirs.is_null() && ours.is_null(),
                "{place} {name}: {theirs}, {ours}"
            ),
        }
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, neurom))]
fn numbers_are_those_of_neurom() {
    let work = Work::new();
    for name in [
        "basket",
        "granule",
        "motor",
        "purkinje",
        "pyramidal",
        "star",
    ] {
        let file = sample(&format!("{name}.swc"));
        let rows = |per: &str| {
            let json = work
                .run(&format!("info {file} --json --sholl {STEP} --per {per}"))
                .exits(0)
                .json();
            json[0]["rows"].clone()
        };
        let cell = &rows("cell")[0];
        let spheres = cell["sholl_crossings"].as_array().map_or(0, Vec::len);
        let mut theirs = asked(&file, spheres);
        if cell["soma_kind"] == "three_point" {
            // A cylinder there, a sphere here.
            let volume = theirs["cell"]["soma_volume"].as_f64().expect("a volume");
            theirs["cell"]["soma_volume"] = (volume * 2.0 / 3.0).into();
        }
        assert_same(&theirs["cell"], cell, name);
        for (per, key) in [("neurite", "neurites"), ("section", "sections")] {
            let ours = rows(per);
            let (ours, theirs) = (ours.as_array(), theirs[key].as_array());
            let (ours, theirs) = (ours.expect("rows"), theirs.expect("rows"));
            assert_eq!(ours.len(), theirs.len(), "{name} {per}");
            for (i, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
                assert_same(theirs, ours, &format!("{name} {per} {i}"));
            }
        }
    }
}
