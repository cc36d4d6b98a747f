use std::collections::HashMap;

use neurotess_circuit::SynapseSide::Afferent;
use neurotess_circuit::{Circuit, PointTable};
use neurotess_picture::color::{CATEGORY_BIT, ColorMap, Palette};

use super::*;

fn scheme() -> ColorScheme {
    ColorScheme {
        palette: Palette::NeuroM,
        background: None,
        scale: ColorMap::Viridis.scale(),
        range: None,
        own_colors: crate::OwnColors::default(),
    }
}

fn table(values: &[f64]) -> PointTable {
    PointTable {
        positions: values.iter().map(|&x| DVec3::X * x).collect(),
        columns: vec![("w".into(), values.to_vec())],
    }
}

#[test]
fn numbers_are_colored_from_end_to_end_and_missing_ones_gray() {
    let mut values: Vec<f64> = (0..100).map(f64::from).collect();
    values.extend([1e9, f64::NAN]);
    let set = points("p.csv", &table(&values), Some("w"), &scheme()).expect("markers");
    let color = |index: usize| {
        let key = set.markers[index].color_key & !CATEGORY_BIT;
        set.colors[key as usize]
    };
    let scale = ColorMap::Viridis.scale();
    assert_eq!(color(0), scale[0]);
    assert_eq!(color(99), scale[scale.len() - 1]);
    assert_eq!(color(100), color(99), "far beyond the others");
    assert_eq!(color(101), NOTHING);
    let middle = color(50)[1];
    assert!(scale[100][1] < middle && middle < scale[160][1]);
}

#[test]
fn colors_of_markers_follow_those_that_cells_use() {
    let mut set = points("p.csv", &table(&[1.0, 2.0]), None, &scheme()).expect("markers");
    // Its cells use a category beyond the end of the table.
    let mut coloring = Coloring {
        color_keys: vec![vec![category(0), category(4)]],
        table: neurotess_picture::color::ColorTable {
            categories: vec![[1; 3], [2; 3]],
            ..Default::default()
        },
        legend: Legend::swatches("", []),
        things: Vec::new(),
    };
    coloring.add_markers(&mut set);
    let categories = &coloring.table.categories;
    assert_eq!(categories[..5], [[1; 3], [2; 3], [2; 3], [2; 3], [2; 3]]);
    assert_eq!(categories.len(), 6);
    assert!(
        set.markers
            .iter()
            .all(|marker| marker.color_key == category(5))
    );
    assert_eq!(categories[5], set.colors[0]);
}

#[test]
fn a_column_that_is_not_there_is_named_beside_those_that_are() {
    let missing = points("p.csv", &table(&[1.0]), Some("size"), &scheme());
    let said = missing.expect_err("none").to_string();
    assert_eq!(said, "p.csv: has no number 'size': it has w");
    let set = points("p.csv", &table(&[3.0, 3.0]), Some("w"), &scheme()).expect("markers");
    assert_eq!(set.bounds(), Some((DVec3::X * 3.0, 0.0)));
}

/// Two cells of a scene, the second 100 µm to the right and turned a quarter about z: a dendrite of 2 µm upwards.
fn scene(folder: &std::path::Path) -> Circuit {
    let cell = "1 1 0 0 0 5 -1\n2 3 0 6 0 2 1\n3 3 0 46 0 2 2\n";
    std::fs::write(folder.join("a.swc"), cell).expect("written");
    let text = "[[cells]]\nfile = \"a.swc\"\n[[cells]]\nfile = \"a.swc\"\nposition = [100, 0, 0]\n\
                rotation_degrees = [0, 0, 90]\n";
    let file = folder.join("two.scene.toml");
    std::fs::write(&file, text).expect("written");
    Circuit::open(file).expect("a scene")
}

/// Edges onto the cells of [`scene`] that only say their sections.
fn edges_on_sections(circuit: &Circuit, folder: &std::path::Path) -> neurotess_circuit::Edges {
    let targets = [0_u64, 1, 1, 0, 1];
    let mut file = hdf5_pure::FileBuilder::new();
    let mut all = file.create_group("edges");
    let mut edges = all.create_group("syn");
    for end in ["source_node_id", "target_node_id"] {
        edges.create_dataset(end).with_u64_data(&targets);
    }
    let mut group = edges.create_group("0");
    // The soma, the dendrite three times, and a section that is not there.
    group
        .create_dataset("afferent_section_id")
        .with_u64_data(&[0, 1, 1, 1, 2]);
    group
        .create_dataset("afferent_section_pos")
        .with_f64_data(&[0.5, 0.25, 1.0, 0.5, 0.5]);
    edges.add_group(group.finish());
    all.add_group(edges.finish());
    file.add_group(all.finish());
    let path = folder.join("sections.h5");
    std::fs::write(&path, file.finish().expect("bytes")).expect("written");
    let population = circuit.populations[0].name.clone();
    neurotess_circuit::Edges {
        name: "syn".into(),
        file: path,
        source: population.clone(),
        target: population,
        count: 5,
    }
}

fn shown(circuit: &Circuit, cells: &[u64]) -> ShownCells {
    let name = circuit.populations[0].name.clone();
    let cell = |&id: &u64| {
        let cell = ShownCell {
            node: circuit.node(&name, id).expect("a node"),
            moved: glam::DAffine3::IDENTITY,
        };
        (id, cell)
    };
    ShownCells::from([(name.clone(), cells.iter().map(cell).collect())])
}

#[test]
fn synapses_that_name_sections_lie_on_the_membrane() {
    let folder = tempfile::tempdir().expect("a folder");
    let circuit = scene(folder.path());
    let edges = edges_on_sections(&circuit, folder.path());
    let read = EdgeSynapses::read(&edges, Afferent, None).expect("read");
    let both = shown(&circuit, &[0, 1]);
    let of = SynapsesOf {
        edges: &read,
        circuit: &circuit,
        shown: &both,
    };
    let set = synapse_markers(&[of], &SynapseOptions::default(), &scheme());
    assert_eq!((set.markers.len(), set.left_out, set.placeless), (4, 0, 1));
    // What is on a center line, in the circuit: of the soma, and of the dendrite that was turned to the left.
    let centers = [
        (DVec3::ZERO, 5.0),
        (DVec3::new(100.0 - 16.0, 0.0, 0.0), 2.0),
        (DVec3::new(100.0 - 46.0, 0.0, 0.0), 2.0),
        (DVec3::new(0.0, 26.0, 0.0), 2.0),
    ];
    for ((marker, row), (center, radius)) in set.markers.iter().zip(&set.rows).zip(centers) {
        let out = marker.position - center;
        assert!((out.length() - radius).abs() < 1e-5, "{marker:?}");
        let outwards = marker.outwards.as_dvec3();
        assert!(outwards.distance(out / radius) < 1e-5, "{marker:?}");
        let facts = read.facts(row.row, &circuit).expect("facts");
        assert!(facts.position.distance(marker.position) < 1e-9);
    }
    // Of one cell, and of one that was moved.
    let mut one = shown(&circuit, &[0]);
    for cell in one.values_mut().flat_map(|cells| cells.values_mut()) {
        cell.moved = glam::DAffine3::from_translation(DVec3::Z * 7.0);
    }
    let of = SynapsesOf { shown: &one, ..of };
    let moved = synapse_markers(&[of], &SynapseOptions::default(), &scheme());
    assert_eq!(
        (moved.markers.len(), moved.left_out, moved.placeless),
        (2, 3, 0)
    );
    let way = moved.markers[1].position - set.markers[3].position;
    assert!(way.distance(DVec3::Z * 7.0) < 1e-9, "{way}");
    let other = EdgeSynapses::read(&edges, neurotess_circuit::SynapseSide::Efferent, None);
    let said = other.expect_err("only targets are there").to_string();
    assert!(said.contains("efferent_section_id"), "{said}");
}

#[test]
fn contacts_are_laid_on_the_nearest_membrane() {
    let folder = tempfile::tempdir().expect("a folder");
    let circuit = scene(folder.path());
    let population = circuit.populations[0].name.clone();
    let synapses = neurotess_circuit::Synapses {
        sources: vec![0; 4],
        targets: vec![0, 0, 1, 0],
        // Beside the dendrite, within it, beside the other cell's, and far from all.
        positions: vec![
            DVec3::new(3.0, 20.0, 0.0),
            DVec3::new(0.0, 20.0, -0.5),
            DVec3::new(80.0, 0.0, 2.0),
            DVec3::new(20.0, 20.0, 0.0),
        ],
    };
    let file = folder.path().join("edges.h5");
    let to = std::fs::File::create(&file).expect("a file");
    let ends = [&*population; 2];
    neurotess_circuit::write::edges("syn", ends, &synapses, &[], to).expect("written");
    let edges = neurotess_circuit::Edges {
        name: "syn".into(),
        file,
        source: population.clone(),
        target: population.clone(),
        count: 4,
    };
    let read = EdgeSynapses::read(&edges, Afferent, None).expect("read");
    let both = shown(&circuit, &[0, 1]);
    let of = SynapsesOf {
        edges: &read,
        circuit: &circuit,
        shown: &both,
    };
    let options = SynapseOptions {
        contacts: true,
        ..SynapseOptions::default()
    };
    let set = synapse_markers(&[of], &options, &scheme());
    let expected = [
        (DVec3::new(2.0, 20.0, 0.0), DVec3::X),
        (DVec3::new(0.0, 20.0, -2.0), DVec3::NEG_Z),
        (DVec3::new(80.0, 0.0, 2.0), DVec3::Z),
        (DVec3::new(20.0, 20.0, 0.0), DVec3::ZERO),
    ];
    for (marker, (place, outwards)) in set.markers.iter().zip(expected) {
        assert!(marker.position.distance(place) < 1e-5, "{marker:?}");
        assert!(
            marker.outwards.as_dvec3().distance(outwards) < 1e-5,
            "{marker:?}"
        );
    }
    // As spheres they are where the file has them.
    let spheres = synapse_markers(&[of], &SynapseOptions::default(), &scheme());
    let given = spheres.markers.iter().map(|marker| marker.position);
    assert!(
        given
            .zip(&synapses.positions)
            .all(|(a, b)| a.distance(*b) < 1e-5)
    );
}

fn edges(folder: &std::path::Path) -> neurotess_circuit::Edges {
    let at = |x: f64| DVec3::new(x, 1.0, 2.0);
    let synapses = neurotess_circuit::Synapses {
        sources: vec![7, 8, 9, 7],
        targets: vec![1, 2, 1, 3],
        positions: vec![at(0.0), at(10.0), at(20.0), DVec3::NAN],
    };
    let file = folder.join("edges.h5");
    let delays = [("delay", vec![0.5, 1.5, 2.5, 3.5])];
    let to = std::fs::File::create(&file).expect("a file");
    neurotess_circuit::write::edges("syn", ["pre", "post"], &synapses, &delays, to)
        .expect("written");
    neurotess_circuit::Edges {
        name: "syn".into(),
        file,
        source: "pre".into(),
        target: "post".into(),
        count: 4,
    }
}

#[test]
fn synapses_are_read_once_and_shown_in_part() {
    let folder = tempfile::tempdir().expect("a folder");
    let edges = edges(folder.path());
    let read = EdgeSynapses::read(&edges, Afferent, Some("delay")).expect("read");
    assert_eq!(read.len(), 4);
    // Where coordinates are given, the cells are not looked at.
    let circuit = scene(folder.path());
    let facts = read.facts(2, &circuit).expect("a synapse");
    assert_eq!((facts.cell, facts.partner, facts.number), (1, 9, Some(2.5)));
    assert_eq!(read.facts(4, &circuit), None);
    // Cell 1 was turned and moved, cell 3 has a synapse without a place.
    let turned = glam::DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let moved = glam::DAffine3::from_rotation_translation(turned, DVec3::Y * 100.0);
    let node = circuit
        .node(&circuit.populations[0].name, 0)
        .expect("a node");
    let cell = |moved| ShownCell { node, moved };
    let shown = HashMap::from([(1, cell(moved)), (3, cell(glam::DAffine3::IDENTITY))]);
    let shown = ShownCells::from([("post".to_owned(), shown)]);
    let of = SynapsesOf {
        edges: &read,
        circuit: &circuit,
        shown: &shown,
    };
    let options = SynapseOptions {
        property: Some("delay".into()),
        ..SynapseOptions::default()
    };
    let set = synapse_markers(&[of], &options, &scheme());
    let rows: Vec<u64> = set.rows.iter().map(|row| row.row).collect();
    assert_eq!(rows, [0, 2]);
    assert_eq!((set.left_out, set.placeless), (1, 1));
    let place = DVec3::new(-1.0, 120.0, 2.0);
    assert!(set.markers[1].position.distance(place) < 1e-9);
    assert!(set.legend.is_bar() && set.bounds().is_none());
    let missing = EdgeSynapses::read(&edges, Afferent, Some("size")).expect_err("none");
    assert!(missing.to_string().contains("it has delay"), "{missing}");
}
