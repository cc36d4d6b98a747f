//! H5 files as they are found: headers that lie, containers, the stages of version 2.

use std::path::{Path, PathBuf};

use hdf5_pure::FileBuilder;
use neurotess_formats::{Read, ReadOptions, h5, read};

/// Files of 2 KB to 24 KB that declare forty million points or sections (made with h5py, which writes
/// none of them, or one chunk), and an honest one that is compressed well.
fn declared(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/declared");
    folder.join(name)
}

#[neurotess_testing::test]
fn headers_are_not_believed() {
    let names = [
        "contiguous.h5",
        "chunked.h5",
        "unlimited.h5",
        "one_of_many_chunks.h5",
        "sections.h5",
    ];
    for name in names {
        let error = read(declared(name), &ReadOptions::default()).expect_err(name);
        let message = error.to_string();
        assert!(
            message.contains("0000 bytes, but the file can hold"),
            "{name}: {message}"
        );
    }
    // One that the library refuses before it is asked how large it is.
    assert!(read(declared("large_chunks.h5"), &ReadOptions::default()).is_err());
    let straight = read(declared("straight.h5"), &ReadOptions::default()).expect("a cell");
    assert_eq!(straight.morphology.points.len(), 20_000);
}

/// A soma and a neurite of two points, `radius` thick.
fn tables(radius: f64) -> (Vec<f64>, Vec<i32>) {
    let points = [
        [0., 0., 0., 10.],
        [9., 0., 0., 2.0 * radius],
        [20., 0., 0., 2.0 * radius],
    ];
    (points.concat(), vec![0, 1, -1, 1, 3, 0])
}

fn version_2(group: &str, stages: &[(&str, f64)], structures: &[&str]) -> Vec<u8> {
    let mut file = FileBuilder::new();
    let mut neuron = file.create_group(group);
    for &(stage, radius) in stages {
        let mut inner = neuron.create_group(stage);
        let points = tables(radius).0;
        inner
            .create_dataset("points")
            .with_f64_data(&points)
            .with_shape(&[3, 4]);
        neuron.add_group(inner.finish());
    }
    let mut structure = neuron.create_group("structure");
    for stage in structures {
        structure
            .create_dataset(stage)
            .with_i32_data(&[0, -1, 1, 0])
            .with_shape(&[2, 2]);
    }
    structure
        .create_dataset("sectiontype")
        .with_i32_data(&[1, 3])
        .with_shape(&[2, 1]);
    neuron.add_group(structure.finish());
    file.add_group(neuron.finish());
    file.finish().expect("bytes")
}

fn radius(read: &Read) -> f32 {
    read.morphology.points[0].radius
}

#[neurotess_testing::test]
fn of_version_2_the_best_stage_is_read() {
    let read = |bytes| h5::read_bytes(bytes, "a.h5", &ReadOptions::default()).expect("a cell");
    let raw = read(version_2("neuron1", &[("raw", 1.0)], &["raw"]));
    assert_eq!((radius(&raw), raw.warnings.len()), (1.0, 0));
    let repaired = read(version_2("neuron1", &[("repaired", 2.0)], &["repaired"]));
    assert_eq!((radius(&repaired), repaired.warnings.len()), (2.0, 0));
    // Unraveled points have the sections of the raw ones.
    let all = [("raw", 1.0), ("unraveled", 3.0)];
    let unraveled = read(version_2("any name", &all, &["raw"]));
    assert_eq!(
        (radius(&unraveled), unraveled.warnings[0].code),
        (3.0, "stages")
    );
}

#[neurotess_testing::test]
fn of_a_container_one_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("merged.h5");
    let mut file = FileBuilder::new();
    let mut cells = file.create_group("cells");
    for (name, thick) in [("a", 1.0), ("b", 2.0)] {
        let mut cell = cells.create_group(name);
        let (points, structure) = tables(thick);
        cell.create_dataset("points")
            .with_f64_data(&points)
            .with_shape(&[3, 4]);
        cell.create_dataset("structure")
            .with_i32_data(&structure)
            .with_shape(&[2, 3]);
        cells.add_group(cell.finish());
    }
    file.add_group(cells.finish());
    std::fs::write(&path, file.finish().expect("bytes")).expect("written");
    let named = |member: &str| {
        let path = format!("{}{member}", path.display());
        read(path, &ReadOptions::default())
    };
    let refused = named("").expect_err("a container").to_string();
    assert!(refused.ends_with("as in FILE#cells/a"), "{refused}");
    let b = named("#cells/b").expect("a cell");
    assert_eq!((radius(&b), b.morphology.name.as_str()), (2.0, "b"));
    let missing = named("#cells/c").expect_err("none").to_string();
    assert!(
        missing.contains("no morphology 'cells/c' is in the file, which has 2"),
        "{missing}"
    );
    assert!(!h5::is_other(&path));
}

#[neurotess_testing::test]
fn reports_and_nodes_are_told_from_morphologies() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("report.h5");
    let mut file = FileBuilder::new();
    file.create_dataset("data").with_f32_data(&[0.0; 4]);
    std::fs::write(&path, file.finish().expect("bytes")).expect("written");
    assert!(h5::is_other(&path));
    assert!(!h5::is_other(declared("straight.h5")));
    // A broken member is an error of the call that reads it.
    std::fs::write(&path, "no HDF5").expect("written");
    assert!(!h5::is_other(&path));
}

/// Files of HDF5 2.0.0 (by h5py 3.16.0, `libver="latest"`, gzip), whose chunks are found by an array of fixed size, one
/// that grows, or nothing, since there is a single chunk: a dendrite of 20 points along x that forks.
#[neurotess_testing::test]
fn filtered_chunks_of_hdf5_2_are_read() {
    for index in ["fixed", "single", "extensible"] {
        let file = format!(
            "{}/tests/fixtures/layout_5_{index}.h5",
            env!("CARGO_MANIFEST_DIR")
        );
        let in_memory = std::fs::read(&file).expect("there");
        let options = ReadOptions::default();
        let read = h5::read_bytes(in_memory.clone(), "cell.h5", &options);
        let cell = read.expect(index).morphology;
        assert_eq!((cell.points.len(), cell.sections.len()), (22, 3), "{index}");
        assert_eq!(cell.points[20].position.to_array(), [30.0, 10.0, 0.0]);
        // Broken anywhere, it is an error or another cell, and never worse.
        for at in (0..in_memory.len()).step_by(neurotess_testing::cases(7, 1)) {
            let mut broken = in_memory.clone();
            broken[at] ^= 0x5a;
            let _ = h5::read_bytes(broken, "cell.h5", &options);
        }
    }
}

/// What MorphIO 3.5.0 takes without a warning, and its wheels open at all.
#[neurotess_testing::test]
fn written_tables_are_contiguous_and_of_32_bits() {
    use hdf5_pure::{Datatype, File};
    for (shift, bytes) in [(0.0, 4), (1e6 + 0.1, 8)] {
        let text = format!(
            "1 1 {shift} 0 0 5 -1\n2 3 {} 0 0 1 1\n3 3 {} 0 0 1 2\n",
            shift + 9.0,
            shift + 30.0
        );
        let options = ReadOptions::default();
        let cell = neurotess_formats::swc::read_bytes(text.as_bytes(), "cell", &options);
        let mut written = Vec::new();
        h5::write(&cell.expect("a cell").morphology, &mut written).expect("memory takes it");
        let file = File::from_bytes(written).expect("a file");
        for name in ["points", "structure"] {
            let dataset = file.dataset(name).expect("there");
            assert_eq!(dataset.chunk_shape().expect("a shape"), None, "{name}");
        }
        let points = file.dataset("points").expect("there").datatype();
        let size = match points.expect("a type") {
            Datatype::FloatingPoint { size, .. } => size,
            other => panic!("{other:?}"),
        };
        assert_eq!(size, bytes);
    }
}

/// As morph-spines 1.1.0 writes it: `/soma/meshes/NAME`.
#[neurotess_testing::test]
fn the_mesh_of_a_soma_is_told_and_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cell.h5");
    let write = |triangles: &[i64]| {
        let mut file = FileBuilder::new();
        let points = [0.0, 0.0, 0.0, 9.0, 6.0, 0.0, 0.0, 2.0, 20.0, 0.0, 0.0, 2.0];
        file.create_dataset("points")
            .with_f64_data(&points)
            .with_shape(&[3, 4]);
        file.create_dataset("structure")
            .with_i32_data(&[0, 1, -1, 1, 3, 0])
            .with_shape(&[2, 3]);
        let mut soma = file.create_group("soma");
        let mut meshes = soma.create_group("meshes");
        let mut own = meshes.create_group("cell");
        let corners = [
            5.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 5.0, -5.0, -5.0, -5.0,
        ];
        own.create_dataset("vertices")
            .with_f64_data(&corners)
            .with_shape(&[4, 3]);
        own.create_dataset("triangles")
            .with_i64_data(triangles)
            .with_shape(&[triangles.len() as u64 / 3, 3]);
        meshes.add_group(own.finish());
        soma.add_group(meshes.finish());
        file.add_group(soma.finish());
        std::fs::write(&path, file.finish().expect("bytes")).expect("written");
    };
    write(&[0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0]);
    let cell = read(&path, &ReadOptions::default()).expect("a cell");
    assert!(
        cell.warnings
            .iter()
            .any(|told| told.code == "soma_mesh_in_file")
    );
    let (vertices, triangles) = neurotess_formats::soma_mesh(&path).expect("a mesh");
    assert_eq!((vertices.len(), triangles.len()), (4, 4));
    assert_eq!((vertices[3].x, triangles[1]), (-5.0, [0, 3, 1]));
    write(&[0, 1, 2, 0, 4, 1]);
    let error = neurotess_formats::soma_mesh(&path)
        .expect_err("no corner 4")
        .to_string();
    assert!(error.contains("soma/meshes/cell/triangles"), "{error}");
}
