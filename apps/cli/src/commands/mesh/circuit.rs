//! `neurotess mesh CIRCUIT`: each cell in the circuit's coordinates, in a file of its own, or all
//! in one GLB (circuit_glb.rs).
//!
//! ```text
//! circuit ─select─▶ instances ─by morphology─▶ workers: prepare once ─▶ finish for each instance
//! ```

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use itertools::Itertools;
use neurotess::circuit::{Circuit, Instance};

use super::args::MeshArgs;
use super::cell::{self, NodeName, Target, Watchers};
use super::circuit_glb;
use super::entry::{self, Entry};
use super::messages::{summarize, tell};
use super::options::MeshOptions;
use super::run::MeshRun;
use crate::io::inputs::Inputs;
use crate::io::record::OutputRecord;
use crate::io::targets::Job;
use crate::io::{circuits, workers};
use crate::report::{Failed, Failure, Log, Progress, Reporter, usage};

/// A cell to write.
struct InstanceJob {
    instance: Instance,
    job: Job,
    node: NodeName,
}

/// Runs the command for one circuit.
pub(super) fn run(args: &MeshArgs, path: &Path, reporter: &Reporter) -> anyhow::Result<()> {
    let clock = Instant::now();
    let folder = &args.out.out;
    let in_one_file = circuit_glb::is_one_file(args);
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
    let instances = circuits::instances(&circuit, &nodes, reporter);
    if in_one_file {
        return circuit_glb::run(args, &circuit, &instances, reporter);
    }
    let measure = reporter.json() || args.log.is_some();
    // No single input file, so that OUT is a folder.
    let options = MeshOptions::new(args, &Inputs::default(), measure)?;
    let mut instance_jobs = plan(
        &circuit,
        &instances,
        folder,
        options.files.format.extension(),
    );
    for instance_job in &mut instance_jobs {
        options.complete(&mut instance_job.job);
    }
    if let Some(shard) = args.shard {
        instance_jobs = shard.of(instance_jobs);
    }
    let record = OutputRecord::open(folder, &options.fingerprint()?);
    let run = MeshRun {
        options: &options,
        reporter,
        log: args.log.as_deref().map(Log::open).transpose()?,
        resume: args.resume,
        records: true,
    };
    let (skipped, to_do) = run.sort_out(instance_jobs, &record, |instance_job| &instance_job.job);
    let mut entries = mesh_all(&circuit, to_do, &record, &run)?;
    summarize(&entries, skipped.len(), clock, reporter);
    entries.extend(
        skipped
            .iter()
            .map(|instance_job| entry::skipped(&instance_job.job)),
    );
    reporter.document(&entries)
}

/// The file of each cell.
fn plan(
    circuit: &Circuit,
    instances: &[Instance],
    folder: &Path,
    extension: &str,
) -> Vec<InstanceJob> {
    let outs = circuits::files(circuit, instances, folder, extension);
    let job = |(instance, out): (&Instance, PathBuf)| {
        let population = &circuit.populations[instance.node.population as usize].name;
        let input = circuit.templates[instance.template.index()].path.clone();
        InstanceJob {
            instance: *instance,
            job: Job {
                input,
                out,
                placement: placement(instance),
                further: Vec::new(),
                beside: None,
                parts: false,
            },
            node: NodeName {
                population: population.clone(),
                node_id: instance.id,
            },
        }
    };
    instances.iter().zip_eq(outs).map(job).collect()
}

/// Where a cell is, as text that is the same for the same place only.
fn placement(instance: &Instance) -> String {
    let Instance {
        node: _,
        id: _,
        template: _,
        position,
        rotation,
        scale,
        recentered,
        group: _,
    } = *instance;
    let numbers = [
        position.to_array().as_slice(),
        &rotation.to_array(),
        &[scale],
    ]
    .concat();
    let bits: Vec<String> = numbers
        .iter()
        .map(|n| format!("{:x}", n.to_bits()))
        .collect();
    format!("{} {recentered}", bits.join(" "))
}

/// Meshes each morphology once and writes it for all of its cells. Entries are in the order of the
/// cells.
fn mesh_all(
    circuit: &Circuit,
    instance_jobs: Vec<InstanceJob>,
    record: &OutputRecord,
    run: &MeshRun<'_>,
) -> anyhow::Result<Vec<Entry>> {
    let MeshRun {
        options, reporter, ..
    } = *run;
    let progress = Progress::new(reporter, instance_jobs.len(), "cells");
    let mut of_template: BTreeMap<u32, Vec<(usize, InstanceJob)>> = BTreeMap::new();
    for (index, instance_job) in instance_jobs.into_iter().enumerate() {
        let template = instance_job.instance.template.0;
        of_template
            .entry(template)
            .or_default()
            .push((index, instance_job));
    }
    let groups: Vec<(u32, Vec<(usize, InstanceJob)>)> = of_template.into_iter().collect();
    // Morphologies with the most cells first, so that no thread starts a long one last.
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|&g| (std::cmp::Reverse(groups[g].1.len()), g));
    let results = workers::run(&groups, &order, reporter.threads(), |(template, cells)| {
        let input = &circuit.templates[*template as usize].path;
        let prepared = cell::prepare(input, options);
        let watchers = Watchers {
            reporter,
            progress: None,
        };
        let one = |(index, instance_job): &(usize, InstanceJob)| {
            let entry = run.cell(&instance_job.job, record, |claimed| match &prepared {
                Ok(prepared) => {
                    let placed = instance_job.instance.world_from_cell(prepared.soma_center);
                    let surface = prepared.surface(options);
                    let job = &instance_job.job;
                    let to = Target { job, claimed };
                    let written =
                        cell::finish(prepared, &surface, options, to, Some(placed), watchers);
                    written.map(|mut made| {
                        made.report.node = Some(instance_job.node.clone());
                        made
                    })
                }
                Err(failure) => Err(Failure(format!(
                    "{} (cell {} of {})",
                    failure.0, instance_job.node.node_id, instance_job.node.population
                ))),
            });
            tell(&entry, false, reporter);
            progress.done();
            (*index, entry)
        };
        cells.iter().map(one).collect::<Vec<_>>()
    })?;
    drop(progress);
    let mut entries: Vec<(usize, Entry)> = Vec::new();
    for ((_, cells), result) in groups.iter().zip_eq(results) {
        match result {
            Ok(done) => entries.extend(done),
            Err(panic) => entries.extend(cells.iter().map(|(index, instance_job)| {
                let entry = run.panicked(&instance_job.job, &panic);
                tell(&entry, false, reporter);
                (*index, entry)
            })),
        }
    }
    entries.sort_by_key(|&(index, _)| index);
    Ok(entries.into_iter().map(|(_, entry)| entry).collect())
}
