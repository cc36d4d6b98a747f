//! Spines that files tell of are places beside the tree.

use glam::Vec3;
use hdf5_pure::{AttrValue, FileBuilder, GroupBuilder};
use neurotess_formats::{Format, Read, ReadOptions, asc, h5, write};

fn codes(read: &Read) -> Vec<&str> {
    read.warnings.iter().map(|w| w.code).collect()
}

#[neurotess_testing::test]
fn asc_has_the_ends_of_spines() {
    let text = b"((Dendrite) (0 0 0 2) <(0.5 3 0 2)> (0 6 0 2)
        < (Class 4 \"none\") (Generated 0) (1 6 0 2) (2.5 6.5 0 1)> (0 9 0 2) <> <(no point)> (0 12 0 2))";
    let read = asc::read_bytes(text, "cell.asc", &ReadOptions::default()).expect("a cell");
    let cell = &read.morphology;
    assert_eq!(
        cell.spines,
        [Vec3::new(0.5, 3.0, 0.0), Vec3::new(2.5, 6.5, 0.0)]
    );
    assert_eq!((cell.points.len(), cell.sections.len()), (4, 1));
    assert_eq!(codes(&read), ["spines_left_out", "no_soma"]);
    assert_eq!(read.warnings[0].count, 4);
    for format in Format::WRITTEN {
        let lost = write(cell, format, std::io::sink()).expect("written");
        let spines = lost.iter().find(|w| w.code == "spines_lost");
        assert_eq!(spines.map(|w| w.count), Some(2), "{format:?}");
    }
}

#[neurotess_testing::test]
fn spines_of_asc_stay_precise_far_from_the_origin() {
    let text = b"((Dendrite) (70000 0 0 2) (70010 0 0 2) <(70005.25 3 0 2)> (70020 0 0 2))";
    let read = asc::read_bytes(text, "cell.asc", &ReadOptions::default()).expect("a cell");
    let cell = &read.morphology;
    let place = cell.origin + cell.spines[0].as_dvec3();
    assert_eq!(place.to_array(), [70005.25, 3.0, 0.0]);
}

/// A soma of one point, a dendrite of two segments.
fn add_cell(group: &mut GroupBuilder, family: u32) {
    let points = [
        [0., 0., 0., 10.],
        [9., 0., 0., 2.],
        [20., 0., 0., 2.],
        [20., 10., 0., 2.],
    ];
    group
        .create_dataset("points")
        .with_f64_data(&points.concat())
        .with_shape(&[4, 4]);
    group
        .create_dataset("structure")
        .with_i32_data(&[0, 1, -1, 1, 3, 0])
        .with_shape(&[2, 3]);
    let mut metadata = group.create_group("metadata");
    metadata.set_attr("cell_family", AttrValue::U32(family));
    group.add_group(metadata.finish());
}

fn with_densities(family: u32) -> Vec<u8> {
    let mut file = FileBuilder::new();
    let mut cells = file.create_group("cells");
    let mut cell = cells.create_group("a");
    add_cell(&mut cell, family);
    let mut organelles = cell.create_group("organelles");
    let mut densities = organelles.create_group("postsynaptic_density");
    for (name, rows) in [("section_id", [1, 1, 7]), ("segment_id", [0, 1, 0])] {
        densities
            .create_dataset(name)
            .with_i32_data(&rows)
            .with_shape(&[3]);
    }
    let offsets = [2.5, 99.0, 0.0];
    densities
        .create_dataset("offset")
        .with_f64_data(&offsets)
        .with_shape(&[3]);
    organelles.add_group(densities.finish());
    cell.add_group(organelles.finish());
    cells.add_group(cell.finish());
    file.add_group(cells.finish());
    file.finish().expect("bytes")
}

#[neurotess_testing::test]
fn h5_has_postsynaptic_densities_along_segments() {
    let read = |family| {
        let bytes = with_densities(family);
        h5::read_member(bytes, "cell.h5", "cells/a", &ReadOptions::default()).expect("a cell")
    };
    let neuron = read(0);
    let expected = [Vec3::new(11.5, 0.0, 0.0), Vec3::new(20.0, 10.0, 0.0)];
    assert_eq!(neuron.morphology.spines, expected);
    assert_eq!(codes(&neuron), ["spines_left_out", "density_off_tree"]);
    // On a spine they tell of no other spine.
    assert!(read(2).morphology.spines.is_empty());
}

#[neurotess_testing::test]
fn a_table_of_spines_beside_the_cell_has_their_ends() {
    let mut file = FileBuilder::new();
    let mut cells = file.create_group("morphology");
    let mut cell = cells.create_group("n1");
    add_cell(&mut cell, 0);
    cells.add_group(cell.finish());
    file.add_group(cells.finish());
    let mut edges = file.create_group("edges");
    let mut table = edges.create_group("n1");
    for (name, rows) in [
        ("afferent_surface_x", [12.0, 15.0]),
        ("afferent_surface_y", [1.0, 0.0]),
        ("afferent_surface_z", [0.0, -1.0]),
        ("spine_orientation_vector_x", [0.0, 0.0]),
        ("spine_orientation_vector_y", [1.0, 0.0]),
        ("spine_orientation_vector_z", [0.0, -1.0]),
        ("spine_length", [1.5, 0.75]),
    ] {
        table
            .create_dataset(name)
            .with_f64_data(&rows)
            .with_shape(&[2]);
    }
    edges.add_group(table.finish());
    file.add_group(edges.finish());
    let bytes = file.finish().expect("bytes");
    let read = h5::read_member(bytes, "cell.h5", "morphology/n1", &ReadOptions::default());
    let read = read.expect("a cell");
    let expected = [Vec3::new(12.0, 2.5, 0.0), Vec3::new(15.0, 0.0, -1.75)];
    assert_eq!(read.morphology.spines, expected);
    assert_eq!(read.warnings[0].count, 2);
}
