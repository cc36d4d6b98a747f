//! Circuits: made, read by others, described.

use std::path::{Path, PathBuf};
use std::process::Command;

use glam::{DMat3, DVec3};
use neurotess::circuit::{Circuit, Report, Selection};
use serde_json::Value;

use crate::work::Work;

/// What another reader finds in a circuit; `None`, which is told, where it is not installed.
fn judge(folder: &Path, reader: &str) -> Option<Value> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.venv/bin/python");
    let named = std::env::var_os("NEUROTESS_PYTHON").map(PathBuf::from);
    let python = named.or_else(|| own.exists().then_some(own));
    let has = |python: &PathBuf| {
        let import = format!("import {reader}");
        let output = Command::new(python).args(["-c", &import]).output();
        output.is_ok_and(|output| output.status.success())
    };
    let Some(python) = python.filter(has) else {
        #[expect(clippy::print_stderr, reason = "nothing is skipped in silence")]
        {
            eprintln!("skipped: no Python environment with {reader}");
        }
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/read_circuit.py");
    let output = Command::new(python)
        .arg(script)
        .arg(folder)
        .arg(reader)
        .output();
    let output = output.expect("Python runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    Some(serde_json::from_slice(&output.stdout).expect("JSON"))
}

fn made() -> (Work, PathBuf) {
    let work = Work::new();
    work.run("synth circuit -o c --neurons 60 --morphologies 4 --points 100 --reported 5 --seed 9")
        .exits(0);
    let folder = work.path("c");
    (work, folder)
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|v| v.as_f64().expect("a number")).collect()
}

#[test]
fn libsonata_reads_the_same_circuit() {
    let (_work, folder) = made();
    let Some(theirs) = judge(&folder, "libsonata") else {
        return;
    };
    let circuit = Circuit::open(&folder).expect("a circuit");
    assert!(circuit.failures.is_empty() && circuit.warnings.is_empty());
    let nodes = &circuit.populations[0];
    assert_eq!(theirs["n"], nodes.len());
    let axes = ["x", "y", "z"].map(|axis| numbers(&theirs[axis]));
    for (row, place) in nodes.positions.iter().enumerate() {
        let theirs_place = DVec3::new(axes[0][row], axes[1][row], axes[2][row]);
        // Not equal: reading JSON rounds.
        assert!(place.distance(theirs_place) < 1e-9);
        let q = numbers(&theirs["quaternion"][row]);
        let own = nodes.rotations[row];
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(own.w, q[0]) && near(own.x, q[1]) && near(own.z, q[3]));
        let word = |name: &str| nodes.attributes[name].word(row);
        assert_eq!(theirs["layer"][row].as_str(), word("layer"));
        assert_eq!(theirs["morphology"][row].as_str(), word("morphology"));
    }
    assert_eq!(theirs["missing"], Value::Array(vec![]));
    let sets = theirs["sets"].as_object().expect("sets");
    assert_eq!(sets.len(), circuit.node_sets.names().count());
    for (name, ids) in sets {
        let selection = Selection {
            node_set: Some(name.clone()),
            ..Selection::default()
        };
        let chosen = circuit.select(&selection).expect("a set");
        let own: Vec<f64> = chosen.iter().map(|n| f64::from(n.row)).collect();
        assert_eq!(numbers(ids), own, "{name}");
    }

    let report = Report::open(&circuit.reports["voltage"]).expect("a report");
    let values = &report.populations[0];
    let time = values.time;
    assert_eq!(numbers(&theirs["times"]), [time.start, time.end, time.step]);
    assert_eq!(theirs["units"][0].as_str(), Some(values.units.as_str()));
    let frame = time.frame_at(10.0).expect("a frame");
    let all: Vec<u64> = (0..values.elements()).collect();
    let own = values.values(frame, &all).expect("values");
    let frame = numbers(&theirs["frame"]);
    assert_eq!(frame.len(), own.len());
    let near = |(a, b): (&f64, &f32)| (a - f64::from(*b)).abs() < 1e-6;
    assert!(frame.iter().zip(&own).all(near));
    let sections = (0..values.nodes.len()).flat_map(|n| values.compartments(n).expect("some"));
    let sections: Vec<f64> = sections.map(|c| c.section as f64).collect();
    assert_eq!(numbers(&theirs["sections"]), sections);
    assert!(!theirs["spikes"].as_array().expect("spikes").is_empty());
}

#[test]
fn bluepysnap_reads_the_same_circuit() {
    let (_work, folder) = made();
    let Some(theirs) = judge(&folder, "bluepysnap") else {
        return;
    };
    let circuit = Circuit::open(&folder).expect("a circuit");
    let nodes = &circuit.populations[0];
    assert_eq!(theirs["n"], nodes.len());
    for (row, rotation) in nodes.rotations.iter().enumerate() {
        let rows = [0, 1, 2].map(|r: usize| numbers(&theirs["rotation"][row][r]));
        let [x, y, z] = rows.map(|r| DVec3::new(r[0], r[1], r[2]));
        let expected = DMat3::from_cols(x, y, z).transpose();
        assert!(DMat3::from_quat(*rotation).abs_diff_eq(expected, 1e-6));
    }
    let selection = Selection {
        node_set: Some("Upper pyramidal".into()),
        ..Selection::default()
    };
    let chosen = circuit.select(&selection).expect("a set");
    let own: Vec<f64> = chosen.iter().map(|n| f64::from(n.row)).collect();
    assert!(!own.is_empty());
    assert_eq!(numbers(&theirs["upper"]), own);
    assert!(theirs["n_spikes"].as_u64().is_some_and(|n| n > 0));
}

#[test]
fn the_seed_decides_every_file() {
    let (work, _) = made();
    for (folder, seed) in [("same", 9), ("other", 10)] {
        work.run(&format!(
            "synth circuit -o {folder} --neurons 60 --morphologies 4 --points 100 --reported 5 --seed {seed}"
        ))
        .exits(0);
    }
    let files = |folder| work.files(folder).into_values().collect::<Vec<_>>();
    assert_eq!(files("c"), files("same"));
    assert_ne!(files("c"), files("other"));
    let again = work.run("synth circuit -o c --neurons 60").exits(1);
    assert!(
        again.errors()[0].contains("--force"),
        "{:?}",
        again.errors()
    );
}
