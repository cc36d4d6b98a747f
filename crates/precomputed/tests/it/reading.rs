//! What is written is read again: meshes in one piece, and skeletons; and meshes of others.

use std::fs;
use std::path::Path;

use neurotess_formats::precomputed::Skeletons;
use neurotess_formats::{ReadOptions, read};
use neurotess_mesh::{SurfaceMesh, check};
use neurotess_morphology::shape;
use neurotess_precomputed::{LevelOptions, read_mesh};
use neurotess_testing::{shared, shared_data};
use serde_json::json;

use crate::Folders;
use crate::circuits::many;

fn mesh(path: &Path) -> SurfaceMesh {
    read_mesh(path).expect("a mesh").expect("read")
}

/// Short edges of real tracings collapse on the grid.
#[neurotess_testing::test(needs(shared))]
fn real_cells_are_closed() {
    let folders = Folders::with(0);
    let files = ["172993.swc", "IF4_140201.CNG.swc"];
    for file in files {
        let from = shared_data().join("swc").join(file);
        fs::copy(from, folders.path("in").join(file)).expect("copied");
    }
    folders.export("out").run(|_| ()).expect("written");
    for (id, file) in (1..).zip(files) {
        let report = check(&mesh(&folders.path(&format!("out/mesh/{id}"))));
        assert!(report.closed && report.edge_manifold, "{file}: {report:?}");
    }
}

fn length(path: &Path) -> f64 {
    let cell = read(path, &ReadOptions::default())
        .expect("read")
        .morphology;
    shape::section_lengths(&cell).iter().sum()
}

/// An axon of 6 mm, whose mesh is cut into several nodes.
#[neurotess_testing::test]
fn a_mesh_in_several_pieces_is_read_as_one_that_is_closed() {
    let folders = Folders::with(0);
    let mut text = "1 1 0 0 0 5 -1\n2 2 0 9 0 1 1\n".to_owned();
    for n in 3..62 {
        let (x, y) = (100 * (n - 2), 9 + 13 * (n % 7));
        text += &format!("{n} 2 {x} {y} {} 1 {}\n", -5 * n, n - 1);
    }
    fs::write(folders.path("in/1.swc"), text).expect("written");
    let fine = LevelOptions {
        max_error: 0.05,
        count: 2,
    };
    let export = folders.export("out").levels(fine);
    export.run(|_| ()).expect("written");
    let read = mesh(&folders.path("out/mesh/1"));
    let report = check(&read);
    assert!(
        report.closed && report.vertex_manifold && report.components == 1,
        "{report:?}"
    );
    // Tubes of radius 1, and half a step of 21 nm.
    let length = length(&folders.path("in/1.swc"));
    let expected = length * std::f64::consts::PI + 4.0 / 3.0 * std::f64::consts::PI * 125.0;
    assert!(
        (report.volume / expected - 1.0).abs() < 0.05,
        "{} {expected}",
        report.volume
    );
    let of_skeleton = self::length(&folders.path("out/skeletons/1"));
    assert!(
        (of_skeleton / length - 1.0).abs() < 1e-5,
        "{of_skeleton} {length}"
    );
}

#[neurotess_testing::test]
fn cells_in_shards_are_found_by_their_ids() {
    let folders = Folders::with(0);
    many(&folders)
        .into(folders.path("out"))
        .run(|_| ())
        .expect("written");
    let skeletons = Skeletons::open(&folders.path("out/skeletons"))
        .expect("read")
        .expect("skeletons");
    let ids = skeletons.ids().expect("read");
    assert_eq!(ids.len(), 520);
    for id in ids.iter().step_by(57) {
        let path = folders.path(&format!("out/mesh/{id}"));
        let report = check(&mesh(&path));
        assert!(report.closed, "{id}: {report:?}");
        assert!(length(&skeletons.folder().join(id.to_string())) > 10.0);
    }
    let missing = read_mesh(&folders.path("out/mesh/999999"))
        .expect("a mesh")
        .expect_err("none");
    assert_eq!(
        missing.to_string(),
        "no shard has mesh 999999: check the id, and whether all shards were fetched"
    );
}

fn fragment(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<u8> {
    let count = (vertices.len() as u32).to_le_bytes();
    let vertices = vertices.as_flattened().iter().flat_map(|n| n.to_le_bytes());
    let triangles = triangles
        .as_flattened()
        .iter()
        .flat_map(|n| n.to_le_bytes());
    count.into_iter().chain(vertices).chain(triangles).collect()
}

#[neurotess_testing::test]
fn legacy_meshes_in_two_files_are_closed() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(
        at("info"),
        json!({ "@type": "neuroglancer_legacy_mesh" }).to_string(),
    )
    .expect("written");
    fs::write(at("7:0"), json!({ "fragments": ["a", "b"] }).to_string()).expect("written");
    // A tetrahedron of 1 µm; each file has two of its faces.
    let corners = [
        [0.0; 3],
        [1000.0, 0.0, 0.0],
        [0.0, 1000.0, 0.0],
        [0.0, 0.0, 1000.0],
    ];
    fs::write(at("a"), fragment(&corners, &[[0, 2, 1], [0, 1, 3]])).expect("written");
    let turned = [corners[3], corners[2], corners[1], corners[0]];
    fs::write(at("b"), fragment(&turned, &[[3, 0, 1], [2, 1, 0]])).expect("written");
    let report = check(&mesh(&at("7")));
    assert!(report.closed && report.oriented, "{report:?}");
    assert!((report.volume - 1.0 / 6.0).abs() < 1e-6);
    let whole = fs::read(at("a")).expect("there");
    let said = || {
        read_mesh(&at("7"))
            .expect("a mesh")
            .expect_err("broken")
            .to_string()
    };
    for cut in [0, 3, 10, whole.len() - 1] {
        fs::write(at("a"), &whole[..cut]).expect("written");
        assert!(
            said().starts_with("the precomputed mesh is not what it should be"),
            "{cut}: {}",
            said()
        );
    }
    fs::write(at("a"), fragment(&corners, &[[0, 2, 4]])).expect("written");
    assert!(said().contains("a corner that is none of its vertices"));
    fs::write(at("7:0"), json!({ "fragments": ["../a"] }).to_string()).expect("written");
    assert!(said().contains("outside of the folder"));
    fs::write(at("7:0"), json!({ "fragments": ["none"] }).to_string()).expect("written");
    assert!(said().starts_with("cannot be read ("));
    assert!(read_mesh(&at("info")).is_none() && read_mesh(&at("none/7")).is_none());
}

#[neurotess_testing::test]
fn cut_off_manifests_are_told() {
    let folders = Folders::with(1);
    folders.export("out").run(|_| ()).expect("written");
    let index = folders.path("out/mesh/1.index");
    let whole = fs::read(&index).expect("there");
    let path = folders.path("out/mesh/1");
    for cut in (0..whole.len()).step_by(4) {
        fs::write(&index, &whole[..cut]).expect("written");
        assert!(read_mesh(&path).expect("a mesh").is_err(), "{cut}");
    }
    fs::write(&index, &whole).expect("written");
    assert!(check(&mesh(&path)).closed);
    // A count declares more than there is.
    let mut huge = whole.clone();
    huge[24..28].copy_from_slice(&u32::MAX.to_le_bytes());
    fs::write(&index, &huge).expect("written");
    assert!(read_mesh(&path).expect("a mesh").is_err());
    fs::write(&index, &whole).expect("written");
    let data = fs::read(&path).expect("there");
    fs::write(&path, &data[..data.len() / 2]).expect("written");
    assert!(read_mesh(&path).expect("a mesh").is_err());
}
