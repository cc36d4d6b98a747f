//! `neurotess synth circuit`: a SONATA circuit with spikes and a report.

use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::time::Instant;

use itertools::Itertools;
use neurotess::circuit::TimeAxis;
use neurotess::circuit::write::{self, ReportLayout};
use neurotess::formats::Format;
use neurotess::formats::swc::SampleNumbers;
use neurotess::synth;
use neurotess::synth::circuit::{
    CIRCUIT, CircuitMorphology, CircuitOptions, DURATION, EDGES, POPULATION, SIMULATION, STEP,
    SyntheticCircuit, SyntheticSynapses, circuit, circuit_config, node_sets, simulation_config,
    synapses, voltages,
};
use serde::Serialize;
use serde_json::Value;

use super::args::SynthArgs;
use crate::io::morphologies::write_morphology;
use crate::io::output::{Output, OutputError, existing, is_standard};
use crate::io::workers;
use crate::report::{Failure, Progress, Reporter, bug, count, usage};

/// The one JSON object.
#[derive(Serialize)]
struct Made {
    out: String,
    n_neurons: usize,
    n_morphologies: usize,
    n_spikes: usize,
    n_synapses: usize,
    n_elements: u64,
    seed: u64,
    seconds: f64,
}

/// Runs the command. The configurations are written last, so that an incomplete circuit has none.
pub(crate) fn run(args: &SynthArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let clock = Instant::now();
    let folder = &args.out.out;
    if is_standard(folder) {
        return usage("a circuit is a folder, which standard output cannot take: give another OUT");
    }
    if folder.is_file() {
        return usage(format!(
            "{} is a file, but a circuit is a folder: give another OUT",
            folder.display()
        ));
    }
    let force = args.out.force;
    for name in [CIRCUIT, SIMULATION, "nodes.h5"] {
        if let Err(e) = existing(force).check(&folder.join(name)) {
            reporter.failure(&Failure(e.to_string()));
            return Ok(());
        }
    }
    let made = circuit(&CircuitOptions {
        neurons: args.neurons as usize,
        morphologies: args.morphologies as usize,
        seed: args.seed,
        points: args.points.map(|points| points as usize),
        may_cross: args.may_cross,
        reported: args.reported as usize,
    });
    if !grow_all(&made, folder, force, reporter)? {
        return Ok(());
    }
    let synapses = (args.synapses > 0).then(|| {
        let cells = made.morphologies.iter();
        let grown: Vec<_> = cells.map(|cell| synth::grow(&cell.options)).collect();
        synapses(&made, &grown, args.synapses as usize, args.seed)
    });
    let n_elements = match write_all(&made, synapses.as_ref(), folder, force) {
        Ok(elements) => elements,
        Err(e) => {
            reporter.failure(&Failure(e.to_string()));
            return Ok(());
        }
    };
    let made = Made {
        out: folder.display().to_string(),
        n_neurons: made.population.len(),
        n_morphologies: made.morphologies.len(),
        n_spikes: made.spikes.times.len(),
        n_synapses: synapses.map_or(0, |made| made.synapses.targets.len()),
        n_elements,
        seed: args.seed,
        seconds: clock.elapsed().as_secs_f64(),
    };
    reporter.result(&format!(
        "{}: {} of {}, {} spikes, report of {} elements, in {:.1} s",
        made.out,
        count(made.n_neurons, "neuron"),
        count(made.n_morphologies, "morphology").replace("morphologys", "morphologies"),
        made.n_spikes,
        made.n_elements,
        made.seconds
    ));
    reporter.document(&[made])
}

/// Writes all morphologies. True if none failed.
fn grow_all(
    made: &SyntheticCircuit,
    folder: &Path,
    force: bool,
    reporter: &Reporter,
) -> anyhow::Result<bool> {
    let cells = &made.morphologies;
    let progress = Progress::new(reporter, cells.len(), "morphologies");
    let order: Vec<usize> = (0..cells.len()).collect();
    let path = |cell: &CircuitMorphology| -> PathBuf {
        folder
            .join("morphologies")
            .join(format!("{}.swc", cell.name))
    };
    let results = workers::run(cells, &order, reporter.threads(), |cell| {
        let morphology = synth::grow(&cell.options);
        let written = write_morphology(
            &morphology,
            Format::Swc,
            SampleNumbers::default(),
            &path(cell),
            force,
        );
        progress.done();
        written.map_err(|e| Failure(e.to_string()))
    })?;
    drop(progress);
    let mut all = true;
    for (cell, result) in cells.iter().zip_eq(results) {
        let file = path(cell).display().to_string();
        if let Err(failure) = result.unwrap_or_else(|panic| Err(bug(&file, &panic))) {
            reporter.failure(&failure);
            all = false;
        }
    }
    Ok(all)
}

/// Writes everything else. Returns the number of compartments in the report.
fn write_all(
    made: &SyntheticCircuit,
    synapses: Option<&SyntheticSynapses>,
    folder: &Path,
    force: bool,
) -> Result<u64, OutputError> {
    let put = |name: &str, write: &dyn Fn(&mut dyn io::Write) -> io::Result<()>| {
        let path = folder.join(name);
        let mut output = Output::create(&path, existing(force))?;
        let mut writer = BufWriter::new(output.file());
        write(&mut writer)
            .and_then(|()| io::Write::flush(&mut writer))
            .map_err(|e| OutputError::broken(&path, e))?;
        drop(writer);
        output.finish()
    };
    let json = |name: &str, value: &Value| {
        put(name, &|writer| {
            serde_json::to_writer_pretty(&mut *writer, value).map_err(io::Error::other)?;
            writeln!(writer)
        })
    };
    let populations = std::slice::from_ref(&made.population);
    put("nodes.h5", &|writer| write::nodes(populations, writer))?;
    let spikes = std::slice::from_ref(&made.spikes);
    put("reports/spikes.h5", &|w| write::spikes(spikes, w))?;
    let (layout, data) =
        report(made).map_err(|e| OutputError::broken(&folder.join("reports"), e))?;
    put("reports/voltage.h5", &|w| write::report(&layout, &data, w))?;
    json(
        "node_sets.json",
        &node_sets(&made.population, &made.reported),
    )?;
    if let Some(made) = synapses {
        let properties = [
            ("delay", made.delays.clone()),
            ("conductance", made.conductances.clone()),
        ];
        put("edges.h5", &|writer| {
            let ends = [POPULATION; 2];
            write::edges(EDGES, ends, &made.synapses, &properties, writer)
        })?;
    }
    json(CIRCUIT, &circuit_config(synapses.is_some()))?;
    json(SIMULATION, &simulation_config())?;
    Ok(layout.sections.iter().map(|s| s.len() as u64).sum())
}

/// The report of the selected cells, frames × compartments.
fn report(made: &SyntheticCircuit) -> io::Result<(ReportLayout, Vec<f32>)> {
    let frames = (DURATION / STEP).round() as u64;
    let time = TimeAxis::of_frames(0.0, STEP, frames).map_err(io::Error::other)?;
    let cells: Vec<_> = made
        .reported
        .iter()
        .map(|&node| {
            let attribute = made.population.attributes.get("morphology");
            let name = attribute.and_then(|names| names.text(node as usize));
            let cell = made.morphologies.iter().find(|m| Some(&*m.name) == name);
            let cell = cell.unwrap_or(&made.morphologies[0]);
            voltages(&synth::grow(&cell.options), node, &made.spikes)
        })
        .collect();
    let mut data = Vec::new();
    for frame in 0..frames as usize {
        for cell in &cells {
            let n = cell.sections.len();
            data.extend_from_slice(&cell.values[frame * n..(frame + 1) * n]);
        }
    }
    let layout = ReportLayout {
        population: POPULATION.into(),
        time,
        units: "mV".into(),
        nodes: made.reported.clone(),
        sections: cells.into_iter().map(|cell| cell.sections).collect(),
        chunk: [16, 1024],
        // The HDF5 library of libsonata cannot read compressed data.
        compressed: false,
    };
    Ok((layout, data))
}
