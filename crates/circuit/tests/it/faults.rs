//! Bad input: each an error that names file and key, none a panic, and the rest opens.

use std::fs;
use std::path::{Path, PathBuf};

use hdf5_pure::FileBuilder;
use neurotess_circuit::{Circuit, RecordingFile, Report, Selection, Spikes};
use tempfile::TempDir;

const CELL: &str = "1 1 0 0 0 5 -1\n2 3 9 0 0 1 1\n3 3 30 0 0 1 2\n";
const CONFIG: &str = r#"{"manifest": {"$D": "."}, "components": {"morphologies_dir": "$D"},
    "networks": {"nodes": [{"nodes_file": "$D/nodes.h5"}]}}"#;

struct Columns(Vec<(&'static str, Vec<f64>)>);

impl Columns {
    fn good() -> Self {
        Self(vec![
            ("x", vec![0.0, 10.0, 20.0]),
            ("y", vec![0.0; 3]),
            ("z", vec![0.0; 3]),
        ])
    }

    fn with(mut self, name: &'static str, values: &[f64]) -> Self {
        self.0.retain(|(other, _)| *other != name);
        self.0.push((name, values.to_vec()));
        self
    }

    fn write(&self, folder: &Path) {
        let mut file = FileBuilder::new();
        let mut nodes = file.create_group("nodes");
        let mut population = nodes.create_group("p");
        population
            .create_dataset("node_type_id")
            .with_i64_data(&[-1; 3]);
        let mut group = population.create_group("0");
        for (name, values) in &self.0 {
            group.create_dataset(name).with_f64_data(values);
        }
        group
            .create_dataset("morphology")
            .with_vlen_strings(&["cell", "cell.swc", "none"]);
        population.add_group(group.finish());
        nodes.add_group(population.finish());
        file.add_group(nodes.finish());
        fs::write(folder.join("nodes.h5"), file.finish().expect("bytes")).expect("written");
    }
}

/// A circuit of three nodes, two of which show a cell.
fn circuit(config: &str, columns: &Columns) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    columns.write(folder.path());
    fs::write(folder.path().join("cell.swc"), CELL).expect("written");
    let path = folder.path().join("circuit_config.json");
    fs::write(&path, config).expect("written");
    (folder, path)
}

/// The error of a configuration, with the folder left out.
fn refused(config: &str) -> String {
    let (folder, path) = circuit(config, &Columns::good());
    let error = Circuit::open(&path).expect_err(config).to_string();
    error.replace(&format!("{}/", folder.path().display()), "")
}

#[neurotess_testing::test]
fn a_good_circuit_opens() {
    let (_folder, path) = circuit(CONFIG, &Columns::good());
    let circuit = Circuit::open(path).expect("a circuit");
    assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
    // The same file with and without its extension is one template; 'none' is not there.
    assert_eq!((circuit.templates.len(), circuit.n_shown()), (1, 2));
    assert_eq!(circuit.warnings[0].code, "morphology_missing");
}

#[neurotess_testing::test]
fn configurations_are_refused_with_file_and_key() {
    let cases = [
        ("{", "circuit_config.json:1: not JSON ("),
        (
            "[1]",
            "circuit_config.json: neither 'networks' nor 'network'",
        ),
        (
            r#"{"networks": {}}"#,
            "circuit_config.json: 'networks.nodes': is missing",
        ),
        (
            r#"{"networks": {"nodes": 3}}"#,
            "circuit_config.json: 'networks.nodes': is a number instead of a list",
        ),
        (
            r#"{"networks": {"nodes": [{"nodes_file": ["a"]}]}}"#,
            "circuit_config.json: 'networks.nodes[0].nodes_file': is a list instead of a string",
        ),
        (
            r#"{"networks": {"nodes": [{"nodes_file": "$E/nodes.h5"}]}}"#,
            "circuit_config.json: 'networks.nodes[0].nodes_file': variable $E is not in the manifest",
        ),
        (
            r#"{"manifest": {"$A": "$B", "$B": "$A"}, "networks": {"nodes": []}}"#,
            "circuit_config.json: 'manifest.$A': is defined by itself (A → B → A)",
        ),
        (
            r#"{"networks": {"nodes": [{"nodes_file": "gone.h5"}]}}"#,
            "circuit_config.json: 'networks.nodes[0].nodes_file': gone.h5 does not exist",
        ),
        (
            r#"{"networks": {"nodes": [{"nodes_file": "nodes.h5", "populations": {"q": {}}}]}}"#,
            "nodes.h5: 'nodes': population 'q' is not there, only p",
        ),
        (
            r#"{"networks": {"nodes": []}}"#,
            "circuit_config.json: no population of nodes",
        ),
        (
            r#"{"networks": {"nodes": [{"nodes_file": "cell.swc"}]}}"#,
            "cell.swc: cannot be read as HDF5",
        ),
    ];
    for (config, expected) in cases {
        let found = refused(config);
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(refused(&deep).contains("not JSON"));
}

#[neurotess_testing::test]
fn morphologies_of_types_may_be_called_by_numbers() {
    let config = r#"{"components": {"morphologies_dir": "."}, "networks": {"nodes": [
        {"nodes_file": "only_types.h5", "node_types_file": "types.csv"}]}}"#;
    let (folder, path) = circuit(config, &Columns::good());
    let mut file = FileBuilder::new();
    let mut nodes = file.create_group("nodes");
    let mut population = nodes.create_group("p");
    population
        .create_dataset("node_type_id")
        .with_i64_data(&[7, 8, 7]);
    let mut group = population.create_group("0");
    for axis in ["x", "y", "z"] {
        group.create_dataset(axis).with_f64_data(&[1.0; 3]);
    }
    population.add_group(group.finish());
    nodes.add_group(population.finish());
    file.add_group(nodes.finish());
    let file = file.finish().expect("bytes");
    fs::write(folder.path().join("only_types.h5"), file).expect("written");
    fs::write(folder.path().join("471087815.swc"), CELL).expect("written");
    let types = "node_type_id morphology rotation_angle_zaxis\n7 471087815 1.5\n8 NULL NULL\n";
    fs::write(folder.path().join("types.csv"), types).expect("written");
    let circuit = Circuit::open(path).expect("a circuit");
    assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
    assert_eq!(circuit.n_shown(), 2);
    let angles = circuit.populations[0].rotations.iter();
    let angles: Vec<f64> = angles.map(|q| q.to_axis_angle().1).collect();
    assert!(
        (angles[0] - 1.5).abs() < 1e-12 && angles[1] == 0.0,
        "{angles:?}"
    );
}

#[neurotess_testing::test]
fn one_bad_part_leaves_the_others() {
    let config = r#"{"components": {"morphologies_dir": "."}, "networks": {"nodes": [
        {"nodes_file": "gone.h5"}, {"nodes_file": "nodes.h5"}],
        "edges": [{"edges_file": "nodes.h5"}]}, "node_sets_file": "cell.swc"}"#;
    let (_folder, path) = circuit(config, &Columns::good());
    let circuit = Circuit::open(path).expect("a circuit");
    assert_eq!(circuit.n_shown(), 2);
    let failures: Vec<String> = circuit.failures.iter().map(ToString::to_string).collect();
    assert_eq!(failures.len(), 3, "{failures:?}");
    assert!(failures[1].contains("'edges': is missing"), "{failures:?}");
    assert!(failures[2].contains("cell.swc:1: not JSON"), "{failures:?}");
}

#[neurotess_testing::test]
fn broken_places_leave_the_other_cells() {
    let nan = f64::NAN;
    let quaternion = |w: &[f64]| {
        Columns::good()
            .with("orientation_w", w)
            .with("orientation_x", &[0.0; 3])
            .with("orientation_y", &[0.0; 3])
            .with("orientation_z", &[0.0; 3])
    };
    let angle = "rotation_angle_zaxis";
    let cases = [
        (
            Columns::good().with("y", &[0.0, nan, 0.0]),
            "nodes/p/0/y",
            "row 1 is NaN",
        ),
        (
            Columns::good().with("x", &[f64::INFINITY, 0.0, 0.0]),
            "nodes/p/0/x",
            "row 0 is inf",
        ),
        (
            quaternion(&[1.0, 0.0, 1.0]),
            "nodes/p/0/orientation_w",
            "row 1 is a zero quaternion",
        ),
        (
            quaternion(&[f64::NEG_INFINITY, 1.0, 1.0]),
            "nodes/p/0/orientation_w",
            "row 0 is -inf",
        ),
        (
            Columns::good().with(angle, &[0.0, f64::INFINITY, 0.0]),
            "nodes/p/0/rotation_angle_zaxis",
            "row 1 is inf",
        ),
    ];
    for (columns, key, what) in cases {
        let (_folder, path) = circuit(CONFIG, &columns);
        let circuit = Circuit::open(path).expect("a circuit");
        assert_eq!(circuit.n_shown(), 1, "{what}");
        let failure = circuit.failures[0].to_string();
        assert!(
            failure.contains(&format!("nodes.h5: '{key}': {what}")),
            "{failure}"
        );
    }
}

#[neurotess_testing::test]
fn wrong_datasets_are_refused() {
    let partial = Columns::good().with("orientation_w", &[1.0; 3]);
    let short = Columns::good().with("y", &[0.0; 2]);
    let cases = [
        (
            partial,
            "'nodes/p: orientation_x': is missing while other components",
        ),
        (
            short,
            "'nodes/p/0/y': has shape [2] instead of at least [3]",
        ),
    ];
    for (columns, expected) in cases {
        let (_folder, path) = circuit(CONFIG, &columns);
        let error = Circuit::open(path).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[neurotess_testing::test]
fn truncated_files_are_errors() {
    let (folder, path) = circuit(CONFIG, &Columns::good());
    let nodes = folder.path().join("nodes.h5");
    let bytes = fs::read(&nodes).expect("there");
    let mut refused = 0;
    for length in (0..bytes.len()).step_by(13) {
        fs::write(&nodes, &bytes[..length]).expect("written");
        refused += usize::from(Circuit::open(&path).is_err());
    }
    assert!(refused > 10, "{refused}");
}

#[neurotess_testing::test]
fn node_sets_are_judged_when_they_are_asked_for() {
    let sets = r#"{"a": ["b"], "b": ["a"], "far": {"x": {"$gt": 5}}, "no": {"mtype": "x"},
        "both": ["far", "first"], "first": {"node_id": [0]}, "un": ["gone"],
        "cells": {"morphology": {"$regex": "cell.*"}, "x": {"$lt": 15}}, "all": {}}"#;
    let config = CONFIG.replace(
        "\"manifest\"",
        "\"node_sets_file\": \"$D/sets.json\", \"manifest\"",
    );
    let (folder, path) = circuit(&config, &Columns::good());
    fs::write(folder.path().join("sets.json"), sets).expect("written");
    let circuit = Circuit::open(&path).expect("a circuit");
    assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
    let rows = |name: &str| {
        let selection = Selection {
            node_set: Some(name.into()),
            ..Selection::default()
        };
        let selected = circuit.select(&selection).map_err(|e| e.to_string())?;
        Ok::<_, String>(selected.iter().map(|n| n.row).collect::<Vec<_>>())
    };
    assert_eq!(rows("far"), Ok(vec![1, 2]));
    assert_eq!(rows("both"), Ok(vec![0, 1, 2]));
    assert_eq!(rows("cells"), Ok(vec![0, 1]));
    assert_eq!(rows("all"), Ok(vec![0, 1, 2]));
    let cases = [
        ("a", "sets.json: 'a': is defined by itself (a → b → a)"),
        (
            "no",
            "sets.json: 'no.mtype': no population has the attribute 'mtype'",
        ),
        ("un", "sets.json: 'un': node set 'gone' is not defined"),
        (
            "gone",
            "circuit_config.json: node set 'gone' is not defined",
        ),
    ];
    for (name, expected) in cases {
        let error = rows(name).expect_err(name);
        assert!(error.contains(expected), "{error}");
    }
    for wrong in [
        r#"{"a": {"x": {"$about": 3}}}"#,
        r#"{"a": {"x": {"$regex": "("}}}"#,
        r#"{"a": {"x": null}}"#,
        r#"{"a": [3]}"#,
    ] {
        fs::write(folder.path().join("sets.json"), wrong).expect("written");
        let circuit = Circuit::open(&path).expect("a circuit");
        assert!(
            circuit.failures[0].to_string().contains("sets.json: 'a"),
            "{wrong}"
        );
    }
}

#[neurotess_testing::test]
fn samples_are_parts_of_larger_ones() {
    let (_folder, path) = circuit(CONFIG, &Columns::good());
    let circuit = Circuit::open(path).expect("a circuit");
    let rows = |count, seed| {
        let sample = Some((count, seed));
        let selected = circuit.select(&Selection {
            sample,
            ..Selection::default()
        });
        selected
            .expect("some")
            .iter()
            .map(|n| n.row)
            .collect::<Vec<_>>()
    };
    assert_eq!(rows(9, 1), [0, 1], "the third shows nothing");
    assert_eq!((rows(1, 1).len(), rows(0, 1).len()), (1, 0));
    let firsts: std::collections::BTreeSet<_> = (0..20).map(|seed| rows(1, seed)[0]).collect();
    assert_eq!(firsts.len(), 2, "the seed decides");
}

/// A report of two nodes with five compartments; each part may be replaced.
fn report(folder: &Path, pointers: &[u64], ids: &[u32], time: &[f64], old: bool) -> PathBuf {
    let mut file = FileBuilder::new();
    let data: Vec<f32> = (0..10).map(|i| i as f32).collect();
    let mut mapping = file.create_group("mapping");
    let names = if old {
        ["gids", "index_pointer", "element_id"]
    } else {
        ["node_ids", "index_pointers", "element_ids"]
    };
    mapping.create_dataset(names[0]).with_u64_data(&[0, 2]);
    mapping.create_dataset(names[1]).with_u64_data(pointers);
    mapping.create_dataset(names[2]).with_u32_data(ids);
    mapping.create_dataset("time").with_f64_data(time);
    let mapping = mapping.finish();
    if old {
        file.create_dataset("data")
            .with_f32_data(&data)
            .with_shape(&[2, 5]);
        file.add_group(mapping);
    } else {
        let mut reports = file.create_group("report");
        let mut group = reports.create_group("p");
        group
            .create_dataset("data")
            .with_f32_data(&data)
            .with_shape(&[2, 5]);
        group.add_group(mapping);
        reports.add_group(group.finish());
        file.add_group(reports.finish());
    }
    let path = folder.join("report.h5");
    fs::write(&path, file.finish().expect("bytes")).expect("written");
    path
}

#[neurotess_testing::test]
fn reports_are_refused_with_file_and_dataset() {
    let folder = tempfile::tempdir().expect("a folder");
    let ids = [0, 1, 1, 0, 1];
    let time = [0.0, 1.0, 0.5];
    for old in [false, true] {
        let good = Report::open(report(folder.path(), &[0, 3, 5], &ids, &time, old));
        let good = good.expect("a report");
        assert_eq!(
            good.populations[0].values(1, &[4, 0]).expect("values"),
            [9.0, 5.0]
        );
        // As many pointers as nodes: the end is the data's.
        let short = Report::open(report(folder.path(), &[0, 3], &ids, &time, old));
        assert_eq!(
            short.expect("a report").populations[0].compartment_range(1),
            3..5
        );
    }
    type Case<'a> = (&'a [u64], &'a [u32], &'a [f64], &'a str);
    let cases: [Case; 7] = [
        (
            &[0, 9, 5],
            &ids,
            &time,
            "'report/p/mapping/index_pointers': pointer 1 is 9",
        ),
        (
            &[0, 4, 3],
            &ids,
            &time,
            "'report/p/mapping/index_pointers': pointer 2 is 3",
        ),
        (
            &[0],
            &ids,
            &time,
            "'report/p/mapping/index_pointers': has shape [1]",
        ),
        (
            &[0, 3, 5],
            &ids[..4],
            &time,
            "'report/p/mapping/element_ids': has shape [4]",
        ),
        (
            &[0, 3, 5],
            &ids,
            &[0.0, 1.0],
            "'report/p/mapping/time': has shape [2]",
        ),
        (
            &[0, 3, 5],
            &ids,
            &[0.0, 1.0, 0.0],
            "'report/p/mapping/time': start 0",
        ),
        (
            &[0, 3, 5],
            &ids,
            &[f64::NAN, 1.0, 0.1],
            "'report/p/mapping/time': start NaN",
        ),
    ];
    for (pointers, ids, time, expected) in cases {
        let path = report(folder.path(), pointers, ids, time, false);
        let error = Report::open(path).expect_err(expected).to_string();
        assert!(error.contains(&format!("report.h5: {expected}")), "{error}");
    }
    let nodes = circuit(CONFIG, &Columns::good());
    let error = RecordingFile::open(nodes.0.path().join("nodes.h5")).expect_err("no report");
    assert!(
        error
            .to_string()
            .contains("nodes.h5: neither a report nor spikes")
    );
    assert!(RecordingFile::open(folder.path().join("gone.h5")).is_err());
}

/// A report of one population in which each node has one compartment; `half`: numbers of 16 bits.
fn small_report(folder: &Path, nodes: &[u64], time: &[f64], half: bool) -> Report {
    let mut file = FileBuilder::new();
    let n = nodes.len() as u64;
    let mut mapping = file.create_group("mapping");
    mapping.create_dataset("node_ids").with_u64_data(nodes);
    let pointers: Vec<u64> = (0..=n).collect();
    mapping
        .create_dataset("index_pointers")
        .with_u64_data(&pointers);
    mapping
        .create_dataset("element_ids")
        .with_u64_data(&vec![0; nodes.len()]);
    mapping.create_dataset("time").with_f64_data(time);
    file.add_group(mapping.finish());
    let data = file.create_dataset("data");
    if half {
        let layout = hdf5_pure::FloatingPointLayout {
            bit_offset: 0,
            bit_precision: 16,
            exponent_location: 10,
            exponent_size: 5,
            mantissa_location: 0,
            mantissa_size: 10,
            exponent_bias: 15,
        };
        let datatype = hdf5_pure::Datatype::FloatingPoint {
            size: 2,
            byte_order: hdf5_pure::DatatypeByteOrder::LittleEndian,
            layout,
        };
        // -65.5, the least number above 0, infinity and 0.333.
        let bytes: Vec<u8> = [0xd418_u16, 0x0001, 0x7c00, 0x3554]
            .iter()
            .flat_map(|n| n.to_le_bytes())
            .collect();
        data.with_raw_data(datatype, bytes, 4);
        data.with_shape(&[4 / n, n]);
    } else {
        data.with_f32_data(&vec![1.0; 2 * nodes.len()])
            .with_shape(&[2, n]);
    }
    let path = folder.join("small.h5");
    fs::write(&path, file.finish().expect("bytes")).expect("written");
    Report::open(path).expect("a report")
}

#[neurotess_testing::test]
fn reports_that_contradict_themselves_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = |nodes: &[u64], time: &[f64]| {
        let warnings = small_report(folder.path(), nodes, time, false).warnings;
        warnings
            .iter()
            .map(|w| (w.code, w.key.clone(), w.count))
            .collect::<Vec<_>>()
    };
    // The end is that of the last frame, or its time.
    assert_eq!(told(&[0, 1], &[0.0, 2.0, 1.0]), []);
    assert_eq!(told(&[0, 1], &[0.0, 1.0, 1.0]), []);
    let time = "mapping/time".to_owned();
    assert_eq!(
        told(&[0, 1], &[0.0, 1000.0, 1.0]),
        [("frames_missing", time.clone(), 1)]
    );
    assert_eq!(
        told(&[0, 1], &[0.0, 0.0, 1.0]),
        [("frames_beyond_end", time, 1)]
    );
    let ids = "mapping/node_ids".to_owned();
    assert_eq!(
        told(&[3, 4, 3, 3], &[0.0, 2.0, 1.0]),
        [("node_repeated", ids, 2)]
    );
}

#[neurotess_testing::test]
fn numbers_of_16_bits_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = small_report(folder.path(), &[0, 1], &[0.0, 2.0, 1.0], true);
    let values = |frame| {
        report.populations[0]
            .values(frame, &[0, 1])
            .expect("values")
    };
    assert_eq!(values(0), [-65.5, 2_f32.powi(-24)]);
    assert_eq!(values(1)[0], f32::INFINITY);
    assert!((values(1)[1] - 0.333).abs() < 1e-4);
}

/// What is wrong with a column of nodes, stored as it is given.
fn nodes_refused(set: impl Fn(&mut hdf5_pure::GroupBuilder)) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let mut file = FileBuilder::new();
    let mut nodes = file.create_group("nodes");
    let mut population = nodes.create_group("p");
    population
        .create_dataset("node_type_id")
        .with_i64_data(&[-1; 2]);
    set(&mut population);
    let mut group = population.create_group("0");
    for axis in ["x", "y", "z"] {
        group.create_dataset(axis).with_f64_data(&[0.0, 1.0]);
    }
    population.add_group(group.finish());
    nodes.add_group(population.finish());
    file.add_group(nodes.finish());
    let bytes = file.finish().expect("bytes");
    fs::write(folder.path().join("nodes.h5"), bytes).expect("written");
    let path = folder.path().join("circuit_config.json");
    fs::write(&path, CONFIG).expect("written");
    match Circuit::open(&path) {
        Ok(circuit) => circuit.failures[0].to_string(),
        Err(e) => e.to_string(),
    }
}

/// An index is never another one than the file has.
#[neurotess_testing::test]
fn negative_and_fractional_indices_are_errors_of_their_row() {
    let natural = "a whole number of 0 or more";
    for (name, text) in [
        ("node_id", natural),
        ("node_group_id", natural),
        ("node_group_index", natural),
    ] {
        let is_index = name == "node_group_index";
        let negative = nodes_refused(|p| {
            if is_index {
                p.create_dataset("node_group_id").with_u64_data(&[0, 0]);
            }
            p.create_dataset(name).with_i32_data(&[0, -1]);
        });
        let told = format!("nodes.h5: 'nodes/p/{name}': row 1 is -1 instead of {text}");
        assert!(negative.contains(&told), "{negative}");
        let fraction = nodes_refused(|p| {
            if is_index {
                p.create_dataset("node_group_id").with_u64_data(&[0, 0]);
            }
            p.create_dataset(name).with_f64_data(&[1.9, 0.0]);
        });
        let told = format!("'nodes/p/{name}': row 0 is 1.9 instead of {text}");
        assert!(fraction.contains(&told), "{fraction}");
    }
    // What is whole is an index, however it is stored.
    let other = nodes_refused(|p| {
        p.create_dataset("node_id").with_f32_data(&[3.0, 7.0]);
        p.create_dataset("node_group_id").with_i8_data(&[0, 0]);
        p.create_dataset("node_group_index")
            .with_f64_data(&[0.0, 0.5]);
    });
    assert!(
        other.contains("'nodes/p/node_group_index': row 1 is 0.5"),
        "{other}"
    );
}

#[neurotess_testing::test]
fn negative_and_fractional_indices_of_reports_spikes_and_edges_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |file: FileBuilder| {
        let path = folder.path().join("a.h5");
        fs::write(&path, file.finish().expect("bytes")).expect("written");
        path
    };
    let report = |column: &str| {
        let mut file = FileBuilder::new();
        let mut mapping = file.create_group("mapping");
        for (name, values) in [
            ("node_ids", [0.0, 1.0]),
            ("index_pointers", [0.0, 1.0]),
            ("element_ids", [0.0, 0.0]),
        ] {
            let wrong = [values[0], -2.0];
            let values = if name == column { &wrong } else { &values };
            mapping.create_dataset(name).with_f64_data(values);
        }
        mapping
            .create_dataset("time")
            .with_f64_data(&[0.0, 1.0, 1.0]);
        file.create_dataset("data")
            .with_f32_data(&[1.0, 2.0])
            .with_shape(&[1, 2]);
        file.add_group(mapping.finish());
        let opened = Report::open(write(file))?;
        opened.populations[0].compartments(1).map(drop)
    };
    for column in ["node_ids", "index_pointers", "element_ids"] {
        let error = report(column).expect_err(column).to_string();
        assert!(
            error.contains(&format!("a.h5: 'mapping/{column}': row 1 is -2 instead")),
            "{error}"
        );
    }
    report("none").expect("a report");
    let mut file = FileBuilder::new();
    let mut spikes = file.create_group("spikes");
    spikes
        .create_dataset("timestamps")
        .with_f64_data(&[0.5, 1.0]);
    spikes
        .create_dataset("node_ids")
        .with_f64_data(&[0.0, 0.25]);
    file.add_group(spikes.finish());
    let error = Spikes::open(write(file))
        .expect_err("a fraction")
        .to_string();
    assert!(
        error.contains("'spikes/node_ids': row 1 is 0.25 instead of"),
        "{error}"
    );
    let edges = |column: &str, wrong: f64| {
        let mut file = FileBuilder::new();
        let mut edges = file.create_group("edges");
        let mut population = edges.create_group("e");
        for name in ["source_node_id", "target_node_id"] {
            let values = [0.0, if name == column { wrong } else { 1.0 }];
            population.create_dataset(name).with_f64_data(&values);
        }
        let mut group = population.create_group("0");
        for name in ["afferent_section_id", "afferent_section_pos"] {
            let values = [0.0, if name == column { wrong } else { 1.0 }];
            group.create_dataset(name).with_f64_data(&values);
        }
        population.add_group(group.finish());
        edges.add_group(population.finish());
        file.add_group(edges.finish());
        let edges = neurotess_circuit::Edges {
            name: "e".into(),
            file: write(file),
            source: "p".into(),
            target: "p".into(),
            count: 2,
        };
        edges.synapses()?;
        edges
            .shares_on(neurotess_circuit::SynapseSide::Afferent)
            .map(drop)
    };
    edges("none", 0.0).expect("synapses");
    for (column, wrong) in [
        ("source_node_id", -1.0),
        ("target_node_id", 1.5),
        ("0/afferent_section_id", -1.0),
        ("0/afferent_section_pos", -0.5),
        ("0/afferent_section_pos", 1.7),
        ("0/afferent_section_pos", f64::NAN),
    ] {
        let error = edges(column.trim_start_matches("0/"), wrong)
            .expect_err(column)
            .to_string();
        assert!(
            error.contains(&format!(
                "a.h5: 'edges/e/{column}': row 1 is {wrong} instead of"
            )),
            "{error}"
        );
    }
}

#[neurotess_testing::test]
fn ids_in_node_sets_are_whole_numbers() {
    let (folder, path) = circuit(
        &CONFIG.replace(
            "\"networks\"",
            "\"node_sets_file\": \"sets.json\", \"networks\"",
        ),
        &Columns::good(),
    );
    for (ids, wrong) in [
        ("[0, -1]", "[1]': is -1"),
        ("1.5", "': is 1.5"),
        ("[0, 1.0]", ""),
    ] {
        fs::write(
            folder.path().join("sets.json"),
            format!("{{\"some\": {{\"node_id\": {ids}}}}}"),
        )
        .expect("written");
        let opened = Circuit::open(&path).expect("a circuit");
        match wrong {
            "" => {
                let nodes = opened
                    .node_sets
                    .nodes(&opened.populations, &opened.file, "some");
                assert_eq!(nodes.expect("nodes").len(), 2);
            }
            wrong => {
                let told = opened.failures[0].to_string();
                let wrong = format!("sets.json: 'some.node_id{wrong} instead of a whole number");
                assert!(told.contains(&wrong), "{told}");
            }
        }
    }
}

#[neurotess_testing::test]
fn reports_of_other_circuits_are_told() {
    let (folder, path) = circuit(CONFIG, &Columns::good());
    let circuit = Circuit::open(path).expect("a circuit");
    let time = [0.0, 1.0, 0.5];
    let path = report(folder.path(), &[0, 3, 5], &[0, 1, 1, 0, 1], &time, false);
    let own = Report::open(&path).expect("a report");
    let rows = own.populations[0].nodes_in(&circuit).expect("its own");
    assert_eq!(rows.iter().map(|n| n.row).collect::<Vec<_>>(), [0, 2]);
    let mut file = FileBuilder::new();
    let mut spikes = file.create_group("spikes");
    spikes
        .create_dataset("timestamps")
        .with_f64_data(&[2.0, 1.0]);
    spikes.create_dataset("gids").with_u64_data(&[7, 0]);
    file.add_group(spikes.finish());
    let path = folder.path().join("spikes.h5");
    fs::write(&path, file.finish().expect("bytes")).expect("written");
    let spikes = Spikes::open(&path).expect("spikes");
    assert_eq!(spikes.populations[0].nodes, [0, 7], "sorted by time");
    let error = spikes.populations[0].nodes_in(&circuit, &spikes.file);
    let error = error.expect_err("of another circuit").to_string();
    assert!(
        error.contains("spikes.h5: 'spikes/") && error.contains("the first is 7"),
        "{error}"
    );
}

#[neurotess_testing::test]
fn a_folder_as_bmtk_leaves_it_is_its_circuit() {
    let pairs = [
        ("config.network.json", "config.simulation.json"),
        ("circuit_config.json", "simulation_config.json"),
        ("network.json", "run.json"),
    ];
    for (network, simulation) in pairs {
        let (folder, path) = circuit(CONFIG, &Columns::good());
        fs::rename(path, folder.path().join(network)).expect("renamed");
        let reports = r#""reports": {"v": {"file_name": "v.h5"}}, "output": {"output_dir": "."}"#;
        let text = format!(r#"{{"network": "./{network}", "run": {{"dt": 0.1}}, {reports}}}"#);
        fs::write(folder.path().join(simulation), text).expect("written");
        // A simulation of something else is none of its.
        let other = r#"{"network": "elsewhere.json", "reports": {"w": {}}}"#;
        fs::write(folder.path().join("other.json"), other).expect("written");
        report(folder.path(), &[0, 1, 2], &[0, 1], &[0.0, 1.0, 0.1], false);
        fs::rename(folder.path().join("report.h5"), folder.path().join("v.h5")).expect("renamed");
        assert!(neurotess_circuit::is_circuit(folder.path()), "{network}");
        let circuit = Circuit::open(folder.path()).expect("a circuit");
        assert_eq!(circuit.n_shown(), 2);
        assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
        assert_eq!(
            circuit.reports.keys().collect::<Vec<_>>(),
            ["v"],
            "{network}"
        );
    }
}

/// Files of a few KB that declare forty million rows (made with h5py, which writes none of them).
#[neurotess_testing::test]
fn headers_are_not_believed() {
    let declared = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/declared");
    let (folder, path) = circuit(CONFIG, &Columns::good());
    for (name, dataset) in [
        ("nodes.h5", "nodes/p/node_type_id"),
        ("attribute.h5", "nodes/p/0/x"),
    ] {
        fs::copy(declared.join(name), folder.path().join("nodes.h5")).expect("copied");
        let error = Circuit::open(&path).expect_err(name).to_string();
        assert!(error.contains("but the file can hold"), "{name}: {error}");
        assert!(error.contains(dataset), "{name}: {error}");
    }
    let report = Report::open(declared.join("report.h5"))
        .expect_err("a report")
        .to_string();
    assert!(
        report.contains("'report/p/mapping/element_ids': declares"),
        "{report}"
    );
    let spikes = Spikes::open(declared.join("spikes.h5"))
        .expect_err("spikes")
        .to_string();
    assert!(
        spikes.contains("'spikes/p/timestamps': declares"),
        "{spikes}"
    );
}
