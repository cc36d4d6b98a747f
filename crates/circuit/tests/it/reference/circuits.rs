//! Circuits of others against values that h5py and bluepysnap give.

use std::path::Path;

use glam::{DMat3, DVec3};
use neurotess_circuit::{Attribute, Circuit, Selection, soma_center};
use neurotess_testing::shared;
use serde_json::Value;

use super::sonata::sonata;

/// Circuits, each with its file of nodes in the reference.
const CIRCUITS: [(&str, &str, &str); 3] = [
    ("bbp/usecase1", "sonata/bbp/usecase1/nodes.h5", "nodeA"),
    (
        "brion/simple_network.json",
        "sonata/brion/simple_nodes.h5",
        "simple",
    ),
    (
        "allen/5_cells_iclamp",
        "sonata/allen/5_cells_iclamp/network/biophysical_nodes.h5",
        "biophysical",
    ),
];

fn reference(sonata: &Path) -> Value {
    let path = sonata.with_file_name("sonata_reference.json");
    let text = std::fs::read_to_string(path).expect("the reference");
    serde_json::from_str(&text).expect("JSON")
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|axis: usize| value[axis].as_f64().expect("a number")))
}

#[neurotess_testing::test(needs(shared))]
fn nodes_have_the_positions_rotations_and_morphologies_of_the_reference() {
    let sonata = sonata();
    let reference = reference(&sonata);
    for (circuit, file, population) in CIRCUITS {
        let circuit = Circuit::open(sonata.join(circuit)).expect("a circuit");
        let expected = &reference[file][format!("nodes:{population}")];
        assert_eq!(circuit.populations.len(), 1, "{file}");
        let found = &circuit.populations[0];
        assert_eq!(found.name, population);
        assert_eq!(found.len() as u64, expected["n"].as_u64().expect("n"));
        for node in expected["nodes"].as_array().expect("nodes") {
            let row = node["index"].as_u64().expect("index") as usize;
            assert_eq!(Some(found.ids[row]), node["node_id"].as_u64());
            match node.get("xyz") {
                Some(position) => {
                    let position = vector(position);
                    assert!(found.position(row).expect("a position").distance(position) < 1e-9);
                }
                None => assert_eq!(found.position(row), None, "{file} {row}"),
            }
            let rows = &node["rotation_3x3_row_major"];
            let expected = DMat3::from_cols(vector(&rows[0]), vector(&rows[1]), vector(&rows[2]));
            let rotation = DMat3::from_quat(found.rotations[row]).transpose();
            assert!(
                rotation.abs_diff_eq(expected, 1e-6),
                "{file} {row}: {rotation} {expected}"
            );
            let morphology = found.attributes.get("morphology");
            let name = morphology.and_then(|attribute| attribute.text(row));
            assert_eq!(name, node["morphology"].as_str(), "{file} {row}");
        }
    }
}

#[neurotess_testing::test(needs(shared))]
fn a_blue_brain_circuit_opens_whole() {
    let sonata = sonata();
    let circuit = Circuit::open(sonata.join("bbp/usecase1")).expect("a circuit");
    assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
    assert_eq!((circuit.n_neurons(), circuit.templates.len()), (2, 1));
    let nodes = &circuit.populations[0];
    assert_eq!(nodes.kind, "biophysical");
    assert_eq!(nodes.attributes["etype"].text(1), Some("dSTUT"));
    let edges = &circuit.edges[0];
    assert_eq!((edges.count, edges.source.as_str()), (4, "nodeA"));
    let synapses = edges.synapses().expect("synapses");
    assert_eq!(
        (&synapses.sources[..], &synapses.targets[..]),
        (&[0, 0, 1, 1][..], &[1, 1, 0, 0][..])
    );
    assert!(synapses.positions[0].distance(DVec3::new(446.03, 98.8763, 302.396)) < 1e-3);
    let reports: Vec<&String> = circuit.reports.keys().collect();
    assert_eq!(reports, ["compartment_report", "soma_report", "spikes"]);

    let all = circuit.select(&Selection::default()).expect("all");
    let instances = circuit.instances(&all, None);
    assert!(!circuit.templates[0].is_read());
    let read = circuit.templates[0].read().expect("a morphology");
    let center = soma_center(&read.morphology);
    let placed = instances[1]
        .world_from_cell(center)
        .transform_point3(center);
    assert!(placed.distance(nodes.positions[1]) < 1e-9);
}

#[neurotess_testing::test(needs(shared))]
fn types_give_what_nodes_do_not_have() {
    let sonata = sonata();
    let circuit = Circuit::open(sonata.join("allen/5_cells_iclamp")).expect("a circuit");
    assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
    assert_eq!((circuit.n_neurons(), circuit.templates.len()), (5, 5));
    let ei = &circuit.populations[0].attributes["ei"];
    assert_eq!([0, 3].map(|row| ei.text(row)), [Some("e"), Some("i")]);
    let selection = Selection {
        node_set: Some("biophys_cells".into()),
        region: Some((DVec3::splat(-1.0), DVec3::new(1.0, 300.0, 1.0))),
        ..Selection::default()
    };
    let selected = circuit.select(&selection).expect("selected");
    assert_eq!(selected.iter().map(|n| n.row).collect::<Vec<_>>(), [0, 3]);
    for template in &circuit.templates {
        let read = template.read().expect("a morphology");
        // Their somata are not at the origin: the first step of placing moves them there.
        let center = soma_center(&read.morphology);
        let all = circuit.select(&Selection::default()).expect("all");
        for instance in circuit.instances(&all, None) {
            let moved = instance.world_from_cell(center).transform_point3(center);
            assert!(moved.distance(instance.position) < 1e-9);
        }
    }
}

#[neurotess_testing::test(needs(shared))]
fn groups_that_lack_what_others_have_are_read() {
    let sonata = sonata();
    let circuit = Circuit::open(sonata.join("brion/simple_network.json")).expect("a circuit");
    let nodes = &circuit.populations[0];
    // Rows of group 1 override the type's model.
    let models: Vec<_> = (0..4)
        .map(|row| nodes.attributes["model_type"].text(row))
        .collect();
    assert_eq!(
        models,
        [
            Some("biophysical"),
            Some("virtual"),
            Some("biophysical"),
            Some("virtual")
        ]
    );
    assert!(matches!(nodes.attributes["mtype"], Attribute::Text { .. }));
    // morph_B, C and D are not there; the nodes of morph_A show.
    let missing = circuit
        .warnings
        .iter()
        .find(|w| w.code == "morphology_missing");
    assert_eq!(missing.map(|w| w.count), Some(7));
    assert_eq!(circuit.n_shown(), 3);
    assert!(
        circuit
            .warnings
            .iter()
            .any(|w| w.code == "node_id_repeated")
    );
    // Its edges, node sets and reports are not there, and warnings say so.
    assert!(circuit.failures.is_empty(), "{:?}", circuit.failures);
    let missing = |code| circuit.warnings.iter().filter(|w| w.code == code).count();
    let counts = ["edges_missing", "node_sets_missing", "report_missing"].map(missing);
    assert_eq!(counts, [1, 1, 4]);
}
