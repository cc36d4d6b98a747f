//! Networks of Snudda, and what is said of formats before SONATA.

use std::fs;

use hdf5_pure::FileBuilder;

use crate::work::{SMALL, Work};

/// A network of two cells, 100 µm apart, with a synapse between them.
fn network(work: &Work) {
    let mut file = FileBuilder::new();
    let mut group = file.create_group("network");
    let mut neurons = group.create_group("neurons");
    neurons.create_dataset("neuron_id").with_i64_data(&[0, 1]);
    for (name, values) in [
        ("name", ["dSPN_0", "FS_1"]),
        ("morphology", ["$SNUDDA_DATA/neurons/cell.swc"; 2]),
    ] {
        let dataset = neurons.create_dataset(name);
        dataset.with_ascii_strings(&values).expect("plain text");
    }
    neurons
        .create_dataset("position")
        .with_f64_data(&[0.0, 0.0, 0.0, 1e-4, 0.0, 0.0])
        .with_shape(&[2, 3]);
    let upright = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    neurons
        .create_dataset("rotation")
        .with_f64_data(&[upright, upright].concat())
        .with_shape(&[2, 9]);
    group.add_group(neurons.finish());
    group
        .create_dataset("synapses")
        .with_i32_data(&[0, 1, 30, 2, 0, 0, 1, 50, 20, 1, 500, 400, 0])
        .with_shape(&[1, 13]);
    file.add_group(group.finish());
    let mut meta = file.create_group("meta");
    meta.create_dataset("voxel_size")
        .with_f64_data(&[3e-6])
        .with_shape(&[]);
    meta.create_dataset("simulation_origo")
        .with_f64_data(&[0.0; 3]);
    file.add_group(meta.finish());
    fs::create_dir_all(work.path("net/elsewhere/neurons")).expect("made");
    work.file("net/elsewhere/neurons/cell.swc", SMALL);
    let path = work.path("net/network-synapses.hdf5");
    fs::write(path, file.finish().expect("bytes")).expect("written");
}

#[neurotess_testing::test]
fn a_network_is_told_of_meshed_and_listed_like_a_circuit() {
    let work = Work::new();
    network(&work);
    let told = work.run("info net --json").exits(0);
    let json = told.json();
    let circuit = &json[0];
    assert_eq!(
        (&circuit["n_neurons"], &circuit["n_shown"]),
        (&2.into(), &0.into())
    );
    assert!(
        told.stderr()
            .contains("set the environment variable SNUDDA_DATA"),
        "{}",
        told.stderr()
    );
    // The folder of its data, as Snudda takes it.
    let with_data = |line: &str| {
        let output = work
            .command(line)
            .env("SNUDDA_DATA", work.path("net/elsewhere"))
            .output()
            .expect("it runs");
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{line}: {errors}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let json: serde_json::Value =
        serde_json::from_str(&with_data("info net/network-synapses.hdf5 --json")).expect("JSON");
    assert_eq!(json[0]["n_shown"], 2);
    assert_eq!(json[0]["edges"][0]["n_edges"], 1);
    assert_eq!(json[0]["bbox"]["max"][0], 100.0);
    let nodes = with_data("nodes net --columns type");
    assert!(nodes.contains("dSPN") && nodes.contains("FS"), "{nodes}");
    with_data("mesh net -o out --level 0 --soma sphere");
    assert_eq!(work.names("out"), ["neurons_0.ply", "neurons_1.ply"]);
}

#[neurotess_testing::test]
fn a_network_is_drawn_with_its_synapses() {
    let work = Work::new();
    network(&work);
    let line = "render net -o net.png --size 160x120 --samples 1 --soma sphere --synapses \
                --marker-color-by conductance --color-by-attribute type --stats stats.json";
    let output = work
        .command(line)
        .env("SNUDDA_DATA", work.path("net/elsewhere"))
        .output()
        .expect("it runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let stats: serde_json::Value = serde_json::from_str(&work.text("stats.json")).expect("JSON");
    let markers = &stats["pictures"][0]["markers"];
    let markers = if markers.is_null() {
        &stats["markers"]
    } else {
        markers
    };
    assert_eq!(markers["all"], 1, "{stats}");
}

#[neurotess_testing::test]
fn formats_before_sonata_are_refused_with_a_way_out() {
    let work = Work::new();
    work.file(
        "BlueConfig",
        "Run Default\n{\n  CircuitPath /there\n  MorphologyPath /cells\n  \
         CellLibraryFile circuit.mvd3\n}\n",
    );
    work.file("circuit.mvd2", "");
    for command in [
        "info BlueConfig",
        "mesh BlueConfig -o out",
        "nodes BlueConfig",
    ] {
        let errors = work.run(command).exits(1).errors();
        let said = "its cells are in /there/circuit.mvd3; convert them by 'brainbuilder sonata";
        assert!(errors[0].contains(said), "{command}: {errors:?}");
    }
    let errors = work.run("info circuit.mvd2").exits(1).errors();
    assert!(
        errors[0].contains("MVD2 is not read: convert them"),
        "{errors:?}"
    );
}
