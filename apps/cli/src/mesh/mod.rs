//! `neurotess mesh`: from tracings to closed surface meshes.
//!
//! ```text
//! arguments ─▶ Inputs ─plan─▶ Jobs ─shard, resume─▶ workers: cell::mesh ─▶ files, log, JSON
//!                  └────────▶ Recipe ──────────────────▲
//! ```

mod cell;
mod log;
mod observed;
mod options;
mod placed;
mod scene;

use std::collections::BTreeMap;
use std::fs;
use std::time::Instant;

use serde::Serialize;

use crate::args::MeshArgs;
use crate::circuit;
use crate::info::{Failed, MORPHOLOGIES, bug};
use crate::inputs::Inputs;
use crate::progress::Progress;
use crate::report::{Failure, Reporter, count, usage};
use crate::targets::{self, Job};
use crate::workers;
use cell::Cell;
use log::Log;
use options::Recipe;

/// What stands in the JSON list for an input.
#[derive(Serialize)]
#[serde(untagged)]
enum Entry {
    Done(Box<Cell>),
    Failed(Failed),
    /// Its output was there and newer.
    Skipped {
        file: String,
        out: String,
        skipped: bool,
    },
}

/// Runs the command.
pub(crate) fn run(args: &MeshArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let clock = Instant::now();
    let (circuits, others) = circuit::partition(&args.inputs);
    if let [path] = &circuits[..]
        && others.is_empty()
    {
        return placed::run(args, path, reporter);
    }
    if !circuits.is_empty() {
        return usage("a circuit is meshed alone: leave out the other inputs");
    }
    if args.cells.any() {
        return usage("no input is a circuit: leave out what chooses cells of one");
    }
    let inputs = Inputs::find(&args.inputs, &MORPHOLOGIES);
    let measure = reporter.json() || args.log.is_some();
    let recipe = Recipe::new(args, &inputs, measure)?;
    let mut jobs = targets::plan(&inputs, &args.out.out, recipe.format.extension())?;
    if let Some(shard) = args.shard {
        jobs = shard.of(jobs);
    }
    for failure in &inputs.failures {
        reporter.failure(failure);
    }
    let (skipped, to_do): (Vec<Job>, Vec<Job>) = jobs
        .iter()
        .cloned()
        .partition(|job| args.resume && is_newer(job));
    let log = args.log.as_deref().map(Log::open).transpose()?;
    let entries = mesh_all(&to_do, &recipe, reporter, log.as_ref())?;
    summarize(&entries, skipped.len(), clock, reporter);
    reporter.document(&in_order(&jobs, entries, &skipped))
}

/// Whether the output is there and not older than the input.
fn is_newer(job: &Job) -> bool {
    let time = |path| fs::metadata(path).and_then(|data| data.modified()).ok();
    match (time(&job.input), time(&job.out)) {
        (Some(input), Some(out)) => out >= input,
        _ => false,
    }
}

fn mesh_all(
    jobs: &[Job],
    recipe: &Recipe,
    reporter: &Reporter,
    log: Option<&Log>,
) -> anyhow::Result<Vec<Entry>> {
    let one = jobs.len() == 1;
    let (total, unit) = if one {
        (0, "blocks")
    } else {
        (jobs.len(), "cells")
    };
    let progress = Progress::new(reporter, total, unit);
    let order = targets::largest_first(jobs);
    let results = workers::run(jobs, &order, reporter.threads(), |job| {
        let result = cell::mesh(job, recipe, one.then_some(&progress));
        let entry = entry(job, result, one, reporter);
        if let Some(log) = log
            && let Err(failure) = log.line(&entry)
        {
            reporter.failure(&failure);
        }
        if !one {
            progress.done();
        }
        entry
    })?;
    drop(progress);
    let named = jobs.iter().zip(results);
    let entries = named.map(|(job, result)| {
        result.unwrap_or_else(|panic| {
            let failure = bug(&job.input.display().to_string(), &panic);
            entry(job, Err(failure), one, reporter)
        })
    });
    Ok(entries.collect())
}

/// Tells of a cell as it finishes.
fn entry(job: &Job, result: Result<Cell, Failure>, one: bool, reporter: &Reporter) -> Entry {
    match result {
        Ok(cell) => {
            reporter.result(&line(&cell));
            if one || reporter.verbose() {
                warn(&cell, reporter);
            }
            Entry::Done(Box::new(cell))
        }
        Err(failure) => {
            reporter.failure(&failure);
            Entry::Failed(Failed {
                file: job.input.display().to_string(),
                error: failure.0,
            })
        }
    }
}

/// One cell for people.
fn line(cell: &Cell) -> String {
    let s = &cell.seconds;
    format!(
        "{} → {}: {} vertices, {} faces, {}, {} in {:.3} s",
        cell.file,
        cell.out,
        cell.vertices,
        cell.triangles + cell.quads,
        if cell.closed { "closed" } else { "NOT CLOSED" },
        count(cell.components, "part"),
        s.read + s.soma + s.coarse + s.refine + s.write,
    )
}

fn warn(cell: &Cell, reporter: &Reporter) {
    for warning in &cell.warnings {
        let line = warning
            .line
            .map_or(String::new(), |line| format!("{line}:"));
        let (message, code) = (&warning.message, warning.code);
        reporter.warning(&format!("{}:{line} {message} ({code})", cell.file));
    }
}

/// The last words on standard error.
fn summarize(entries: &[Entry], skipped: usize, clock: Instant, reporter: &Reporter) {
    let mut done = 0;
    let mut causes: BTreeMap<&str, usize> = BTreeMap::new();
    for entry in entries {
        if let Entry::Done(cell) = entry {
            done += 1;
            for warning in &cell.warnings {
                *causes.entry(warning.code).or_default() += 1;
            }
        }
    }
    if entries.len() > 1 && !causes.is_empty() {
        let causes: Vec<String> = causes
            .iter()
            .map(|(code, n)| format!("{code} {n}"))
            .collect();
        let hint = if reporter.verbose() {
            ""
        } else {
            " (-v tells all)"
        };
        reporter.warning(&format!("cells concerned: {}{hint}", causes.join(", ")));
    }
    if entries.len() + skipped != 1 {
        reporter.note(&format!(
            "{} meshed, {skipped} skipped, {} failed in {:.2} s",
            count(done, "cell"),
            reporter.failures(),
            clock.elapsed().as_secs_f64()
        ));
    }
}

/// Entries in the order of the inputs, the skipped ones in their places.
fn in_order(jobs: &[Job], entries: Vec<Entry>, skipped: &[Job]) -> Vec<Entry> {
    let mut entries = entries.into_iter();
    let mut skipped = skipped.iter().peekable();
    let next = |job| match skipped.next_if(|&next| next == job) {
        Some(Job { input, out }) => Some(Entry::Skipped {
            file: input.display().to_string(),
            out: out.display().to_string(),
            skipped: true,
        }),
        None => entries.next(),
    };
    jobs.iter().filter_map(next).collect()
}
