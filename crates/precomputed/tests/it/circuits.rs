//! Circuits: segments, places, properties and synapses.

use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

use neurotess_circuit::{Circuit, Synapses, write};
use neurotess_formats::swc;
use neurotess_precomputed::{Export, ExportReport};
use neurotess_synth::circuit as synth;
use serde_json::Value;

use crate::{Folders, coarse};

/// A circuit of cells with two tracings, and two synapses onto each, in a folder.
fn circuit(folder: &Path, neurons: usize) -> (Circuit, Synapses) {
    let made = synth::circuit(&synth::CircuitOptions {
        neurons,
        morphologies: 2,
        seed: 1,
        points: Some(60),
        may_cross: false,
        reported: 1,
    });
    fs::create_dir_all(folder.join("morphologies")).expect("made");
    let file = |name: &str| File::create(folder.join(name)).expect("begun");
    let cells = made.morphologies.iter();
    let grown: Vec<_> = cells
        .map(|cell| neurotess_synth::grow(&cell.options))
        .collect();
    for (cell, morphology) in made.morphologies.iter().zip(&grown) {
        let to = file(&format!("morphologies/{}.swc", cell.name));
        swc::write(morphology, to).expect("written");
    }
    let all = synth::synapses(&made, &grown, 2, 1);
    let populations = std::slice::from_ref(&made.population);
    write::nodes(populations, file("nodes.h5")).expect("written");
    let ends = [synth::POPULATION; 2];
    let delays = [("delay", all.delays.clone())];
    write::edges(synth::EDGES, ends, &all.synapses, &delays, file("edges.h5")).expect("written");
    let json = |name: &str, value: &Value| {
        fs::write(folder.join(name), value.to_string()).expect("written");
    };
    json(
        "node_sets.json",
        &synth::node_sets(&made.population, &made.reported),
    );
    json(synth::CIRCUIT, &synth::circuit_config(true));
    let opened = Circuit::open(folder.join(synth::CIRCUIT)).expect("opened");
    (opened, all.synapses)
}

fn json(folders: &Folders, name: &str) -> Value {
    let text = fs::read(folders.path(name)).expect("there");
    serde_json::from_slice(&text).expect("JSON")
}

/// Cells that are in several shards.
pub(crate) fn many(folders: &Folders) -> Export {
    let (circuit, _) = circuit(&folders.path("circuit"), 520);
    let nodes = circuit
        .select(&neurotess_circuit::Selection::default())
        .expect("all");
    let instances = circuit.instances(&nodes, None);
    Export::of_circuit(Arc::new(circuit), instances)
        .levels(coarse())
        .sharded(true)
}

fn export(folders: &Folders) -> (ExportReport, Synapses) {
    let (circuit, synapses) = circuit(&folders.path("circuit"), 12);
    let nodes = circuit
        .select(&neurotess_circuit::Selection::default())
        .expect("all");
    let instances = circuit.instances(&nodes, None);
    let edges = circuit.edges.clone();
    let export = Export::of_circuit(Arc::new(circuit), instances);
    let export = export.into(folders.path("out")).levels(coarse());
    let report = export.color_by("layer").synapses(edges).run(|_| ());
    (report.expect("written"), synapses)
}

#[neurotess_testing::test]
fn cells_of_a_circuit_have_their_nodes_ids_places_and_attributes() {
    let folders = Folders::with(0);
    let (report, _) = export(&folders);
    assert_eq!((report.written, report.failures.len()), (12, 0));
    let properties = json(&folders, "out/properties/info");
    let inline = &properties["inline"];
    // The node's id and 1: 0 is no segment.
    assert_eq!(inline["ids"][0], "1");
    assert_eq!(inline["ids"][11], "12");
    let columns = inline["properties"].as_array().expect("a list");
    let column = |id: &str| {
        columns
            .iter()
            .find(|column| column["id"] == id)
            .expect("there")
    };
    assert_eq!(column("label")["values"][3], "cortex 3");
    assert_eq!(column("node_id")["values"][3], 3);
    let tags = column("tags")["tags"].as_array().expect("a list");
    for word in ["axon", "cortex", "L2/3", "soma"] {
        assert!(tags.iter().any(|tag| tag == word), "{word}: {tags:?}");
    }
    assert!(
        tags.iter()
            .all(|tag| !tag.as_str().unwrap_or(" ").contains(' '))
    );
    let view = json(&folders, "out/view.json");
    assert_eq!(
        view["layers"][0]["segments"].as_array().map(Vec::len),
        Some(12)
    );
    assert!(view["layers"][0]["segmentColors"]["1"].is_string());
    // Two cells of one tracing are at different places, and so are their skeletons.
    let skeletons = ["1", "3"].map(|id| fs::read(folders.path(&format!("out/skeletons/{id}"))));
    let [first, third] = skeletons.map(|bytes| bytes.expect("there"));
    assert!(first.len() == third.len() && first[8..20] != third[8..20]);
}

#[neurotess_testing::test]
fn synapses_are_found_by_the_cells_behind_them() {
    let folders = Folders::with(0);
    let (report, synapses) = export(&folders);
    assert_eq!(report.synapses, synapses.targets.len());
    let info = json(&folders, "out/synapses/info");
    let names: Vec<&str> = info["properties"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|property| property["id"].as_str())
        .collect();
    assert_eq!(names, ["delay", "edges"]);
    assert_eq!(info["relationships"][1]["id"], "post");
    // All of them are in one cell of the grid: number, points of 20 bytes, ids.
    let bytes = fs::read(folders.path("out/synapses/place0/0_0_0")).expect("there");
    let count = synapses.targets.len();
    assert_eq!(bytes.len(), 8 + 28 * count);
    let id = u64::from_le_bytes(bytes[8 + 20 * count..][..8].try_into().expect("eight")) as usize;
    let x = f32::from_le_bytes(bytes[8..12].try_into().expect("four"));
    assert_eq!(x, (synapses.positions[id - 1].x * 1000.0) as f32);
    let view = json(&folders, "out/view.json");
    assert_eq!(view["layers"][2]["type"], "annotation");
    for key in ["by_id", "pre", "post"] {
        assert!(
            folders
                .path(&format!("out/synapses/{key}/0.shard"))
                .is_file()
        );
    }
}
