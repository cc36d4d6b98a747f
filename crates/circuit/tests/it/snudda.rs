//! Networks of Snudda, written here as its versions 1 and 2 write them.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use hdf5_pure::FileBuilder;
use neurotess_circuit::{Attribute, Circuit, Selection, SynapseSide, is_circuit};
use proptest::prelude::*;
use tempfile::TempDir;

const CELL: &str = "1 1 0 0 0 5 -1\n2 3 9 0 0 1 1\n3 3 30 0 0 1 2\n";
/// A quarter turn about z, row by row.
const TURNED: [f64; 9] = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
const UNTURNED: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// What a network is written of.
struct Network {
    /// Whether names are those of version 1.
    old: bool,
    positions: Vec<f64>,
    rotations: Vec<f64>,
    morphologies: [&'static str; 3],
    /// Rows of 13.
    synapses: Vec<i32>,
    data: Option<&'static str>,
}

impl Default for Network {
    fn default() -> Self {
        let row = |from: i32, to: i32, voxel: [i32; 3], conductance: i32| {
            let [x, y, z] = voxel;
            [from, to, x, y, z, 0, 7, 120, 30, 2, 500, conductance, 0]
        };
        Self {
            old: false,
            positions: vec![0.0, 0.0, 0.0, 100e-6, 0.0, 0.0, 0.0, 200e-6, -50e-6],
            rotations: [UNTURNED, TURNED, UNTURNED].concat(),
            morphologies: [
                "$SNUDDA_DATA/neurons/a.swc",
                "$SNUDDA_DATA/neurons/a.swc",
                "own.swc",
            ],
            synapses: [row(0, 1, [10, 0, 0], 400), row(2, 0, [0, 3, 1], 600)].concat(),
            data: Some("given"),
        }
    }
}

impl Network {
    fn name(&self, new: &'static str, old: &'static str) -> &'static str {
        if self.old { old } else { new }
    }

    /// Writes the network and its morphologies; returns its path.
    fn write(&self, folder: &Path) -> PathBuf {
        let mut file = FileBuilder::new();
        let mut network = file.create_group("network");
        let mut neurons = network.create_group("neurons");
        let ids = self.name("neuron_id", "neuronID");
        neurons.create_dataset(ids).with_i64_data(&[0, 1, 2]);
        let texts = [
            ("name", ["dSPN_0", "dSPN_1", "FS_0"]),
            ("morphology", self.morphologies),
            (self.name("volume_id", "volumeID"), ["Striatum"; 3]),
            (self.name("parameter_key", "parameterKey"), ["p1", "", "p2"]),
        ];
        for (name, values) in texts {
            let dataset = neurons.create_dataset(name);
            dataset.with_ascii_strings(&values).expect("plain text");
        }
        for (name, values, width) in [
            ("position", &self.positions, 3),
            ("rotation", &self.rotations, 9),
        ] {
            let rows = (values.len() / width) as u64;
            let shape = [rows, width as u64];
            let dataset = neurons.create_dataset(name);
            dataset.with_f64_data(values).with_shape(&shape);
            dataset.with_chunks(&shape).with_deflate(4);
        }
        network.add_group(neurons.finish());
        let rows = (self.synapses.len() / 13) as u64;
        let synapses = network.create_dataset("synapses");
        synapses
            .with_i32_data(&self.synapses)
            .with_shape(&[rows, 13]);
        if rows > 0 {
            synapses.with_chunks(&[rows, 13]).with_lzf();
        }
        let gaps = self.name("gap_junctions", "gapJunctions");
        network
            .create_dataset(gaps)
            .with_i32_data(&[1, 2, 5, 6, 250, 750, 1, 2, 3, 0, 500])
            .with_shape(&[1, 11]);
        file.add_group(network.finish());
        let mut meta = file.create_group("meta");
        let size = self.name("voxel_size", "voxelSize");
        meta.create_dataset(size)
            .with_f64_data(&[3e-6])
            .with_shape(&[]);
        let origin = self.name("simulation_origo", "simulationOrigo");
        meta.create_dataset(origin)
            .with_f64_data(&[-1e-6, 0.0, 10e-6]);
        if let Some(data) = self.data {
            let name = self.name("snudda_data", "snuddaData");
            meta.create_dataset(name)
                .with_vlen_strings(&[data])
                .with_shape(&[]);
        }
        file.add_group(meta.finish());
        let path = folder.join("network-synapses.hdf5");
        fs::write(&path, file.finish().expect("bytes")).expect("written");
        fs::create_dir_all(folder.join("given/neurons")).expect("made");
        fs::write(folder.join("given/neurons/a.swc"), CELL).expect("written");
        fs::write(folder.join("own.swc"), CELL).expect("written");
        path
    }

    fn open(&self) -> (TempDir, Circuit) {
        let folder = tempfile::tempdir().expect("a folder");
        let circuit = Circuit::open(self.write(folder.path())).expect("a circuit");
        (folder, circuit)
    }

    fn refused(&self) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let error = Circuit::open(self.write(folder.path())).expect_err("an error");
        error.to_string()
    }
}

#[neurotess_testing::test]
fn both_versions_open_in_micrometers() {
    for old in [false, true] {
        let (_folder, circuit) = Network {
            old,
            ..Network::default()
        }
        .open();
        assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
        assert!(circuit.warnings.is_empty(), "{:?}", circuit.warnings);
        assert_eq!((circuit.format, circuit.n_shown()), ("snudda", 3));
        assert_eq!(circuit.templates.len(), 2, "two neurons share a file");
        let neurons = &circuit.populations[0];
        assert!(neurons.positions[1].distance(DVec3::X * 100.0) < 1e-9);
        // The matrix turns x to y, and nothing is moved before.
        assert!((neurons.rotations[1] * DVec3::X).distance(DVec3::Y) < 1e-9);
        assert_eq!(neurons.recentered, [false; 3]);
        let text = |name: &str, row| neurons.attributes[name].text(row).map(str::to_owned);
        assert_eq!(text("type", 0), Some("dSPN".into()));
        assert_eq!(text("type", 2), Some("FS".into()));
        assert_eq!(text("volume_id", 1), Some("Striatum".into()));
        assert_eq!(text("parameter_key", 1), None);
        let Attribute::Text { library, .. } = &neurons.attributes["type"] else {
            panic!("types are texts");
        };
        assert_eq!(library, &["dSPN", "FS"]);
    }
}

#[neurotess_testing::test]
fn synapses_have_ends_places_and_numbers() {
    for old in [false, true] {
        let (_folder, circuit) = Network {
            old,
            ..Network::default()
        }
        .open();
        let [synapses, gaps] = &circuit.edges[..] else {
            panic!("two tables: {:?}", circuit.edges);
        };
        assert_eq!((&*synapses.name, synapses.count), ("synapses", 2));
        let read = synapses.synapses().expect("synapses");
        assert_eq!((read.sources, read.targets), (vec![0, 2], vec![1, 0]));
        // Voxel times size, from the origin on: all of it meters.
        assert!(read.positions[0].distance(DVec3::new(29.0, 0.0, 10.0)) < 1e-9);
        assert!(read.positions[1].distance(DVec3::new(-1.0, 9.0, 13.0)) < 1e-9);
        let other = synapses
            .synapses_on(SynapseSide::Efferent)
            .expect("the same");
        assert_eq!(other.positions, read.positions);
        let conductance = synapses.property("conductance").expect("a number");
        assert_eq!(conductance, [400.0, 600.0]);
        assert_eq!(synapses.property("dest_seg_x").expect("one")[0], 0.5);
        assert!(
            synapses
                .properties()
                .expect("names")
                .contains(&"dest_seg_id".into())
        );
        let read = gaps.synapses().expect("gap junctions");
        assert!(read.positions[0].distance(DVec3::new(2.0, 6.0, 19.0)) < 1e-9);
        assert_eq!(gaps.property("conductance").expect("a number"), [500.0]);
        let wrong = gaps.property("delay").expect_err("none").to_string();
        assert!(
            wrong.contains("'network/gap_junctions/delay': is missing"),
            "{wrong}"
        );
    }
}

#[neurotess_testing::test]
fn a_folder_is_opened_by_its_network() {
    let folder = tempfile::tempdir().expect("a folder");
    assert!(!is_circuit(folder.path()));
    let path = Network::default().write(folder.path());
    assert!(is_circuit(folder.path()) && is_circuit(&path));
    let other = folder.path().join("renamed.h5");
    fs::rename(&path, &other).expect("renamed");
    assert!(is_circuit(&other), "by its content");
    assert_eq!(Circuit::open(other).expect("a circuit").n_shown(), 3);
}

#[neurotess_testing::test]
fn data_of_snudda_are_where_the_configuration_or_the_network_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let network = Network {
        data: Some("moved"),
        ..Network::default()
    };
    let path = network.write(folder.path());
    let circuit = Circuit::open(&path).expect("a circuit");
    assert_eq!(circuit.n_shown(), 1, "only what needs no data");
    let warning = circuit.warnings[0].to_string();
    assert!(
        warning.contains("1 morphologies of 2 neurons are not there"),
        "{warning}"
    );
    assert!(
        warning.contains("SNUDDA_DATA") && warning.contains("moved"),
        "{warning}"
    );
    let config = folder.path().join("network-config.json");
    fs::write(&config, r#"{"SnuddaData": "given"}"#).expect("written");
    assert_eq!(Circuit::open(&path).expect("a circuit").n_shown(), 3);
    fs::remove_file(config).expect("removed");
    fs::rename(folder.path().join("given"), folder.path().join("data")).expect("renamed");
    assert_eq!(Circuit::open(&path).expect("a circuit").n_shown(), 3);
}

#[neurotess_testing::test]
fn cells_with_broken_numbers_are_left_out_and_told_of() {
    let mut network = Network::default();
    network.positions[0] = f64::NAN;
    network.rotations[9] = 3.0;
    let (_folder, circuit) = network.open();
    assert_eq!(circuit.n_shown(), 1);
    let said: Vec<String> = circuit.failures.iter().map(ToString::to_string).collect();
    assert!(
        said[0].contains("'network/neurons/position': row 0 is NaN"),
        "{said:?}"
    );
    assert!(
        said[1].contains("'network/neurons/rotation': row 1 is no rotation"),
        "{said:?}"
    );
}

#[neurotess_testing::test]
fn faults_name_file_and_dataset() {
    let mut network = Network::default();
    network.positions.truncate(6);
    let said = network.refused();
    assert!(
        said.contains("'network/neurons/position': has shape [2, 3] instead of [3, 3]"),
        "{said}"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let mut file = FileBuilder::new();
    file.create_dataset("x").with_f64_data(&[1.0]);
    let path = folder.path().join("network-synapses.hdf5");
    fs::write(&path, file.finish().expect("bytes")).expect("written");
    let other = Circuit::open(&path).expect_err("an error").to_string();
    assert!(
        other.contains("'network/neurons': is not in this HDF5 file"),
        "{other}"
    );
    fs::write(&path, "no HDF5").expect("written");
    assert!(
        is_circuit(&path),
        "by its name, so that the error is this one"
    );
    let broken = Circuit::open(&path).expect_err("an error").to_string();
    assert!(broken.contains("cannot be read as HDF5"), "{broken}");
}

#[neurotess_testing::test]
fn a_negative_id_of_a_synapse_is_told_of() {
    let mut network = Network::default();
    network.synapses[13] = -1;
    let (_folder, circuit) = network.open();
    let said = circuit.edges[0]
        .synapses()
        .expect_err("an error")
        .to_string();
    assert!(said.contains("'network/synapses': row 1 is -1"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    /// Whatever is in a file, opening it ends with a network or an error.
    #[neurotess_testing::test]
    fn flipped_bytes_end(at in any::<prop::sample::Index>(), byte in any::<u8>(), old in any::<bool>()) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = Network { old, ..Network::default() }.write(folder.path());
        let mut bytes = fs::read(&path).expect("bytes");
        let at = at.index(bytes.len());
        bytes[at] = byte;
        fs::write(&path, bytes).expect("written");
        if let Ok(circuit) = Circuit::open(&path) {
            let nodes = circuit.select(&Selection::default()).expect("all");
            circuit.instances(&nodes, None);
            for edges in &circuit.edges {
                // Errors are fine.
                edges.synapses().ok();
                edges.property("conductance").ok();
            }
        }
    }
}
