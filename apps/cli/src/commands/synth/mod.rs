//! `neurotess synth`: synthetic neurons.

mod args;
mod circuit;

use std::path::{Path, PathBuf};

use itertools::Itertools;
use neurotess::formats::Format;
use neurotess::formats::swc::SampleNumbers;
use neurotess::synth::{self, Kind, Options};
use serde::Serialize;

use crate::io::morphologies::write_morphology;
use crate::io::{output, workers};
use crate::report::{Entry, Failed, Failure, Progress, Reporter, bug, count, usage};
pub(crate) use args::SynthArgs;
use args::What;

/// One object of the JSON list.
#[derive(Serialize)]
struct Grown {
    out: String,
    kind: &'static str,
    seed: u64,
    n_points: usize,
}

/// Runs the command.
pub(crate) fn run(args: &SynthArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let kind = match args.kind {
        What::Cells(kind) => kind,
        What::Circuit => return circuit::run(args, reporter),
    };
    output::reserve_standard(&args.out.out, reporter)?;
    let cells = plan(args, kind)?;
    let progress = Progress::new(reporter, cells.len(), "cells");
    let order: Vec<usize> = (0..cells.len()).collect();
    let results = workers::run(&cells, &order, reporter.threads(), |(options, out)| {
        let grown = grow(options, out, args.out.force);
        progress.done();
        grown
    })?;
    drop(progress);
    let named = cells.iter().zip_eq(results);
    let entries = named.map(|((_, out), result)| {
        let file = out.display().to_string();
        match result.unwrap_or_else(|panic| Err(bug(&file, &panic))) {
            Ok(grown) => Entry::Done(grown),
            Err(failure) => {
                reporter.failure(&failure);
                let error = failure.0;
                Entry::Failed(Failed { file, error })
            }
        }
    });
    let entries: Vec<Entry<Grown>> = entries.collect();
    tell(&entries, &args.out.out, reporter);
    reporter.document(&entries)
}

/// The cells and their files.
fn plan(args: &SynthArgs, kind: Kind) -> anyhow::Result<Vec<(Options, PathBuf)>> {
    let out = &args.out.out;
    let extension = out.extension().unwrap_or_default();
    let standard = output::is_standard(out);
    if standard && args.count > 1 {
        return usage("standard output takes one cell: leave out --count, or give a folder");
    }
    let folder = !standard && (args.count > 1 || out.is_dir() || extension.is_empty());
    if folder && (out.is_file() || !extension.is_empty() && !out.is_dir()) {
        return usage(format!(
            "{} is a file's name, but {} cells need a folder: give another OUT",
            out.display(),
            args.count
        ));
    }
    if !folder && !standard && !extension.eq_ignore_ascii_case("swc") {
        return usage(format!(
            "{}: synthetic cells are written as swc: give OUT that extension",
            out.display()
        ));
    }
    let Some(last) = args.seed.checked_add(args.count as u64 - 1) else {
        return usage("the seeds of so many cells exceed 64 bits: give a lower --seed");
    };
    let cells = (args.seed..=last).map(|seed| {
        let options = Options {
            kind,
            seed,
            points: args.points.map(|points| points as usize),
            may_cross: args.may_cross,
        };
        let path = if folder {
            out.join(format!("{}_{seed}.swc", options.kind))
        } else {
            out.clone()
        };
        (options, path)
    });
    Ok(cells.collect())
}

fn grow(options: &Options, out: &Path, force: bool) -> Result<Grown, Failure> {
    // The message already names the file.
    let failed = |e: output::OutputError| Failure(e.to_string());
    output::check(out, force).map_err(failed)?;
    let morphology = synth::grow(options);
    write_morphology(
        &morphology,
        Format::Swc,
        SampleNumbers::default(),
        out,
        force,
    )
    .map_err(failed)?;
    Ok(Grown {
        out: out.display().to_string(),
        kind: options.kind.name(),
        seed: options.seed,
        n_points: morphology.points.len(),
    })
}

fn tell(entries: &[Entry<Grown>], out: &Path, reporter: &Reporter) {
    let done = entries.iter().filter_map(|entry| match entry {
        Entry::Done(grown) => Some(grown),
        Entry::Failed(_) => None,
    });
    let grown: Vec<&Grown> = done.collect();
    match grown[..] {
        [] => {}
        [one] => reporter.result(&format!("{}: {} points", one.out, one.n_points)),
        _ => reporter.result(&format!(
            "{} in {}",
            count(grown.len(), "cell"),
            out.display()
        )),
    }
}
