//! `neurotess mesh`: from tracings to closed surface meshes.
//!
//! ```text
//! arguments ─▶ Inputs ─plan─▶ Jobs ─shard, resume─▶ workers: cell::mesh ─▶ files, log, JSON
//!                  └────────▶ Recipe ──────────────────▲
//! ```

mod args;
mod cell;
mod circuit;
mod circuit_glb;
mod observed;
mod options;
mod size;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use neurotess::mesh::Format;
use serde::Serialize;

use crate::io::circuits::partition;
use crate::io::claims::{Claim, claim};
use crate::io::inputs::Inputs;
use crate::io::morphologies::{MORPHOLOGIES, readable};
use crate::io::output::{self, Output, OutputError};
use crate::io::record::{Made, Standing};
use crate::io::targets::{self, Job};
use crate::io::workers;
use crate::report::{Failed, Failure, Log, Progress, Reporter, bug, count, place, usage};
pub(crate) use args::MeshArgs;
use cell::{Cell, Told};
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
    let (circuits, others) = partition(&args.inputs);
    if let [path] = &circuits[..]
        && others.is_empty()
    {
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
    let recipe = Recipe::new(args, &inputs, measure)?;
    let named = Format::from_extension(out).ok().map(Format::extension);
    reporter.warn_of_name(out, recipe.format.extension(), named);
    let mut jobs = targets::plan(&inputs, out, recipe.format.extension())?;
    if let Some(shard) = args.shard {
        jobs = shard.of(jobs);
    }
    inputs.tell(reporter);
    let made = Made::open(&record_folder(out, &inputs), &recipe.matters());
    let context = Context {
        recipe: &recipe,
        reporter,
        log: args.log.as_deref().map(Log::open).transpose()?,
        resume: args.resume,
        // One file with a name of its own leaves nothing beside it unless it is to be resumed.
        records: args.resume || targets::is_folder(out, &inputs),
    };
    let (skipped, to_do) = context.sort_out(jobs.clone(), &made, |job| job);
    let entries = mesh_all(&to_do, &made, &context)?;
    summarize(&entries, skipped.len(), clock, reporter);
    reporter.document(&in_order(&jobs, entries, &skipped))
}

/// Where it is written down what files were made of.
fn record_folder(out: &Path, inputs: &Inputs) -> PathBuf {
    match targets::is_folder(out, inputs) {
        true => out.to_path_buf(),
        false => out.parent().unwrap_or(Path::new("")).to_path_buf(),
    }
}

/// What all cells of a run have in common.
struct Context<'a> {
    recipe: &'a Recipe,
    reporter: &'a Reporter,
    log: Option<Log>,
    resume: bool,
    /// Whether it is written down what files were made of.
    records: bool,
}

impl Context<'_> {
    fn log(&self, entry: &Entry) {
        if let Some(log) = &self.log
            && let Err(failure) = log.line(entry)
        {
            self.reporter.failure(&failure);
        }
    }

    /// What stays and what is to be made; tells why.
    fn sort_out<T>(&self, all: Vec<T>, made: &Made, job: impl Fn(&T) -> &Job) -> (Vec<T>, Vec<T>) {
        if !self.resume {
            return (Vec::new(), all);
        }
        let mut standings = Vec::with_capacity(all.len());
        let (skipped, to_do) = all.into_iter().partition(|item| {
            let standing = made.standing(job(item));
            standings.push(standing);
            if standing.stays() {
                self.left(job(item));
            }
            standing.stays()
        });
        tell_standings(&standings, self.reporter);
        (skipped, to_do)
    }

    /// An output that stays. A line that the log lacks, say since it is a new one, is added.
    fn left(&self, job: &Job) {
        let known = |log: &Log| log.knows(&job.out.display().to_string());
        if self.log.as_ref().is_some_and(|log| !known(log)) {
            self.log(&skipped(job));
        }
    }

    /// Claims a cell's file, makes it, writes down what it is and gives it its name.
    fn cell(
        &self,
        job: &Job,
        made: &Made,
        make: impl FnOnce(Output) -> Result<(Cell, Output), Failure>,
    ) -> Entry {
        let file = job.input.display();
        let failed = |e: OutputError| Failure(format!("{file}: {e}"));
        let resume = self.resume.then_some(made);
        let claimed = readable(&job.input)
            .and_then(|()| claim(job, self.recipe.force, resume, self.reporter).map_err(failed));
        let result = match claimed {
            Ok(Claim::Done) => return skipped(job),
            Ok(Claim::Ours(output)) => make(output),
            Err(failure) => Err(failure),
        };
        let failure = match result {
            Ok((cell, output)) => {
                let cell = Box::new(cell);
                if self.records
                    && let Err(e) = made.add(job, output.part())
                {
                    let name = crate::io::record::NAME;
                    self.reporter.warning(&format!(
                        "{name} beside {} cannot be written ({e}): --resume will know less",
                        job.out.display()
                    ));
                }
                let entry = Entry::Done(cell);
                self.log(&entry);
                match output.finish().map_err(failed) {
                    Ok(()) => return entry,
                    Err(failure) => failure,
                }
            }
            Err(failure) => failure,
        };
        self.failed(job, failure)
    }

    /// A cell that failed, in the log too.
    fn failed(&self, job: &Job, failure: Failure) -> Entry {
        let entry = Entry::Failed(Failed {
            file: job.input.display().to_string(),
            error: failure.0,
        });
        self.log(&entry);
        entry
    }

    /// A cell over which the program stumbled.
    fn panicked(&self, job: &Job, panic: &str) -> Entry {
        self.failed(job, bug(&job.input.display().to_string(), panic))
    }
}

fn skipped(job: &Job) -> Entry {
    Entry::Skipped {
        file: job.input.display().to_string(),
        out: job.out.display().to_string(),
        skipped: true,
    }
}

/// What is made again although it is there, and what stays although little is known of it.
fn tell_standings(standings: &[Standing], reporter: &Reporter) {
    let number = |wanted: Standing| standings.iter().filter(|&&s| s == wanted).count();
    let told = |standing, what: &str| {
        let n = number(standing);
        if n > 0 {
            reporter.note(&format!("{} {what}", count(n, "output")));
        }
    };
    told(
        Standing::OtherOptions,
        "made with other options: made again",
    );
    told(Standing::OtherInput, "made of another input: made again");
    told(
        Standing::Newer,
        "kept, though it is not written down with which options they were made: --force makes them again",
    );
}

fn mesh_all(jobs: &[Job], made: &Made, context: &Context<'_>) -> anyhow::Result<Vec<Entry>> {
    let reporter = context.reporter;
    let one = jobs.len() == 1;
    let (total, unit) = if one {
        (0, "blocks")
    } else {
        (jobs.len(), "cells")
    };
    let progress = Progress::new(reporter, total, unit);
    let order = targets::largest_first(jobs);
    let results = workers::run(jobs, &order, reporter.threads(), |job| {
        let told = Told {
            reporter,
            progress: one.then_some(&progress),
        };
        let entry = context.cell(job, made, |output| {
            cell::mesh(job, context.recipe, output, told)
        });
        tell(&entry, one, reporter);
        if !one {
            progress.done();
        }
        entry
    })?;
    drop(progress);
    let named = jobs.iter().zip(results);
    let entries = named.map(|(job, result)| {
        result.unwrap_or_else(|panic| {
            let entry = context.panicked(job, &panic);
            tell(&entry, one, reporter);
            entry
        })
    });
    Ok(entries.collect())
}

/// Tells of a cell as it finishes.
fn tell(entry: &Entry, one: bool, reporter: &Reporter) {
    match entry {
        Entry::Done(cell) => {
            reporter.result(&line(cell));
            if one || reporter.verbose() {
                warn(cell, reporter);
            }
        }
        Entry::Failed(failed) => reporter.error(&failed.error),
        Entry::Skipped { .. } => {}
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
        let place = place(&cell.file, warning.line);
        let (message, code) = (&warning.message, warning.code);
        reporter.warning(&format!("{place} {message} ({code})"));
    }
}

/// The last words on standard error.
fn summarize(entries: &[Entry], skipped: usize, clock: Instant, reporter: &Reporter) {
    let mut done = 0;
    let mut causes: BTreeMap<&str, usize> = BTreeMap::new();
    let skipped = skipped
        + entries
            .iter()
            .filter(|e| matches!(e, Entry::Skipped { .. }))
            .count();
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
    if entries.len() != 1 || skipped > 0 {
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
        Some(job) => Some(self::skipped(job)),
        None => entries.next(),
    };
    jobs.iter().filter_map(next).collect()
}
