//! SONATA as bmtk and bluepysnap have it, where the guide says less: places, tables of types, containers.

use std::fs;
use std::path::Path;

use glam::DVec3;
use hdf5_pure::{FileBuilder, GroupBuilder};
use neurotess_circuit::{Circuit, Population, Selection};
use tempfile::TempDir;

const CELL: &str = "1 1 0 0 0 5 -1\n2 3 9 0 0 1 1\n3 3 30 0 0 1 2\n";
const TYPES: &str =
    "node_type_id model_type morphology\n100 biophysical cell.swc\n7 virtual NULL\n";
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

fn places(population: &Population) -> Vec<[f64; 3]> {
    population.positions.iter().map(DVec3::to_array).collect()
}

fn table(group: &mut GroupBuilder, name: &str, columns: u64, values: &[f64]) {
    let rows = values.len() as u64 / columns;
    group
        .create_dataset(name)
        .with_f64_data(values)
        .with_shape(&[rows, columns]);
}

fn axes(group: &mut GroupBuilder, names: &[&str]) {
    for name in names {
        group.create_dataset(name).with_f64_data(&[7.0, 8.0]);
    }
}

#[neurotess_testing::test]
fn positions_are_places_and_come_before_x_y_and_z() {
    let groups: [Group; 5] = [
        |group| table(group, "positions", 3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        |group| {
            table(group, "positions", 2, &[1.0, 2.0, 3.0, 4.0]);
            axes(group, &["x", "y", "z"]);
        },
        |group| axes(group, &["x", "y", "z"]),
        |group| table(group, "position", 3, &[9.0; 6]),
        |group| {
            // More rows than are used; of one dimension it is an attribute.
            table(group, "positions", 3, &[0.5; 12]);
            axes(group, &["position"]);
        },
    ];
    let folder = folder(SWC, TYPES, &[100; 10], &groups);
    let circuit = open(&folder);
    let population = &circuit.populations[0];
    let expected = [
        [1.0, 2.0, 3.0],
        [4.0, 5.0, 6.0],
        [1.0, 2.0, 0.0],
        [3.0, 4.0, 0.0],
        [7.0; 3],
        [8.0; 3],
        [9.0; 3],
        [9.0; 3],
        [0.5; 3],
        [0.5; 3],
    ];
    assert_eq!(places(population), expected);
    assert_eq!((circuit.n_shown(), warned(&circuit)), (10, vec![]));
    let names: Vec<&str> = population.attributes.keys().map(String::as_str).collect();
    assert_eq!(names, ["model_type", "morphology"]);
}

#[neurotess_testing::test]
fn broken_positions_leave_the_other_cells() {
    let groups: [Group; 2] = [
        |group| table(group, "positions", 3, &[1.0, f64::NAN, 3.0, 4.0, 5.0, 6.0]),
        |group| {
            table(
                group,
                "positions",
                3,
                &[f64::NAN, f64::NAN, f64::NAN, 1.0, 1.0, 1.0],
            );
        },
    ];
    let folder_of = |groups: &[Group]| folder(SWC, TYPES, &vec![100; 2 * groups.len()], groups);
    let folder = folder_of(&groups);
    let circuit = Circuit::open(folder.path()).expect("a circuit");
    assert_eq!(circuit.n_shown(), 2);
    let failure = circuit.failures[0].to_string();
    let expected = "nodes.h5: 'nodes/p/0/positions': row 0 is NaN, as are 1 in all";
    assert!(failure.contains(expected), "{failure}");
    // A place that the file has, but not of this node.
    assert_eq!(warned(&circuit), [("position_missing", 1)]);
    for (group, shape) in [
        (
            (|group| table(group, "positions", 4, &[0.0; 8])) as Group,
            "[2, 4]",
        ),
        (|group| table(group, "positions", 3, &[0.0; 3]), "[1, 3]"),
    ] {
        let folder = folder_of(&[group]);
        let error = Circuit::open(folder.path()).expect_err(shape).to_string();
        let expected =
            format!("'nodes/p/0/positions': has shape {shape} instead of at least [2, 3]");
        assert!(error.contains(&expected), "{error}");
    }
}

#[neurotess_testing::test]
fn nodes_of_groups_without_places_are_at_the_origin() {
    let none: Group = |group| axes(group, &["depth"]);
    let circuit = open(&folder(SWC, TYPES, &[100, 100], &[none]));
    assert_eq!(circuit.n_shown(), 2);
    assert_eq!(places(&circuit.populations[0]), [[0.0; 3]; 2]);
    assert_eq!(warned(&circuit), [("placed_at_origin", 2)]);
    let said = circuit.warnings[0].to_string();
    assert!(said.contains("2 nodes have a morphology but no place: they are shown at the origin"));

    // Each group for itself; a coordinate that a group lacks is 0; virtual nodes have no place, and need none.
    let groups: [Group; 4] = [
        |group| axes(group, &["x", "y", "z"]),
        |group| axes(group, &["x", "y"]),
        none,
        none,
    ];
    let types = [100, 100, 100, 100, 100, 100, 7, 7];
    let circuit = open(&folder(SWC, TYPES, &types, &groups));
    let population = &circuit.populations[0];
    let expected = [
        [7.0; 3],
        [8.0; 3],
        [7.0, 7.0, 0.0],
        [8.0, 8.0, 0.0],
        [0.0; 3],
        [0.0; 3],
    ];
    assert_eq!(places(population)[..6], expected);
    assert_eq!(
        (population.position(6), population.position(7)),
        (None, None)
    );
    assert_eq!(
        (circuit.n_shown(), warned(&circuit)),
        (6, vec![("placed_at_origin", 2)])
    );

    // Places of the type are places.
    let types = "node_type_id morphology x y z\n100 cell 1 2 3\n101 cell   \n";
    let circuit = open(&folder(SWC, types, &[100, 101], &[none]));
    assert_eq!(places(&circuit.populations[0]), [[1.0, 2.0, 3.0], [0.0; 3]]);
    assert_eq!(warned(&circuit), [("placed_at_origin", 1)]);
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

/// A container with morphologies of these names, each a soma and a dendrite.
fn container(path: &Path, names: &[&str]) {
    let mut file = FileBuilder::new();
    for name in names {
        match name.split_once('/') {
            Some((folder, name)) => {
                let mut outer = file.create_group(folder);
                let group = morphology(outer.create_group(name));
                outer.add_group(group);
                file.add_group(outer.finish());
            }
            None => {
                let group = morphology(file.create_group(name));
                file.add_group(group);
            }
        }
    }
    fs::write(path, file.finish().expect("bytes")).expect("written");
}

fn morphology(mut group: GroupBuilder) -> hdf5_pure::FinishedGroup {
    let points: [f64; 20] = [
        5.0, 0.0, 0.0, 0.1, -3.0, 4.0, 0.0, 0.1, -3.0, -4.0, 0.0, 0.1, 5.0, 0.0, 0.0, 2.0, 30.0,
        0.0, 0.0, 2.0,
    ];
    table(&mut group, "points", 4, &points);
    group
        .create_dataset("structure")
        .with_i64_data(&[0, 1, -1, 3, 3, 0])
        .with_shape(&[2, 3]);
    group.finish()
}

#[neurotess_testing::test]
fn a_container_is_taken_for_a_folder() {
    let group: Group = |group| axes(group, &["x", "y", "z"]);
    let types = "node_type_id morphology\n100 a\n101 cells/b.h5\n102 c.swc\n103 gone\n";
    let two: [Group; 2] = [group, group];
    for components in [
        r#""alternate_morphologies": {"h5v1": "m/merged.h5"}"#,
        r#""morphologies_dir": "m/merged.h5""#,
        r#""morphologies_dir": "nowhere", "alternate_morphologies": {"h5v1": "./m/../m/merged.h5"}"#,
    ] {
        let folder = folder(components, types, &[100, 101, 102, 103], &two);
        container(&folder.path().join("m/merged.h5"), &["a", "cells/b", "c"]);
        let circuit = open(&folder);
        assert_eq!((circuit.templates.len(), circuit.n_shown()), (3, 3));
        assert_eq!(warned(&circuit), [("morphology_missing", 1)]);
        let mut names = Vec::new();
        for template in &circuit.templates {
            let read = template.read().expect("a morphology");
            assert_eq!(read.morphology.points.len(), 2);
            names.push(read.morphology.name.clone());
        }
        names.sort();
        assert_eq!(names, ["a", "b", "c"]);
        let path = circuit.templates[0].path.to_string_lossy();
        assert!(path.ends_with("merged.h5#a"), "{path}");
    }
}

#[neurotess_testing::test]
fn files_that_are_no_containers_are_errors_said_once() {
    let group: Group = |group| axes(group, &["x", "y", "z"]);
    let types = "node_type_id morphology\n100 a\n";
    let cases = [
        ("m/empty.h5", "(none is in it): correct the configuration"),
        ("m/single.h5", "(it is one morphology itself)"),
        ("m/cell.swc", "(not HDF5: "),
    ];
    for (file, expected) in cases {
        let components = format!(r#""morphologies_dir": "{file}""#);
        let folder = folder(&components, types, &[100; 2], &[group]);
        container(&folder.path().join("m/empty.h5"), &[]);
        let mut single = FileBuilder::new();
        for (name, columns) in [("points", 4), ("structure", 3)] {
            let rows = single.create_dataset(name);
            rows.with_f64_data(&vec![0.0; columns as usize])
                .with_shape(&[1, columns]);
        }
        let bytes = single.finish().expect("bytes");
        fs::write(folder.path().join("m/single.h5"), bytes).expect("written");
        let circuit = Circuit::open(folder.path()).expect("a circuit");
        assert_eq!((circuit.n_shown(), circuit.failures.len()), (0, 1));
        let said = circuit.failures[0].to_string();
        assert!(said.contains(expected) && said.contains(file), "{said}");
        assert_eq!(warned(&circuit), [("morphology_missing", 2)]);
    }
}

#[neurotess_testing::test]
fn a_simulation_without_a_circuit_is_of_the_one_beside_it() {
    let folder = folder(
        SWC,
        TYPES,
        &[100, 100],
        &[|group| axes(group, &["x", "y", "z"])],
    );
    let simulation = folder.path().join("mine.json");
    fs::write(&simulation, r#"{"run": {"tstop": 1, "dt": 0.1}}"#).expect("written");
    let shown = || Circuit::open(&simulation).map(|circuit| circuit.n_shown());
    assert_eq!(shown().expect("a circuit"), 2);
    let [from, to] = ["circuit_config.json", "circuit_sonata.json"];
    fs::rename(folder.path().join(from), folder.path().join(to)).expect("renamed");
    assert_eq!(shown().expect("a circuit"), 2);
    fs::remove_file(folder.path().join(to)).expect("removed");
    let error = shown().expect_err("none is there").to_string();
    assert!(
        error.contains("circuit_config.json: cannot be read"),
        "{error}"
    );
}

#[neurotess_testing::test]
fn ids_of_several_populations_are_told_apart() {
    let place: Group = |group| table(group, "positions", 3, &[0.0, 0.0, 0.0, 9.0, 0.0, 0.0]);
    let mut circuit = open(&folder(SWC, TYPES, &[100, 100], &[place]));
    let mut other = circuit.populations[0].clone();
    other.name = "q".into();
    circuit.populations.push(other);
    let of = |ids: Option<Vec<(u64, u64)>>, population: Option<&str>| Selection {
        ids,
        population: population.map(str::to_owned),
        ..Selection::default()
    };
    let count = |circuit: &Circuit, selection: &Selection| {
        circuit.select(selection).map(|nodes| nodes.len())
    };
    assert_eq!(count(&circuit, &of(None, None)).expect("all"), 4);
    assert_eq!(
        count(&circuit, &of(Some(vec![(1, 1)]), Some("q"))).expect("one"),
        1
    );
    let error = circuit
        .select(&of(Some(vec![(1, 5)]), None))
        .expect_err("which?");
    let expected = "populations 'p' and 'q' both have a node 1: name the population, too";
    assert!(error.to_string().contains(expected), "{error}");
    // Nodes without a morphology are none that somebody means.
    circuit.populations[1].templates = vec![None; 2];
    assert_eq!(
        count(&circuit, &of(Some(vec![(1, 1)]), None)).expect("both"),
        2
    );
}

/// Groups as bmtk's builder writes them: some nodes have quaternions, others angles.
#[neurotess_testing::test]
fn each_group_turns_by_its_own_columns() {
    use std::f64::consts::FRAC_PI_2;
    let quaternions: Group = |group| {
        let half = 0.5_f64.sqrt();
        for (name, value) in [("w", half), ("x", 0.0), ("y", 0.0), ("z", half)] {
            let name = format!("orientation_{name}");
            group.create_dataset(&name).with_f64_data(&[value; 2]);
        }
    };
    let angles: Group = |group| {
        let angles = [FRAC_PI_2; 2];
        group
            .create_dataset("rotation_angle_yaxis")
            .with_f64_data(&angles);
    };
    let both: Group = |group| {
        for (name, value) in [("w", 1.0), ("x", 0.0), ("y", 0.0), ("z", 0.0)] {
            let name = format!("orientation_{name}");
            group.create_dataset(&name).with_f64_data(&[value; 2]);
        }
        group
            .create_dataset("rotation_angle_zaxis")
            .with_f64_data(&[1.0; 2]);
    };
    for order in [[quaternions, angles, both], [angles, both, quaternions]] {
        let folder = folder(SWC, TYPES, &[100; 6], &order);
        let circuit = open(&folder);
        let turned: Vec<DVec3> = circuit.populations[0]
            .rotations
            .iter()
            .map(|rotation| *rotation * DVec3::new(1.0, 0.0, 0.0))
            .collect();
        let expected = |group: Group| {
            if std::ptr::fn_addr_eq(group, quaternions) {
                DVec3::Y
            } else if std::ptr::fn_addr_eq(group, angles) {
                DVec3::NEG_Z
            } else {
                DVec3::X
            }
        };
        for (pair, group) in turned.chunks(2).zip(order) {
            for place in pair {
                assert!(place.distance(expected(group)) < 1e-12, "{place}");
            }
        }
    }
}

/// A circuit of nodes 0 and 1 with a simulation that has a compartment set, and a report of it: sections 1 and 1 of node 0,
/// 1 of node 1.
fn with_compartment_set(sets: &str) -> TempDir {
    let place: Group = |group| {
        for axis in ["x", "y", "z"] {
            group.create_dataset(axis).with_f64_data(&[0.0; 2]);
        }
    };
    let folder = folder(SWC, TYPES, &[100; 2], &[place]);
    let mut file = FileBuilder::new();
    let mut report = file.create_group("report");
    let mut population = report.create_group("p");
    population
        .create_dataset("data")
        .with_f32_data(&[1.0, 2.0, 3.0])
        .with_shape(&[1, 3]);
    let mut mapping = population.create_group("mapping");
    mapping.create_dataset("node_ids").with_u64_data(&[0, 1]);
    mapping
        .create_dataset("index_pointers")
        .with_u64_data(&[0, 2, 3]);
    mapping
        .create_dataset("element_ids")
        .with_u64_data(&[1, 1, 1]);
    mapping
        .create_dataset("time")
        .with_f64_data(&[0.0, 1.0, 1.0]);
    population.add_group(mapping.finish());
    report.add_group(population.finish());
    file.add_group(report.finish());
    let write =
        |name: &str, content: &[u8]| fs::write(folder.path().join(name), content).expect("written");
    write("v.h5", &file.finish().expect("bytes"));
    write("sets.json", sets.as_bytes());
    write(
        "simulation_config.json",
        br#"{"network": "circuit_config.json", "run": {}, "compartment_sets_file": "sets.json",
            "output": {"output_dir": "."},
            "reports": {"v": {"type": "compartment_set", "compartment_set": "some"}}}"#,
    );
    folder
}

const SOME: &str = r#"{"some": {"population": "p", "compartment_set": [[0, 1, 0.1], [0, 1, 0.9], [1, 1, 0.2]]},
                       "one": {"population": "p", "compartment_set": [[1, 0, 0.5]]}}"#;

#[neurotess_testing::test]
fn compartment_sets_select_nodes_and_place_reports() {
    use neurotess_circuit::{NodeRef, RecordingFile};
    let folder = with_compartment_set(SOME);
    let circuit = open(&folder);
    let lost = |w: &&neurotess_circuit::Warning| w.code.starts_with("compartment");
    assert_eq!(circuit.warnings.iter().find(lost), None);
    assert_eq!(circuit.compartment_sets["some"].of_node(1)[0].offset, 0.2);
    let of = |name: &str| {
        let selection = Selection {
            node_set: Some(name.into()),
            ..Selection::default()
        };
        circuit.select(&selection)
    };
    let second = NodeRef {
        population: 0,
        row: 1,
    };
    assert_eq!(of("one").expect("a set"), [second]);
    assert_eq!(of("some").expect("a set").len(), 2);
    assert!(
        of("none")
            .expect_err("no set")
            .to_string()
            .contains("one, some")
    );
    let opened = circuit.open_recording(Path::new("v")).expect("a report");
    let RecordingFile::Report(report) = opened else {
        panic!("no report");
    };
    let along = |row| {
        let all = report.populations[0]
            .compartments(row)
            .expect("compartments");
        all.iter().map(|c| c.along).collect::<Vec<f32>>()
    };
    assert_eq!((along(0), along(1)), (vec![0.1, 0.9], vec![0.2]));
}

#[neurotess_testing::test]
fn what_compartment_sets_name_in_vain_is_told() {
    let codes = |sets: &str| {
        let folder = with_compartment_set(sets);
        let circuit = Circuit::open(folder.path()).expect("a circuit");
        let failures = circuit.failures.iter().map(ToString::to_string);
        let told = circuit
            .warnings
            .iter()
            .filter(|w| w.code.starts_with("compartment"));
        let told = told.map(|w| format!("{} {}", w.code, w.count));
        failures.chain(told).collect::<Vec<_>>()
    };
    assert_eq!(codes(SOME), Vec::<String>::new());
    let lost = SOME.replace("[[1, 0, 0.5]]", "[[1, 0, 0.5], [7, 0, 0.5], [9, 1, 0.5]]");
    assert_eq!(codes(&lost), ["compartment_set_nodes 2"]);
    let other = SOME.replacen(r#""population": "p""#, r#""population": "q""#, 1);
    assert_eq!(codes(&other), ["compartment_set_population 1"]);
    assert_eq!(codes("{}"), ["compartment_set_unknown 1"]);
    for (from, to, says) in [
        (
            "[0, 1, 0.9]",
            "[0, 1, 1.5]",
            "'some.compartment_set[1][2]': is 1.5 instead of an offset from 0 to 1",
        ),
        (
            "[0, 1, 0.9]",
            "[0, 1, 0.1]",
            "places ascend, and none is there twice",
        ),
        (
            "[0, 1, 0.9]",
            "[0, -1, 0.9]",
            "'some.compartment_set[1][1]'",
        ),
        (
            "[0, 1, 0.9]",
            "[0, 1]",
            "a list of node, section and offset",
        ),
    ] {
        let found = codes(&SOME.replace(from, to));
        assert!(found[0].contains(says), "{found:?}");
    }
    let folder = with_compartment_set(SOME);
    fs::remove_file(folder.path().join("sets.json")).expect("removed");
    let circuit = open(&folder);
    assert!(
        circuit
            .warnings
            .iter()
            .any(|w| w.code == "compartment_sets_missing")
    );
}
