//! Circuits as other programs lay them out, from wherever the command runs, and tables made of them.

use std::path::Path;

use hdf5_pure::FileBuilder;
use serde_json::Value;

use crate::work::{Run, SMALL, Work};

/// Configurations of one circuit in `deep/c`, all of which name the same files.
const CONFIGS: [&str; 5] = [
    r#"{"manifest": {"$BASE": "${configdir}"}, "components": {"morphologies_dir": "$BASE/morph"},
        "networks": {"nodes": [{"nodes_file": "$BASE/net/nodes.h5", "node_types_file": "$BASE/net/types.csv"}]}}"#,
    r#"{"manifest": {"$BASE_DIR": ".", "$NET": "$BASE_DIR/net", "$MORPH": "${BASE_DIR}/./morph"},
        "components": {"morphologies_dir": "$MORPH"},
        "networks": {"nodes": [{"nodes_file": "${NET}/nodes.h5", "node_types_file": "$NET/types.csv"}]}}"#,
    r#"{"manifest": {"$UP": "${configdir}/..", "$C": "$UP/c"}, "components": {"morphologies_dir": "./morph"},
        "networks": {"nodes": [{"nodes_file": "../c/net/nodes.h5", "node_types_file": "$C/net/types.csv"}]}}"#,
    r#"{"components": {"morphologies_dir": "${configdir}/morph"}, "networks": {"nodes": [
        {"nodes_file": "net/nodes.h5", "node_types_file": "./net/types.csv"}]}}"#,
    r#"{"manifest": {"$WORK": "${workingdir}"}, "components": {"morphologies_dir": "$WORK/morph"},
        "networks": {"nodes": [{"nodes_file": "$WORK/net/nodes.h5", "node_types_file": "$WORK/net/types.csv"}]}}"#,
];

/// Two cells and two virtual nodes.
fn circuit(work: &Work) {
    let mut file = FileBuilder::new();
    let mut nodes = file.create_group("nodes");
    let mut population = nodes.create_group("p");
    population
        .create_dataset("node_type_id")
        .with_i64_data(&[100, 100, 7, 7]);
    population
        .create_dataset("node_group_id")
        .with_u64_data(&[0, 0, 1, 1]);
    population
        .create_dataset("node_group_index")
        .with_u64_data(&[0, 1, 0, 1]);
    let mut cells = population.create_group("0");
    cells
        .create_dataset("positions")
        .with_f64_data(&[0.0, 0.0, 0.0, 50.0, 0.25, 0.0])
        .with_shape(&[2, 3]);
    cells.create_dataset("recenter").with_f64_data(&[1.0, 1.0]);
    population.add_group(cells.finish());
    let others = population.create_group("1");
    population.add_group(others.finish());
    nodes.add_group(population.finish());
    file.add_group(nodes.finish());
    work.file("deep/c/net/nodes.h5", file.finish().expect("bytes"));
    work.file(
        "deep/c/net/types.csv",
        "node_type_id model_type dynamics_params morphology\n100 biophysical  cell.swc\n7 virtual  NULL\n",
    );
    work.file("deep/c/morph/cell.swc", SMALL);
    work.file("deep/c/circuit_config.json", CONFIGS[0]);
}

/// Runs the command in a folder of the working folder.
fn run_in(work: &Work, folder: &str, arguments: &str) -> Run {
    let mut command = work.command(arguments);
    command.current_dir(work.path(folder));
    Run(command.output().expect("it runs"))
}

/// What `info --json` says of one circuit, which has neither warnings nor errors.
fn info(work: &Work, folder: &str, input: &str) -> Value {
    let mut json = run_in(work, folder, &format!("info {input} --json"))
        .exits(0)
        .json();
    let info = json[0].take();
    let list = |key: &str| info[key].as_array().map(Vec::len);
    assert_eq!(list("errors"), Some(0), "{folder} {input}: {info}");
    info
}

#[neurotess_testing::test]
fn a_circuit_opens_from_everywhere() {
    let work = Work::new();
    circuit(&work);
    work.file("aside/x/note.txt", "");
    let whole = work.path("deep/c").display().to_string();
    let inputs = [
        ("", "deep/c"),
        ("", "./deep/../deep/c/"),
        ("deep", "c"),
        ("deep/c", "."),
        ("deep/c", "circuit_config.json"),
        ("deep/c/net", ".."),
        ("aside/x", "../../deep/c/circuit_config.json"),
        ("aside/x", &whole),
    ];
    for config in CONFIGS {
        work.file("deep/c/circuit_config.json", config);
        for (folder, input) in inputs {
            let info = info(&work, folder, input);
            let counts = [
                &info["n_neurons"],
                &info["n_shown"],
                &info["n_morphologies"],
            ];
            assert_eq!(counts, [4, 2, 1], "{config} {folder} {input}");
            assert_eq!(info["bbox"]["max"], serde_json::json!([50.0, 0.25, 0.0]));
        }
    }
}

#[neurotess_testing::test]
fn a_simulation_names_its_circuit_and_its_outputs_from_everywhere() {
    let work = Work::new();
    circuit(&work);
    let spikes = {
        let mut file = FileBuilder::new();
        let mut spikes = file.create_group("spikes");
        let mut group = spikes.create_group("p");
        group.create_dataset("timestamps").with_f64_data(&[1.0]);
        group.create_dataset("node_ids").with_u64_data(&[0]);
        spikes.add_group(group.finish());
        file.add_group(spikes.finish());
        file.finish().expect("bytes")
    };
    work.file("deep/sim/out/spikes.h5", spikes);
    let simulations = [
        r#"{"manifest": {"$OUT": "${configdir}/out"}, "network": "${configdir}/../c/circuit_config.json",
            "output": {"output_dir": "$OUT", "spikes_file": "spikes.h5"}}"#,
        r#"{"manifest": {"$BASE_DIR": ".", "$OUT": "$BASE_DIR/out"}, "network": "$BASE_DIR/../c/circuit_config.json",
            "output": {"output_dir": "$OUT", "spikes_file": "$OUT/spikes.h5"}}"#,
        r#"{"network": "../c/circuit_config.json",
            "output": {"output_dir": "./out", "spikes_file": "${configdir}/out/spikes.h5"}}"#,
    ];
    for simulation in simulations {
        work.file("deep/sim/simulation_config.json", simulation);
        for (folder, input) in [
            ("", "deep/sim/simulation_config.json"),
            ("deep", "sim"),
            ("deep/sim", "simulation_config.json"),
            ("deep/c/net", "../../sim"),
        ] {
            let info = info(&work, folder, input);
            assert_eq!(info["n_shown"], 2, "{simulation} {folder} {input}");
            assert_eq!(
                info["reports"][0]["name"], "spikes",
                "{simulation} {folder}: {info}"
            );
            assert_eq!(info["reports"][0]["n_spikes"], 1);
        }
    }
}

#[neurotess_testing::test]
fn a_table_of_nodes_opens_where_it_stands() {
    let work = Work::new();
    circuit(&work);
    work.file("aside/x/note.txt", "");
    for (folder, input, out) in [
        ("", "deep/c", "aside/t.csv"),
        ("", "deep/c", "t.csv"),
        ("deep/c", ".", "../../aside/x/t.csv"),
        ("aside/x", "../../deep/c", "t.tsv"),
        ("deep", "c", "c/t.csv"),
    ] {
        run_in(&work, folder, &format!("nodes {input} --csv {out} --force")).exits(0);
        let table = Path::new(folder).join(out);
        let text = work.text(&table.display().to_string());
        let delimiter = if out.ends_with(".tsv") { '\t' } else { ',' };
        let head: Vec<&str> = text
            .lines()
            .next()
            .unwrap_or_default()
            .split(delimiter)
            .collect();
        for name in ["morphology", "recenter", "population", "file"] {
            let count = head.iter().filter(|head| **head == name).count();
            assert_eq!(count, 1, "{name} in {head:?}");
        }
        let here = table.parent().expect("a parent").display().to_string();
        let name = table.file_name().expect("a name").display().to_string();
        for (folder, input) in [(here.as_str(), name), ("", table.display().to_string())] {
            let info = info(&work, folder, &input);
            assert_eq!([&info["n_neurons"], &info["n_shown"]], [4, 2], "{text}");
            assert_eq!(info["bbox"]["max"], serde_json::json!([50.0, 0.25, 0.0]));
            let warnings = info["warnings"].as_array().expect("a list");
            assert_eq!(warnings.len(), 1, "{warnings:?}");
            assert_eq!(
                (&warnings[0]["code"], &warnings[0]["count"]),
                (&"row_without_cell".into(), &2.into())
            );
        }
    }
    // What was read from a table is written as it was.
    let once = work.run("nodes t.csv").exits(0).stdout();
    work.file("aside/again.csv", &once);
    assert_eq!(work.run("nodes aside/again.csv").exits(0).stdout(), once);
    // From standard output it may go anywhere.
    let cell = work
        .path("deep/c/morph/cell.swc")
        .canonicalize()
        .expect("there");
    let named = once.lines().nth(1).and_then(|row| row.split(',').nth(3));
    let named = Path::new(named.expect("a file")).canonicalize();
    assert_eq!(named.expect("there"), cell);
    let meshed = run_in(&work, "aside", "mesh t.csv -o m --level 0 --json")
        .exits(0)
        .json();
    assert_eq!(meshed.as_array().map(Vec::len), Some(2));
}
