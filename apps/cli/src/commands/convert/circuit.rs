//! `neurotess convert CIRCUIT`: tracings of chosen cells, placed in the circuit's coordinates.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use glam::DVec3;
use itertools::Itertools;
use neurotess::batch::{self, Inputs, targets};
use neurotess::circuit::{Circuit, Instance, soma_center};
use neurotess::formats::Format;
use neurotess::morphology::edit::{self, Edit};

use super::{ConvertArgs, Converted, EditRecipe, NodeName, read, tell_all, written};
use crate::io::output::{self, is_standard};
use crate::io::{circuits, workers};
use crate::report::{Entry, Failed, Failure, Progress, Reporter, bug, usage};

/// The cells of a run.
struct Cells {
    circuit: Circuit,
    instances: Vec<Instance>,
    /// Of each: places (µm) of the synapses that it gets; empty if they are not needed.
    synapses: Vec<Vec<DVec3>>,
}

/// Runs the command for one circuit.
pub(super) fn run(
    args: &ConvertArgs,
    path: &Path,
    recipe: &EditRecipe,
    reporter: &Reporter,
) -> anyhow::Result<()> {
    if args.edits.changes_units() {
        return usage("cells of a circuit are in µm: leave out --scale and --units");
    }
    if let Some(out) = args.out.as_deref().filter(|_| !args.dry_run) {
        output::reserve_standard(out, reporter)?;
    }
    let cells = match open(args, path, recipe, reporter) {
        Ok(cells) => cells,
        Err(failure) => {
            reporter.failure(&failure);
            let failed: Entry<Converted> = Entry::Failed(Failed {
                file: path.display().to_string(),
                error: failure.0,
            });
            return reporter.document(&[failed]);
        }
    };
    if recipe.is_of_one_cell() && cells.instances.len() > 1 {
        return usage("a table of places is of one cell: choose one by --nodes");
    }
    let out = args.out.as_deref();
    let target = out.map(|out| target(out, args, &cells)).transpose()?;
    let all: Vec<usize> = (0..cells.instances.len()).collect();
    let progress = Progress::new(reporter, all.len(), "cells");
    let results = workers::run(&all, &all, reporter.threads(), |&number| {
        let result = match reporter.stopped().load(Ordering::Relaxed) {
            true => Err(Failure("stopped".into())),
            false => {
                let out = target.as_ref();
                let out = out.map(|(format, outs)| (outs[number].as_path(), *format));
                convert(&cells, number, args, recipe, out)
            }
        };
        progress.done();
        result
    })?;
    drop(progress);
    let entries = results.into_iter().zip_eq(&cells.instances);
    let entries = entries.map(|(result, instance)| {
        let file = &cells.circuit.templates[instance.template.index()].path;
        let file = file.display().to_string();
        match result.unwrap_or_else(|panic| Err(bug(&file, &panic))) {
            Ok(done) => Entry::Done(done),
            Err(failure) => {
                reporter.failure(&failure);
                let error = failure.0;
                Entry::Failed(Failed { file, error })
            }
        }
    });
    tell_all(&entries.collect::<Vec<_>>(), args, reporter)
}

fn open(
    args: &ConvertArgs,
    path: &Path,
    recipe: &EditRecipe,
    reporter: &Reporter,
) -> Result<Cells, Failure> {
    let circuit = circuits::open(path, reporter)?;
    let nodes = args.cells.select(&circuit)?;
    let instances = circuits::instances(&circuit, &nodes, reporter);
    let synapses = match recipe.needs_synapses() {
        true => circuit.inputs(&instances),
        false => Ok(vec![Vec::new(); instances.len()]),
    };
    Ok(Cells {
        synapses: synapses.map_err(|e| Failure(e.to_string()))?,
        circuit,
        instances,
    })
}

/// The format and the file of each cell: OUT itself for one cell if it is named as a tracing, else in the folder OUT.
fn target(out: &Path, args: &ConvertArgs, cells: &Cells) -> anyhow::Result<(Format, Vec<PathBuf>)> {
    let extension = out.extension().unwrap_or_default().to_string_lossy();
    let is_file = is_standard(out) || Format::of_extension(&extension).is_some();
    let inputs = Inputs {
        one_file: is_file && cells.instances.len() == 1,
        ..Inputs::default()
    };
    let format = super::format(out, args, &inputs)?;
    if !targets::is_folder(out, &inputs) {
        return Ok((format, vec![out.to_path_buf()]));
    }
    if is_standard(out) || out.is_file() {
        return usage(format!(
            "{} is one file, but {} cells are chosen: give a folder, or choose one cell by --nodes",
            out.display(),
            cells.instances.len()
        ));
    }
    let extension = format.extensions()[0];
    let files = batch::circuit::files(&cells.circuit, &cells.instances, out, extension);
    Ok((format, files))
}

fn convert(
    cells: &Cells,
    number: usize,
    args: &ConvertArgs,
    recipe: &EditRecipe,
    out: Option<(&Path, Format)>,
) -> Result<Converted, Failure> {
    let instance = &cells.instances[number];
    let path = &cells.circuit.templates[instance.template.index()].path;
    let population = &cells.circuit.populations[instance.node.population as usize].name;
    let file = path.display().to_string();
    let failed = |why: String| {
        Failure(format!(
            "{file}: {why} (cell {} of {population})",
            instance.id
        ))
    };
    let read = read(path, args)?;
    let placed = Edit::Place(instance.world_from_cell(soma_center(&read.morphology)));
    let placed = edit::apply(&read.morphology, &[placed]).map_err(|e| failed(e.to_string()))?;
    let synapses = Some(&cells.synapses[number][..]);
    let edited = recipe.apply_to(&placed.morphology, synapses);
    let mut edited = edited.map_err(failed)?;
    edited.reports.splice(0..0, placed.reports);
    let node = NodeName {
        population: population.clone(),
        node_id: instance.id,
    };
    let mut done = written(file, read.warnings, edited, args, out)?;
    done.node = Some(node);
    Ok(done)
}
