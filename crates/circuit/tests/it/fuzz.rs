//! Whatever is in a file, opening it ends with a circuit or an error.
//!
//! `PROPTEST_CASES=100000 cargo test -p neurotess-circuit --test it fuzz` fuzzes longer.

use std::fs;
use std::path::Path;

use hdf5_pure::FileBuilder;
use neurotess_circuit::{Circuit, NodeSets, Report, Selection};
use proptest::prelude::*;

/// Text that configurations are made of, so that random ones reach deep.
const KEYS: [&str; 14] = [
    "manifest",
    "$A",
    "$B",
    "networks",
    "nodes",
    "edges",
    "nodes_file",
    "node_types_file",
    "populations",
    "components",
    "morphologies_dir",
    "node_sets_file",
    "alternate_morphologies",
    "network",
];
const VALUES: [&str; 8] = ["$A", "$B/x", "${A}", ".", "nodes.h5", "a.json", "$", "${"];

fn json() -> impl Strategy<Value = serde_json::Value> {
    let leaf = prop_oneof![
        Just(serde_json::Value::Null),
        any::<bool>().prop_map(Into::into),
        any::<f64>().prop_map(Into::into),
        prop::sample::select(&VALUES[..]).prop_map(Into::into),
    ];
    leaf.prop_recursive(6, 48, 6, |inner| {
        let key = prop::sample::select(&KEYS[..]).prop_map(str::to_owned);
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..4).prop_map(Into::into),
            prop::collection::vec((key, inner), 0..6)
                .prop_map(|entries| serde_json::Value::Object(entries.into_iter().collect())),
        ]
    })
}

fn open(folder: &Path, name: &str, bytes: &[u8]) {
    let path = folder.join(name);
    fs::write(&path, bytes).expect("written");
    if let Ok(circuit) = Circuit::open(&path) {
        let nodes = circuit.select(&Selection::default()).expect("all");
        circuit.instances(&nodes, None);
        let names: Vec<String> = circuit.node_sets.names().map(str::to_owned).collect();
        for node_set in names {
            let node_set = Some(node_set);
            // Errors are fine.
            circuit
                .select(&Selection {
                    node_set,
                    ..Selection::default()
                })
                .ok();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    #[neurotess_testing::test]
    fn any_configuration_ends(json in json()) {
        let folder = tempfile::tempdir().expect("a folder");
        open(folder.path(), "a.json", json.to_string().as_bytes());
    }

    #[neurotess_testing::test]
    fn any_manifest_ends(values in prop::collection::vec("[$A-D{}/x]{0,8}", 4), path in "[$A-D{}/]{0,9}") {
        let folder = tempfile::tempdir().expect("a folder");
        let names = ["$A", "$B", "C", "${D}"];
        let manifest: serde_json::Map<_, _> =
            names.iter().zip(values).map(|(n, v)| ((*n).into(), v.into())).collect();
        let config = serde_json::json!({"manifest": manifest,
            "networks": {"nodes": [{"nodes_file": path}]}});
        open(folder.path(), "a.json", config.to_string().as_bytes());
    }

    #[neurotess_testing::test]
    fn any_scene_ends(text in "(\\[\\[cells\\]\\]|\\n|file|position|matrix|=|\"|\\[|\\]|,|[0-9.]|nan|color|#|quaternion| ){0,60}") {
        let folder = tempfile::tempdir().expect("a folder");
        open(folder.path(), "a.scene.toml", text.as_bytes());
        open(folder.path(), "a.scene.json", text.as_bytes());
    }

    #[neurotess_testing::test]
    fn any_xml_ends(text in "(<scene>|<column id=\"|<neuron gid=\"|<transform>|</|/>|\"|>|[0-9,. ]|swc=|neurons=|<neuronmorphology ){0,60}") {
        let folder = tempfile::tempdir().expect("a folder");
        open(folder.path(), "a.xml", text.as_bytes());
    }

    #[neurotess_testing::test]
    fn any_mapping_ends(
        nodes in prop::collection::vec(0u64..9, 0..5),
        pointers in prop::collection::vec(prop_oneof![0u64..12, any::<u64>()], 0..7),
        compartment_ids in prop::collection::vec(any::<u32>(), 0..13),
        positions in prop::option::of(prop::collection::vec(any::<f64>(), 0..13)),
        time in prop::collection::vec(any::<f64>(), 0..5),
        frames in 0u64..4,
        frame in any::<u64>(),
        chunk in prop::option::of((1u64..5, 1u64..8)),
    ) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("r.h5");
        let mut file = FileBuilder::new();
        let mut mapping = file.create_group("mapping");
        mapping.create_dataset("gids").with_u64_data(&nodes);
        mapping.create_dataset("index_pointer").with_u64_data(&pointers);
        mapping.create_dataset("element_id").with_u32_data(&compartment_ids);
        mapping.create_dataset("time").with_f64_data(&time);
        if let Some(positions) = &positions {
            mapping.create_dataset("element_pos").with_f64_data(positions);
        }
        file.add_group(mapping.finish());
        let columns = compartment_ids.len() as u64;
        let data: Vec<f32> = (0..frames * columns).map(|i| i as f32).collect();
        let dataset = file.create_dataset("data");
        dataset.with_f32_data(&data).with_shape(&[frames, columns]);
        if let Some((rows, wide)) = chunk.filter(|_| !data.is_empty()) {
            dataset.with_chunks(&[rows.min(frames), wide.min(columns)]).with_shuffle().with_deflate(1);
        }
        let Ok(bytes) = file.finish() else { return Ok(()) };
        fs::write(&path, bytes).expect("written");
        if let Ok(report) = Report::open(&path) {
            let values = &report.populations[0];
            for index in 0..values.nodes.len() {
                let asked_for: Vec<u64> = values.compartment_range(index).rev().collect();
                let compartments = values.compartments(index).expect("they are there");
                prop_assert_eq!(compartments.len(), asked_for.len());
                if frames > 0 {
                    let read = values.values(frame % frames, &asked_for).expect("they are there");
                    let expected: Vec<f32> =
                        asked_for.iter().map(|e| (frame % frames * columns + e) as f32).collect();
                    prop_assert_eq!(read, expected);
                }
            }
            prop_assert!(values.values(frames, &[]).is_err());
        }
    }

    #[neurotess_testing::test]
    fn flipped_bytes_end(at in any::<prop::sample::Index>(), byte in any::<u8>()) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("r.h5");
        let mut file = FileBuilder::new();
        let mut mapping = file.create_group("mapping");
        mapping.create_dataset("gids").with_u64_data(&[3, 4]);
        mapping.create_dataset("index_pointer").with_u64_data(&[0, 2]);
        mapping.create_dataset("element_id").with_u32_data(&[0, 1, 0, 1]);
        mapping.create_dataset("time").with_f64_data(&[0.0, 1.0, 0.5]);
        file.add_group(mapping.finish());
        let dataset = file.create_dataset("data");
        dataset.with_f32_data(&[1.0; 8]).with_shape(&[2, 4]).with_chunks(&[1, 2]).with_deflate(1);
        let mut bytes = file.finish().expect("bytes");
        let at = at.index(bytes.len());
        bytes[at] = byte;
        fs::write(&path, bytes).expect("written");
        if let Ok(report) = Report::open(&path) {
            let values = &report.populations[0];
            let all: Vec<u64> = (0..values.compartment_count().min(100)).collect();
            values.values(0, &all).ok();
        }
    }
}

#[neurotess_testing::test]
fn no_sets_are_no_names() {
    assert_eq!(NodeSets::default().names().count(), 0);
}
