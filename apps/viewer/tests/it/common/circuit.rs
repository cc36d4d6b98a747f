//! A small circuit with spikes and a report, written as SONATA.

use std::fs::{self, File};
use std::path::Path;

use neurotess::circuit::TimeAxis;
use neurotess::circuit::write::{self, ReportLayout};
use neurotess::formats::swc;
use neurotess::synth::circuit::{
    CIRCUIT, CircuitOptions, EDGES, POPULATION, SyntheticCircuit, circuit, circuit_config,
    synapses, voltages,
};
use neurotess::synth::grow;
use neurotess_viewer::Command;

use super::{Window, run, state, window};

/// Writes a circuit: `voltage.h5` has the first `reported` cells, 20 frames of 0.5 ms.
pub(crate) fn write_circuit(folder: &Path, neurons: usize, morphologies: usize, reported: usize) {
    let made = circuit(&CircuitOptions {
        neurons,
        morphologies,
        seed: 3,
        points: Some(120),
        may_cross: false,
        reported,
    });
    fs::create_dir_all(folder.join("morphologies")).expect("a folder");
    let create = |name: &str| File::create(folder.join(name)).expect("a file");
    for cell in &made.morphologies {
        let file = create(&format!("morphologies/{}.swc", cell.name));
        swc::write(&grow(&cell.options), file).expect("written");
    }
    write::nodes(std::slice::from_ref(&made.population), create("nodes.h5")).expect("written");
    fs::write(folder.join(CIRCUIT), circuit_config(false).to_string()).expect("written");
    write::spikes(std::slice::from_ref(&made.spikes), create("spikes.h5")).expect("written");
    let nodes: Vec<u64> = (0..reported as u64).collect();
    let cells: Vec<_> = nodes.iter().map(|node| of_node(&made, *node)).collect();
    let frames = 20;
    let data = (0..frames).flat_map(|frame| {
        cells.iter().flat_map(move |(sections, _)| {
            let n = sections.len();
            // Every cell brightens with time, a node later than the one before.
            let of = move |k: usize| -80.0 + 5.0 * frame as f32 + k as f32 / n as f32;
            (0..n).map(of)
        })
    });
    let layout = ReportLayout {
        population: POPULATION.into(),
        time: TimeAxis::of_frames(0.0, 0.5, frames as u64).expect("an axis"),
        units: "mV".into(),
        nodes,
        sections: cells.iter().map(|(sections, _)| sections.clone()).collect(),
        chunk: [4, 64],
        compressed: true,
    };
    let data: Vec<f32> = data.collect();
    write::report(&layout, &data, create("voltage.h5")).expect("written");
}

/// Sections of the compartments of a node of a circuit that was made, and their voltages.
fn of_node(made: &SyntheticCircuit, node: u64) -> (Vec<u32>, Vec<f32>) {
    let names = &made.population.attributes["morphology"];
    let name = names.text(node as usize);
    let cell = made.morphologies.iter().find(|m| Some(&*m.name) == name);
    let cell = grow(&cell.expect("a morphology").options);
    let voltages = voltages(&cell, node, &made.spikes);
    (voltages.sections, voltages.values)
}

/// Writes `firing.h5` beside the circuit of [`with_circuit`]: action potentials of the first cell that fires, 200 frames
/// of 0.5 ms. Returns that cell.
pub(crate) fn write_firing(folder: &Path) -> usize {
    let made = circuit(&CircuitOptions {
        neurons: 9,
        morphologies: 3,
        seed: 3,
        points: Some(120),
        may_cross: false,
        reported: 7,
    });
    let node = made.spikes.nodes[0];
    let (sections, values) = of_node(&made, node);
    let layout = ReportLayout {
        population: POPULATION.into(),
        time: TimeAxis::of_frames(0.0, 0.5, 200).expect("an axis"),
        units: "mV".into(),
        nodes: vec![node],
        sections: vec![sections],
        chunk: [16, 64],
        compressed: true,
    };
    let file = File::create(folder.join("firing.h5")).expect("a file");
    write::report(&layout, &values, file).expect("written");
    node as usize
}

/// Makes all cells of a circuit a ball and a stick of two points, and writes `stick.h5`: the first cell has a
/// soma and `values` along the stick, at all times.
pub(crate) fn make_sticks(folder: &Path, values: &[f32]) {
    let stick = "1 1 0 0 0 8 -1\n2 3 0 9 0 3 1\n3 3 0 120 0 3 2\n";
    for file in fs::read_dir(folder.join("morphologies")).expect("a folder") {
        fs::write(file.expect("a file").path(), stick).expect("written");
    }
    let layout = ReportLayout {
        population: POPULATION.into(),
        time: TimeAxis::of_frames(0.0, 0.5, 2).expect("an axis"),
        units: "mV".into(),
        nodes: vec![0],
        sections: vec![[0].into_iter().chain(values.iter().map(|_| 1)).collect()],
        chunk: [1, 64],
        compressed: false,
    };
    let frame = || values.iter().take(1).chain(values).copied();
    let data: Vec<f32> = frame().chain(frame()).collect();
    let file = File::create(folder.join("stick.h5")).expect("a file");
    write::report(&layout, &data, file).expect("written");
}

/// A window with a circuit of nine cells, of which seven are in the report.
pub(crate) fn with_circuit() -> (Window, tempfile::TempDir) {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    write_circuit(folder.path(), 9, 3, 7);
    run(
        &mut window,
        Command::Open(vec![folder.path().to_path_buf()]),
    );
    let count = state(&mut window).document.neurons.len();
    assert_eq!(count, 9, "{:?}", state(&mut window).messages.problems);
    (window, folder)
}

/// Writes the circuit of [`write_circuit`] with `per_cell` synapses onto each cell, and a second population of
/// edges, `gaps`, of the first of these onto each.
pub(crate) fn write_with_synapses(
    folder: &Path,
    neurons: usize,
    morphologies: usize,
    per_cell: usize,
) {
    write_circuit(folder, neurons, morphologies, neurons);
    let made = circuit(&CircuitOptions {
        neurons,
        morphologies,
        seed: 3,
        points: Some(120),
        may_cross: false,
        reported: neurons,
    });
    let grown: Vec<_> = made.morphologies.iter().map(|m| grow(&m.options)).collect();
    let all = synapses(&made, &grown, per_cell, 5);
    let first = synapses(&made, &grown, 1, 6);
    let create = |name: &str| File::create(folder.join(name)).expect("a file");
    let properties = [
        ("conductance", all.conductances.clone()),
        ("delay", all.delays.clone()),
    ];
    let ends = [POPULATION; 2];
    write::edges(EDGES, ends, &all.synapses, &properties, create("edges.h5")).expect("written");
    let delays = [("delay", first.delays.clone())];
    write::edges("gaps", ends, &first.synapses, &delays, create("gaps.h5")).expect("written");
    let config = circuit_config(true).to_string();
    let gaps =
        "[{\"edges_file\":\"$BASE_DIR/gaps.h5\",\"populations\":{\"gaps\":{\"type\":\"gap\"}}},";
    let (before, after) = config.split_once("\"edges\":[").expect("a list of edges");
    let config = format!("{before}\"edges\":{gaps}{after}");
    fs::write(folder.join(CIRCUIT), config).expect("written");
}
