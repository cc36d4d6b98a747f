//! `neurotess mesh CIRCUIT`: each cell in the circuit's coordinates, in a file of its own, or all in one GLB
//! (scene.rs).
//!
//! ```text
//! circuit ─select─▶ instances ─by morphology─▶ workers: prepare once ─▶ finish for each instance
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Instant;

use neurotess::circuit::{Circuit, Instance};

use super::args::MeshArgs;
use super::cell::{self, Node, Told};
use super::options::Recipe;
use super::{Context, Entry, circuit_glb, summarize};
use crate::io::inputs::Inputs;
use crate::io::record::Made;
use crate::io::targets::Job;
use crate::io::{circuits, workers};
use crate::report::{Failed, Failure, Log, Progress, Reporter, usage};

/// A cell to write.
struct Placing {
    instance: Instance,
    job: Job,
    node: Node,
}

/// Runs the command for one circuit.
pub(super) fn run(args: &MeshArgs, path: &Path, reporter: &Reporter) -> anyhow::Result<()> {
    let clock = Instant::now();
    let folder = &args.out.out;
    let in_one_file = circuit_glb::is_wanted(args);
    if folder.is_file() && !in_one_file {
        return usage(format!(
            "{} is a file, but the cells of a circuit need a folder, or one .glb: give another OUT",
            folder.display()
        ));
    }
    let opened = circuits::open(path, reporter).and_then(|circuit| {
        let nodes = args.cells.select(&circuit)?;
        Ok((circuit, nodes))
    });
    let (circuit, nodes) = match opened {
        Ok(opened) => opened,
        Err(failure) => {
            reporter.failure(&failure);
            let failed = Entry::Failed(Failed {
                file: path.display().to_string(),
                error: failure.0,
            });
            return reporter.document(&[failed]);
        }
    };
    let instances = circuit.instances(&nodes, None);
    if instances.len() < nodes.len() {
        let without = nodes.len() - instances.len();
        let total = nodes.len();
        reporter.warning(&format!(
            "{}: {without} of {total} chosen cells have no morphology or place: left out",
            circuit.file
        ));
    }
    if in_one_file {
        return circuit_glb::run(args, &circuit, &instances, reporter);
    }
    let measure = reporter.json() || args.log.is_some();
    // Many inputs, whatever their names: OUT is a folder.
    let recipe = Recipe::new(args, &Inputs::default(), measure)?;
    let mut placings = plan(&circuit, &instances, folder, recipe.format.extension());
    if let Some(shard) = args.shard {
        placings = shard.of(placings);
    }
    let made = Made::open(folder, &recipe.matters());
    let context = Context {
        recipe: &recipe,
        reporter,
        log: args.log.as_deref().map(Log::open).transpose()?,
        resume: args.resume,
        records: true,
    };
    let (skipped, to_do) = context.sort_out(placings, &made, |placing| &placing.job);
    let mut entries = mesh_all(&circuit, to_do, &made, &context)?;
    summarize(&entries, skipped.len(), clock, reporter);
    entries.extend(skipped.iter().map(|placing| super::skipped(&placing.job)));
    reporter.document(&entries)
}

/// Names the file of each cell: population and id; the row too where an id stands for several.
fn plan(circuit: &Circuit, instances: &[Instance], folder: &Path, extension: &str) -> Vec<Placing> {
    let mut taken: BTreeSet<PathBuf> = BTreeSet::new();
    let place = |instance: &Instance| {
        let population = &circuit.populations[instance.node.population as usize].name;
        // A population's name is the file's own and may hold anything.
        let plain: String = population
            .chars()
            .map(|c| {
                if c.is_alphanumeric() || "-_.".contains(c) {
                    c
                } else {
                    '_'
                }
            })
            .collect();
        let plain = plain.trim_start_matches('.');
        let id = instance.id;
        let mut out = folder.join(format!("{plain}_{id}.{extension}"));
        if !taken.insert(out.clone()) {
            let row = instance.node.row;
            out = folder.join(format!("{plain}_{id}_row{row}.{extension}"));
            taken.insert(out.clone());
        }
        let input = circuit.templates[instance.template.index()].path.clone();
        Placing {
            instance: *instance,
            job: Job {
                input,
                out,
                stands: format!("{instance:?}"),
            },
            node: Node {
                population: population.clone(),
                node_id: id,
            },
        }
    };
    instances.iter().map(place).collect()
}

/// Meshes each morphology once and writes it for all of its cells. Entries are in the order of the
/// cells.
fn mesh_all(
    circuit: &Circuit,
    placings: Vec<Placing>,
    made: &Made,
    context: &Context<'_>,
) -> anyhow::Result<Vec<Entry>> {
    let Context {
        recipe, reporter, ..
    } = *context;
    let progress = Progress::new(reporter, placings.len(), "cells");
    let mut of_template: BTreeMap<u32, Vec<(usize, Placing)>> = BTreeMap::new();
    for (index, placing) in placings.into_iter().enumerate() {
        let template = placing.instance.template.0;
        of_template
            .entry(template)
            .or_default()
            .push((index, placing));
    }
    let groups: Vec<(u32, Vec<(usize, Placing)>)> = of_template.into_iter().collect();
    // The morphologies of most cells first.
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|&g| (std::cmp::Reverse(groups[g].1.len()), g));
    let results = workers::run(&groups, &order, reporter.threads(), |(template, cells)| {
        let input = &circuit.templates[*template as usize].path;
        let prepared = cell::prepare(input, recipe);
        let told = Told {
            reporter,
            progress: None,
        };
        let one = |(index, placing): &(usize, Placing)| {
            let entry = context.cell(&placing.job, made, |output| match &prepared {
                Ok(prepared) => {
                    let placed = placing.instance.world_from_cell(prepared.soma_center);
                    let out = &placing.job.out;
                    let made = cell::finish(prepared, recipe, out, output, Some(placed), told);
                    made.map(|(mut cell, output)| {
                        cell.node = Some(placing.node.clone());
                        (cell, output)
                    })
                }
                Err(failure) => Err(Failure(format!(
                    "{} (cell {} of {})",
                    failure.0, placing.node.node_id, placing.node.population
                ))),
            });
            super::tell(&entry, false, reporter);
            progress.done();
            (*index, entry)
        };
        cells.iter().map(one).collect::<Vec<_>>()
    })?;
    drop(progress);
    let mut entries: Vec<(usize, Entry)> = Vec::new();
    for ((_, cells), result) in groups.iter().zip(results) {
        match result {
            Ok(done) => entries.extend(done),
            Err(panic) => entries.extend(cells.iter().map(|(index, placing)| {
                let entry = context.panicked(&placing.job, &panic);
                super::tell(&entry, false, reporter);
                (*index, entry)
            })),
        }
    }
    entries.sort_by_key(|&(index, _)| index);
    Ok(entries.into_iter().map(|(_, entry)| entry).collect())
}
