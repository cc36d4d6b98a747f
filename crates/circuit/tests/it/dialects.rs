//! SONATA as bmtk and bluepysnap have it, where the guide says less: places, tables of types, containers.

use std::fs;

use hdf5_pure::{FileBuilder, GroupBuilder};
use neurotess_circuit::Circuit;
use tempfile::TempDir;

const CELL: &str = "1 1 0 0 0 5 -1\n2 3 9 0 0 1 1\n3 3 30 0 0 1 2\n";
const SWC: &str = r#""morphologies_dir": "m""#;

/// A group of nodes of type 100.
type Group = fn(&mut GroupBuilder);

/// A folder with a circuit whose population `p` has two nodes in each of these groups.
fn folder(components: &str, types: &str, type_ids: &[i64], groups: &[Group]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let mut file = FileBuilder::new();
    let mut nodes = file.create_group("nodes");
    let mut population = nodes.create_group("p");
    let count = 2 * groups.len() as u64;
    let ids: Vec<u64> = (0..count).map(|node| node / 2).collect();
    let rows: Vec<u64> = (0..count).map(|node| node % 2).collect();
    population
        .create_dataset("node_type_id")
        .with_i64_data(type_ids);
    population
        .create_dataset("node_group_id")
        .with_u64_data(&ids);
    population
        .create_dataset("node_group_index")
        .with_u64_data(&rows);
    for (number, fill) in groups.iter().enumerate() {
        let mut group = population.create_group(&number.to_string());
        fill(&mut group);
        population.add_group(group.finish());
    }
    nodes.add_group(population.finish());
    file.add_group(nodes.finish());
    let write = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("folders");
        fs::write(path, content).expect("written");
    };
    write("nodes.h5", &file.finish().expect("bytes"));
    write("types.csv", types.as_bytes());
    write("m/cell.swc", CELL.as_bytes());
    let config = format!(
        r#"{{"components": {{{components}}}, "networks": {{"nodes": [
            {{"nodes_file": "nodes.h5", "node_types_file": "types.csv"}}]}}}}"#
    );
    write("circuit_config.json", config.as_bytes());
    folder
}

fn open(folder: &TempDir) -> Circuit {
    let circuit = Circuit::open(folder.path()).expect("a circuit");
    assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
    circuit
}

/// Code and count of each warning.
fn warned(circuit: &Circuit) -> Vec<(&str, u64)> {
    let warnings = circuit.warnings.iter();
    warnings.map(|w| (w.code, w.count)).collect()
}

fn axes(group: &mut GroupBuilder, names: &[&str]) {
    for name in names {
        group.create_dataset(name).with_f64_data(&[7.0, 8.0]);
    }
}

#[neurotess_testing::test]
fn empty_fields_of_types_are_no_values() {
    let group: Group = |group| axes(group, &["x", "y", "z"]);
    for row in [
        "100 biophysical  cell.swc",
        "100   cell.swc",
        "100 biophysical NA \"cell.swc\" ",
    ] {
        let types = format!("node_type_id model_type dynamics_params morphology\n{row}\n");
        let circuit = open(&folder(SWC, &types, &[100, 100], &[group]));
        assert_eq!((circuit.n_shown(), warned(&circuit)), (2, vec![]), "{row}");
        let attributes = &circuit.populations[0].attributes;
        let text = |name: &str| attributes.get(name).and_then(|a| a.text(0));
        assert_eq!(text("dynamics_params"), None);
        assert_eq!(text("morphology"), Some("cell.swc"));
    }
}
