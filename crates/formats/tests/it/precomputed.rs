//! Skeletons of neuroglancer's precomputed data, in files of their own and in shards.

use std::fs;
use std::io::Write;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use glam::DVec3;
use neurotess_formats::precomputed::{Skeletons, murmur};
use neurotess_formats::{Read, ReadOptions, read};
use serde_json::{Value, json};

/// Stored positions, edges, and the bytes of attributes.
fn skeleton(positions: &[[f32; 3]], edges: &[[u32; 2]], attributes: &[u8]) -> Vec<u8> {
    let counts = [positions.len(), edges.len()].map(|n| (n as u32).to_le_bytes());
    let positions = positions
        .as_flattened()
        .iter()
        .flat_map(|n| n.to_le_bytes());
    let edges = edges.as_flattened().iter().flat_map(|n| n.to_le_bytes());
    let counts = counts.as_flattened().iter().copied();
    counts
        .chain(positions)
        .chain(edges)
        .chain(attributes.iter().copied())
        .collect()
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

fn info(attributes: &Value) -> Value {
    json!({ "@type": "neuroglancer_skeletons", "vertex_attributes": attributes })
}

fn write_info(folder: &Path, info: &Value) {
    fs::write(folder.join("info"), info.to_string()).expect("written");
}

fn read_of(path: &Path) -> Read {
    read(path, &ReadOptions::default()).expect("read")
}

fn said(path: &Path) -> String {
    let read = read(path, &ReadOptions::default());
    read.expect_err("it is broken").to_string()
}

const RADIUS: &str = r#"{ "id": "radius", "data_type": "float32", "num_components": 1 }"#;

/// A fork of four points; edges of all directions.
const POSITIONS: [[f32; 3]; 4] = [
    [0., 0., 0.],
    [1000., 0., 0.],
    [2000., 1000., 0.],
    [2000., -1000., 0.],
];
const EDGES: [[u32; 2]; 3] = [[0, 1], [2, 1], [1, 3]];

#[neurotess_testing::test]
fn edges_of_any_direction_are_one_tree_in_micrometers() {
    let folder = tempfile::tempdir().expect("a folder");
    let types = json!({ "id": "vertex_types", "data_type": "uint8", "num_components": 1 });
    let radius: Value = serde_json::from_str(RADIUS).expect("JSON");
    write_info(folder.path(), &info(&json!([types, radius])));
    let attributes = [vec![2, 2, 3, 3], floats(&[100., 200., 300., -1.])].concat();
    let path = folder.path().join("17");
    fs::write(&path, skeleton(&POSITIONS, &EDGES, &attributes)).expect("written");
    let Read {
        morphology,
        format,
        warnings,
    } = read_of(&path);
    let codes: Vec<&str> = warnings.iter().map(|warning| warning.code).collect();
    assert_eq!((format, &morphology.name[..]), ("precomputed", "17"));
    assert_eq!(codes, ["no_soma", "zero_radius"]);
    assert_eq!((morphology.points.len(), morphology.sections.len()), (4, 3));
    let radii: Vec<f32> = morphology.points.iter().map(|point| point.radius).collect();
    assert_eq!(radii, [0.1, 0.2, 0.3, 0.0]);
    let kinds: Vec<i32> = morphology
        .sections
        .iter()
        .map(|section| section.kind.0)
        .collect();
    assert_eq!(kinds, [2, 3, 3]);
    let place = morphology.origin + morphology.points[2].position.as_dvec3();
    assert!(place.distance(DVec3::new(2.0, 1.0, 0.0)) < 1e-6, "{place}");
    assert_eq!(morphology.sample_ids, [1, 2, 3, 4]);
    // As cloud-volume packs it.
    fs::write(
        folder.path().join("18.gz"),
        gzip(&fs::read(&path).expect("there")),
    )
    .expect("written");
    assert_eq!(
        read_of(&folder.path().join("18")).morphology.points,
        morphology.points
    );
    let opened = Skeletons::open(folder.path())
        .expect("read")
        .expect("skeletons");
    assert_eq!(opened.ids().expect("read"), [17, 18]);
}

#[neurotess_testing::test]
fn the_transform_is_of_positions_and_loops_are_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let radius: Value = serde_json::from_str(RADIUS).expect("JSON");
    let mut told = info(&json!([radius]));
    told["transform"] = json!([4, 0, 0, 100, 0, 4, 0, 0, 0, 0, 40, 0]);
    write_info(folder.path(), &told);
    let edges = [&EDGES[..], &[[2, 3]]].concat();
    let path = folder.path().join("1");
    fs::write(&path, skeleton(&POSITIONS, &edges, &floats(&[100.; 4]))).expect("written");
    let read = read_of(&path);
    let codes: Vec<&str> = read.warnings.iter().map(|warning| warning.code).collect();
    assert_eq!(codes, ["radius_unit", "loops_left_out", "no_soma"]);
    let cell = read.morphology;
    let place = cell.origin + cell.points[1].position.as_dvec3();
    assert!(place.distance(DVec3::new(4.1, 0.0, 0.0)) < 1e-6, "{place}");
    assert_eq!((cell.points[1].radius, cell.points.len()), (0.1, 4));
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packing = GzEncoder::new(Vec::new(), Compression::default());
    packing.write_all(bytes).expect("memory takes it");
    packing.finish().expect("memory takes it")
}

/// Two shards of two minishards each.
fn write_shards(folder: &Path, objects: &[(u64, Vec<u8>)]) {
    for shard in 0..2_u64 {
        let (mut index, mut data) = (Vec::new(), Vec::new());
        let mut indices = Vec::new();
        for minishard in 0..2_u64 {
            let mut rows = [Vec::new(), Vec::new(), Vec::new()];
            let (mut last, mut end) = (0_u64, 0_u64);
            for (id, object) in objects {
                let hash = murmur(&id.to_le_bytes());
                if (hash >> 1 & 1, hash & 1) == (shard, minishard) {
                    let packed = gzip(object);
                    rows[0].push(id.wrapping_sub(last));
                    rows[1].push(data.len() as u64 - end);
                    rows[2].push(packed.len() as u64);
                    data.extend(packed);
                    (last, end) = (*id, data.len() as u64);
                }
            }
            let rows: Vec<u8> = rows
                .concat()
                .into_iter()
                .flat_map(u64::to_le_bytes)
                .collect();
            indices.push(gzip(&rows));
        }
        let mut at = data.len() as u64;
        for packed in &indices {
            index.extend(at.to_le_bytes());
            at += packed.len() as u64;
            index.extend(at.to_le_bytes());
        }
        let file = [index, data, indices.concat()].concat();
        fs::write(folder.join(format!("{shard}.shard")), file).expect("written");
    }
}

#[neurotess_testing::test]
fn shards_hold_skeletons_by_ids_of_any_size() {
    let folder = tempfile::tempdir().expect("a folder");
    let skeletons = folder.path().join("sk");
    fs::create_dir(&skeletons).expect("a folder");
    let mut told = info(&json!([]));
    told["sharding"] = json!({
        "@type": "neuroglancer_uint64_sharded_v1", "preshift_bits": 0, "hash": "murmurhash3_x86_128",
        "minishard_bits": 1, "shard_bits": 1, "minishard_index_encoding": "gzip", "data_encoding": "gzip",
    });
    write_info(&skeletons, &told);
    // A segmentation names the folder below it.
    write_info(
        folder.path(),
        &json!({ "@type": "neuroglancer_multiscale_volume", "skeletons": "sk" }),
    );
    let ids = [3, 7, 90, 91, 720_575_940_623_456_789];
    let object = |id: u64| skeleton(&[[0., 0., 0.], [id as f32, 0., 0.]], &[[0, 1]], &[]);
    write_shards(&skeletons, &ids.map(|id| (id, object(id))));
    let opened = Skeletons::open(folder.path())
        .expect("read")
        .expect("skeletons");
    assert_eq!(opened.ids().expect("read"), ids);
    assert_eq!(opened.folder(), skeletons);
    for id in ids {
        let cell = read_of(&skeletons.join(id.to_string())).morphology;
        let length = cell.points[1].position.x - cell.points[0].position.x;
        assert!(
            (length - id as f32 * 1e-3).abs() <= 1e-6 * length,
            "{id}: {length}"
        );
    }
    let missing = said(&skeletons.join("4"));
    assert!(
        missing.ends_with(
            "no shard has skeleton 4: check the id, and whether all shards were fetched"
        ),
        "{missing}"
    );
}

#[neurotess_testing::test]
fn what_is_broken_names_the_file_and_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    assert!(Skeletons::open(folder.path()).expect("no info").is_none());
    write_info(
        folder.path(),
        &json!({ "@type": "neuroglancer_legacy_mesh" }),
    );
    assert!(Skeletons::open(folder.path()).expect("another").is_none());
    write_info(folder.path(), &info(&json!([])));
    let whole = skeleton(&POSITIONS, &EDGES, &[]);
    for cut in 0..whole.len() {
        fs::write(at("1"), &whole[..cut]).expect("written");
        assert!(said(&at("1")).contains("/1: "), "{cut}");
    }
    // What a count declares is not made.
    let huge = [u32::MAX.to_le_bytes(), 0_u32.to_le_bytes()].concat();
    fs::write(at("1"), huge).expect("written");
    assert!(
        said(&at("1")).contains("4294967295 vertices"),
        "{}",
        said(&at("1"))
    );
    fs::write(at("1"), skeleton(&POSITIONS, &[[0, 4]], &[])).expect("written");
    assert!(said(&at("1")).contains("names node 4"));
    fs::write(at("1"), skeleton(&[[f32::NAN; 3]], &[], &[])).expect("written");
    assert!(
        said(&at("1")).contains("out of range"),
        "{}",
        said(&at("1"))
    );
    fs::write(at("1"), skeleton(&[], &[], &[])).expect("written");
    assert!(said(&at("1")).contains("no sample"));
    for (key, value) in [
        ("transform", json!([1, 2])),
        (
            "sharding",
            json!({ "preshift_bits": 0, "hash": "crc", "minishard_bits": 1, "shard_bits": 1 }),
        ),
        (
            "sharding",
            json!({ "preshift_bits": 0, "hash": "identity", "minishard_bits": 60, "shard_bits": 1 }),
        ),
        (
            "vertex_attributes",
            json!([{ "id": "radius", "data_type": "float64", "num_components": 1 }]),
        ),
    ] {
        let mut told = info(&json!([]));
        told[key] = value;
        write_info(folder.path(), &told);
        let told = said(&at("1"));
        assert!(
            told.contains("info: the precomputed skeletons are not what they should be"),
            "{told}"
        );
    }
}
