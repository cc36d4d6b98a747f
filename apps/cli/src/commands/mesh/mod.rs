//! `neurotess mesh`: from tracings to closed surface meshes.
//!
//! ```text
//! arguments ─▶ Inputs ─plan─▶ Jobs ─shard, resume─▶ workers: cell::mesh ─▶ files, log, JSON
//!                  └────────▶ MeshOptions ─────────────▲
//! ```

mod areas;
mod args;
mod cell;
mod circuit;
mod circuit_glb;
mod entry;
mod failure;
mod messages;
mod options;
mod run;
mod size;
mod table;
mod warning;

use std::path::{Path, PathBuf};
use std::time::Instant;

use itertools::Itertools;
use neurotess::mesh::Format;

use crate::io::circuits::partition;
use crate::io::inputs::Inputs;
use crate::io::morphologies::MORPHOLOGIES;
use crate::io::record::OutputRecord;
use crate::io::targets::{self, Job};
use crate::io::{output, workers};
use crate::report::{Log, Progress, Reporter, usage};
pub(crate) use args::MeshArgs;
use cell::Watchers;
use entry::{Entry, in_order};
use messages::{summarize, tell};
use options::MeshOptions;
use run::MeshRun;

/// Runs the command.
pub(crate) fn run(args: &MeshArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let clock = Instant::now();
    let (circuits, others) = partition(&args.inputs);
    if let [path] = &circuits[..]
        && others.is_empty()
    {
        let of_a_cell = args.tables().next().map(|(flag, _)| flag);
        if let Some(flag) = of_a_cell.or(args.soma_mesh.is_some().then_some("--soma-mesh")) {
            return usage(format!(
                "{flag} is of one cell, not of a circuit: leave it out"
            ));
        }
        return circuit::run(args, path, reporter);
    }
    if !circuits.is_empty() {
        return usage("a circuit is meshed alone: leave out the other inputs");
    }
    if args.cells.any() {
        return usage("no input is a circuit: leave out what chooses cells of one");
    }
    let out = &args.out.out;
    output::reserve_standard(out, reporter)?;
    let inputs = Inputs::find(&args.inputs, &MORPHOLOGIES);
    let measure = reporter.json() || args.log.is_some();
    if args.soma_mesh.is_some() && !inputs.one_file {
        return usage("--soma-mesh is of one cell: give one input file");
    }
    let mut files = vec![("-o", out)];
    for (flag, table) in args.tables() {
        if !inputs.one_file {
            return usage(format!("{flag} is of one cell: give one input file"));
        }
        if let Some((other, _)) = files.iter().find(|(_, file)| *file == table) {
            return usage(format!("{flag} and {other} name the same file: give two"));
        }
        files.push((flag, table));
        output::reserve_standard(table, reporter)?;
    }
    let options = MeshOptions::new(args, &inputs, measure)?;
    let named = Format::from_extension(out).ok().map(Format::extension);
    reporter.warn_of_name(out, options.files.format.extension(), named);
    let mut jobs = targets::plan(&inputs, out, options.files.format.extension())?;
    for job in &mut jobs {
        options.complete(job);
    }
    if let Some(shard) = args.shard {
        jobs = shard.of(jobs);
    }
    inputs.tell(reporter);
    let record = OutputRecord::open(&record_folder(out, &inputs), &options.fingerprint()?);
    let run = MeshRun {
        options: &options,
        reporter,
        log: args.log.as_deref().map(Log::open).transpose()?,
        resume: args.resume,
        // For a single file there is no record beside it, unless --resume needs one.
        records: args.resume || targets::is_folder(out, &inputs),
    };
    let (skipped, to_do) = run.sort_out(jobs.clone(), &record, |job| job);
    let entries = mesh_all(&to_do, &record, &run)?;
    summarize(&entries, skipped.len(), clock, reporter);
    reporter.document(&in_order(&jobs, entries, &skipped))
}

/// The folder of the record of what files were made from.
fn record_folder(out: &Path, inputs: &Inputs) -> PathBuf {
    match targets::is_folder(out, inputs) {
        true => out.to_path_buf(),
        false => out.parent().unwrap_or(Path::new("")).to_path_buf(),
    }
}

fn mesh_all(jobs: &[Job], record: &OutputRecord, run: &MeshRun<'_>) -> anyhow::Result<Vec<Entry>> {
    let reporter = run.reporter;
    let one = jobs.len() == 1;
    let (total, unit) = if one {
        (0, "blocks")
    } else {
        (jobs.len(), "cells")
    };
    let progress = Progress::new(reporter, total, unit);
    let order = targets::largest_first(jobs);
    let results = workers::run(jobs, &order, reporter.threads(), |job| {
        let watchers = Watchers {
            reporter,
            progress: one.then_some(&progress),
        };
        let entry = run.cell(job, record, |claimed| {
            cell::mesh(job, run.options, claimed, watchers)
        });
        tell(&entry, one, reporter);
        if !one {
            progress.done();
        }
        entry
    })?;
    drop(progress);
    let named = jobs.iter().zip_eq(results);
    let entries = named.map(|(job, result)| {
        result.unwrap_or_else(|panic| {
            let entry = run.panicked(job, &panic);
            tell(&entry, one, reporter);
            entry
        })
    });
    Ok(entries.collect())
}
