//! Numbers of sections that other programs gave: reports on membranes, tables, copies.

use std::path::PathBuf;

use glam::Vec3;
use neurotess::circuit::{Circuit, NodeRef};
use neurotess::coloring::{Cell, Recording, cuts, with_middles};
use neurotess::mesh::Role;
use neurotess_testing::{shared, shared_data};
use serde_json::Value;

use crate::work::Work;

fn fault(name: &str) -> PathBuf {
    shared_data().join("../faults").join(name)
}

/// The value at time 0 that the membrane shows around places of the first neuron of a circuit.
fn shown(circuit: &str, places: &[[f32; 3]]) -> Vec<f32> {
    let circuit = Circuit::open(fault(circuit)).expect("a circuit");
    let node = NodeRef {
        population: 0,
        row: 0,
    };
    let report = PathBuf::from("v");
    let cuts = cuts(&report, &circuit, &[(0, node)]).expect("a report");
    let read = circuit.templates[0].read().expect("a cell");
    let morphology = with_middles(&read.morphology, &cuts[&0]);
    let generated = neurotess::generate::generate(&morphology, &Default::default());
    let mesh = generated.expect("meshed").mesh;
    let cells = [Cell {
        name: "cell",
        morphology: &morphology,
        mesh: &mesh,
        radius_factor: 1.0,
    }];
    let recording = Recording::open(&report, &circuit, &cells, &[(0, Some(node))]);
    let recording = recording.expect("a recording");
    assert_eq!(recording.unknown_sections(), None);
    let values = recording.at(0.0, 1.0, &|_| true).expect("values");
    let at = |place: &[f32; 3]| {
        let place = Vec3::from_array(*place);
        let points = mesh.tracing.iter().zip(&recording.color_keys()[0]);
        let of_neurites = points.filter(|(point, _)| point.role != Role::Soma);
        let nearest = of_neurites.min_by(|(a, _), (b, _)| {
            let far = |center: Vec3| center.distance(place);
            far(a.center).total_cmp(&far(b.center))
        });
        let (point, key) = nearest.expect("a point");
        assert!(
            point.center.distance(place) < 1.5,
            "{place} {}",
            point.center
        );
        values.of(0)[*key as usize]
    };
    places.iter().map(at).collect()
}

/// The report's value is ten times the number that NEURON 9.0.2 gives the section.
#[neurotess_testing::test(needs(shared))]
fn membranes_show_the_sections_that_a_report_names() {
    let breadth_first = shown(
        "s1_breadth_first",
        &[
            [13.0, 0.0, 0.0],
            [25.0, 5.0, 0.0],
            [25.0, -5.0, 0.0],
            [40.0, 20.0, 0.0],
            [40.0, 10.0, 0.0],
            [40.0, -10.0, 0.0],
            [40.0, -20.0, 0.0],
        ],
    );
    assert_eq!(breadth_first, [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0]);
    let only_child = shown(
        "s2_only_child_asc",
        &[
            [13.0, 0.0, 0.0],
            [30.0, 2.0, 0.0],
            [60.0, 10.0, 0.0],
            [60.0, 0.0, 0.0],
            [-18.0, 0.0, 0.0],
        ],
    );
    assert_eq!(only_child, [10.0, 20.0, 30.0, 40.0, 50.0]);
}

#[neurotess_testing::test(needs(shared))]
fn reports_of_synapses_are_named_and_not_taken_for_sections() {
    let work = Work::new();
    let circuit = fault("s7_synapse_report");
    let circuit = circuit.display();
    let info: Value = work.run(&format!("info {circuit} --json")).exits(0).json();
    assert_eq!(info[0]["reports"][0]["type"], "synapse");
    let table = work
        .run(&format!("report {circuit} --report g --csv -"))
        .exits(0);
    assert!(
        table
            .stdout()
            .starts_with("time_ms,population,node_id,synapse,value\n0,A,0,17,0\n")
    );
    for command in ["render -o a.png --time 0", "html -o a.html"] {
        let run = work
            .run(&format!("{command} {circuit} --report g"))
            .exits(1);
        let errors = run.errors().join("\n");
        assert!(errors.contains("is of type 'synapse'"), "{errors}");
        assert!(
            errors.contains("simulation_config.json: 'reports.g'"),
            "{errors}"
        );
    }
    let run = work
        .run(&format!("report {circuit} --report v --csv -"))
        .exits(1);
    assert!(run.errors()[0].contains("has g"), "{:?}", run.errors());
}

const INTERLEAVED: &str =
    "1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 -6 0 0 1 1\n4 3 16 0 0 1 2\n5 3 -16 0 0 1 3\n";

#[neurotess_testing::test]
fn files_that_neuron_misreads_are_told_and_mended() {
    let work = Work::new();
    std::fs::write(work.path("a.swc"), INTERLEAVED).expect("written");
    std::fs::write(
        work.path("ids.swc"),
        "9 1 0 0 0 5 -1\n4 3 6 0 0 1 9\n7 3 16 0 0 1 4\n",
    )
    .expect("written");
    for file in ["a.swc", "ids.swc"] {
        let info: Value = work.run(&format!("info {file} --json")).exits(0).json();
        let codes = info[0]["warnings"].as_array().expect("warnings");
        assert!(
            codes.iter().any(|w| w["code"] == "neuron_misreads"),
            "{info}"
        );
    }
    work.run("convert a.swc -o b.swc").exits(0);
    work.run("convert ids.swc -o c.swc").exits(0);
    work.run("convert ids.swc -o d.swc --keep-ids").exits(0);
    let read = |file| std::fs::read_to_string(work.path(file)).expect("read");
    assert_eq!(
        read("b.swc"),
        "1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 16 0 0 1 2\n4 3 -6 0 0 1 1\n5 3 -16 0 0 1 4\n"
    );
    assert_eq!(
        read("c.swc"),
        "1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 16 0 0 1 2\n"
    );
    assert_eq!(
        read("d.swc"),
        "9 1 0 0 0 5 -1\n4 3 6 0 0 1 9\n7 3 16 0 0 1 4\n"
    );
    for file in ["b.swc", "c.swc"] {
        let info: Value = work.run(&format!("info {file} --json")).exits(0).json();
        assert_eq!(info[0]["warnings"], Value::Array(Vec::new()));
    }
}

/// Ids of connectomes have 18 digits.
#[neurotess_testing::test]
fn long_numbers_of_samples_are_told_apart() {
    let work = Work::new();
    let id = |n: i64| 155_636_373_412_120_720 + n;
    let rows = [
        (1, 1, 0, 0, 5),
        (2, 3, 6, 0, 1),
        (3, 3, 16, 0, 1),
        (4, 3, 26, 10, 1),
        (5, 3, 26, -10, 1),
    ];
    let row = |&(n, kind, x, y, r): &(i64, i32, i32, i32, i32)| {
        let parent = if n == 1 { -1 } else { id((n - 1).min(3)) };
        format!("{} {kind} {x} {y} 0 {r} {parent}\n", id(n))
    };
    work.file("a.swc", rows.iter().map(row).collect::<String>());
    let made = work
        .run("mesh a.swc -o a.ply --table a.csv --level 2")
        .exits(0);
    assert!(
        made.stderr().contains("long_sample_numbers"),
        "{}",
        made.stderr()
    );
    let table = work.text("a.csv");
    let samples: std::collections::BTreeSet<&str> = table
        .lines()
        .skip(1)
        .filter_map(|line| line.split(',').nth(1))
        .collect();
    // A neurite's first sample may label no triangle at a low level.
    let own: Vec<String> = (1..=5).map(|n| id(n).to_string()).collect();
    assert!(
        samples.len() >= 4
            && samples
                .iter()
                .all(|sample| own.iter().any(|id| id == sample))
    );
}
