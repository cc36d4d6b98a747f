//! `neurotess neuroglancer`: cells as precomputed data, which neuroglancer opens.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::Context;
use clap::Args;
use neurotess::batch::standard::is_standard;
use neurotess::batch::workers::NotedPanics;
use neurotess::batch::{Inputs, MORPHOLOGIES, Shard};
use neurotess::circuit::{Circuit, Edges};
use neurotess::options::groups::CellSelection;
use neurotess::precomputed::{
    Event, Export, ExportError, ExportReport, LevelOptions, Server, link_to,
};
use neurotess::recipe::Spelling;
use serde::Serialize;

use crate::io::morphologies::ReaderWarning;
use crate::io::{circuits, inputs};
use crate::options::numbers::positive;
use crate::report::{Failed, Failure, Progress, Reporter, Usage, count, usage};

/// `neurotess neuroglancer`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess neuroglancer cells/ -o shared/ --serve      (opens from this machine)
  neurotess neuroglancer cells/ -o shared/ --url https://storage.googleapis.com/BUCKET/shared
  neurotess neuroglancer circuit/ -o shared/ --sharded --color-by layer
  neurotess neuroglancer circuit/ -o shared/ --sharded --shard $SLURM_ARRAY_TASK_ID/100
  neurotess neuroglancer -o shared/ --serve      (what was written before)

Segments: of a circuit the node's id + 1, and 10^12 more for each population before its own;
of files their names if all are numbers, else 1, 2, 3 in their order. Lengths in the files are
nanometers. FOLDER gets mesh/, skeletons/, properties/ and view.json, a state that shows up to
100 cells.")]
pub(crate) struct NeuroglancerArgs {
    /// Morphology files, folders (searched recursively) or globs; or one circuit, whose cells are written in
    /// its coordinates
    #[arg(value_name = "INPUT", required_unless_present = "serve")]
    pub(crate) inputs: Vec<PathBuf>,
    /// The folder that is written
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) out: PathBuf,
    /// Write a folder anew that is there
    #[arg(long, conflicts_with_all = ["resume", "shard"])]
    pub(crate) force: bool,
    /// How far the finest level may be from the smooth surface (µm)
    #[arg(long, value_name = "E", default_value_t = 0.04, value_parser = positive,
          allow_negative_numbers = true, help_heading = "Levels of detail")]
    pub(crate) max_error: f64,
    /// Most levels, 1 to 12: each has four times the error of the one before, the last is the coarse mesh
    #[arg(long, value_name = "N", default_value_t = 4,
          value_parser = clap::value_parser!(u8).range(1..=12), help_heading = "Levels of detail")]
    pub(crate) lods: u8,
    /// Some hundred cells in a file, for circuits
    #[arg(long, help_heading = "Many cells")]
    pub(crate) sharded: bool,
    /// Finish a folder that was begun with the same inputs and options
    #[arg(long, help_heading = "Many cells")]
    pub(crate) resume: bool,
    /// Only part I of N, by whole files, for one of many machines; they may share FOLDER. Part 1 also
    /// writes properties and the view
    #[arg(long, value_name = "I/N", help_heading = "Many cells")]
    pub(crate) shard: Option<Shard>,
    #[command(flatten)]
    pub(crate) cells: CellSelection,
    /// Color cells by an attribute of their nodes [default: population]
    #[arg(long, value_name = "NAME", help_heading = "View")]
    pub(crate) color_by: Option<String>,
    /// Synapses of these populations of connections as annotations, as in A,B; or all
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        help_heading = "View"
    )]
    pub(crate) synapses: Vec<String>,
    /// Where browsers will find FOLDER: https://…, gs://… or s3://… [default: where --serve serves it]
    #[arg(long, value_name = "URL", value_parser = address, help_heading = "View")]
    pub(crate) url: Option<String>,
    /// Then serve FOLDER to browsers of this machine, until Ctrl-C
    #[arg(long, help_heading = "View")]
    pub(crate) serve: bool,
    /// The port that --serve listens to
    #[arg(long, value_name = "P", default_value_t = 9000, help_heading = "View")]
    pub(crate) port: u16,
}

/// Where browsers, or what they read with, find a folder.
fn address(text: &str) -> Result<String, String> {
    let known = ["https://", "http://", "gs://", "s3://"];
    let place = known.iter().find_map(|begin| text.strip_prefix(begin));
    match place {
        Some(place) if !place.is_empty() && !place.contains(char::is_whitespace) => {
            Ok(text.trim_end_matches('/').to_owned())
        }
        _ => Err(format!("it begins with one of {}", known.join(", "))),
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Document {
    out: String,
    written: usize,
    kept: usize,
    triangles: u64,
    bytes: u64,
    synapses: usize,
    link: String,
    warnings: BTreeMap<&'static str, usize>,
    failed: Vec<Failed>,
}

/// Runs the command.
pub(crate) fn run(args: &NeuroglancerArgs, reporter: &Reporter) -> anyhow::Result<()> {
    if args.serve {
        // Said before the work, not after it.
        Server::check(args.port)?;
    }
    let link = match args.inputs.is_empty() {
        true => written_link(&args.out)?,
        false => write(args, reporter)?,
    };
    if !args.serve {
        return Ok(());
    }
    let server = Server::new(&args.out, args.port)?;
    let folder = args.out.display();
    reporter.note(&format!("{folder} is at {} until Ctrl-C", server.url()));
    if args.inputs.is_empty() {
        reporter.answer(&link);
    }
    server.run();
    Ok(())
}

/// The link to the view of a folder.
fn written_link(folder: &Path) -> anyhow::Result<String> {
    let file = folder.join("view.json");
    let told = || {
        let file = file.display();
        format!("{file} cannot be read: name the inputs that are to be written there")
    };
    let text = fs::read(&file).with_context(told)?;
    Ok(link_to(&serde_json::from_slice(&text).with_context(told)?))
}

/// Writes the folder, and returns the link to its view.
fn write(args: &NeuroglancerArgs, reporter: &Reporter) -> anyhow::Result<String> {
    let clock = Instant::now();
    let Some(export) = export_of(args, reporter)? else {
        reporter.document(&Vec::<Failed>::new())?;
        return Ok(String::new());
    };
    let local = format!("http://127.0.0.1:{}", args.port);
    let mut export = export
        .into(&args.out)
        .levels(LevelOptions {
            max_error: args.max_error as f32,
            count: usize::from(args.lods),
        })
        .sharded(args.sharded)
        .resume(args.resume)
        .replace(args.force)
        .workers(reporter.threads())
        .url(args.url.clone().unwrap_or(local));
    if let Some(attribute) = &args.color_by {
        export = export.color_by(attribute);
    }
    if let Some(shard) = args.shard {
        export = export.part(shard);
    }
    let out = args.out.display().to_string();
    let report = follow(export, &out, reporter)?;
    tell(&report, &out, clock, reporter);
    let failed = report.failures.iter().map(|failure| Failed {
        file: failure.file.display().to_string(),
        error: failure.told(Spelling::Flag),
    });
    reporter.document(&Document {
        out,
        written: report.written,
        kept: report.kept,
        triangles: report.triangles,
        bytes: report.bytes,
        synapses: report.synapses,
        link: report.link.clone(),
        warnings: report.warnings.clone(),
        failed: failed.collect(),
    })?;
    Ok(report.link)
}

/// What is to be written; none if the circuit cannot be opened, which is reported.
fn export_of(args: &NeuroglancerArgs, reporter: &Reporter) -> anyhow::Result<Option<Export>> {
    let (circuits, others) = circuits::partition(&args.inputs);
    if let [path] = &circuits[..]
        && others.is_empty()
    {
        let opened = circuits::open(path, reporter)
            .and_then(|circuit| Ok((args.cells.select(&circuit)?, circuit)));
        let (nodes, circuit) = match opened {
            Ok(opened) => opened,
            Err(failure) => {
                reporter.failure(&failure);
                return Ok(None);
            }
        };
        let instances = circuits::instances(&circuit, &nodes, reporter);
        let edges = synapses_of(args, &circuit)?;
        let export = Export::of_circuit(Arc::new(circuit), instances);
        return Ok(Some(export.synapses(edges)));
    }
    if !circuits.is_empty() {
        return usage("a circuit is written alone: leave out the other inputs");
    }
    if args.cells.any() || args.color_by.is_some() || !args.synapses.is_empty() {
        return usage(
            "no input is a circuit: leave out --color-by, --synapses and what chooses cells",
        );
    }
    if args.inputs.iter().any(|input| is_standard(input)) {
        return usage("standard input cannot be read twice: name a file");
    }
    let found = Inputs::find(&args.inputs, &MORPHOLOGIES);
    inputs::tell(&found, reporter);
    Ok(Some(Export::of(found)))
}

/// The populations of connections that are asked for.
fn synapses_of(args: &NeuroglancerArgs, circuit: &Circuit) -> anyhow::Result<Vec<Edges>> {
    if let [all] = &args.synapses[..]
        && all == "all"
    {
        return Ok(circuit.edges.clone());
    }
    let named = |name: &String| {
        let found = circuit.edges.iter().find(|edges| edges.name == *name);
        found.cloned().map_or_else(
            || {
                let there: Vec<&str> = circuit.edges.iter().map(|edges| &*edges.name).collect();
                usage(format!("--synapses {name}: there are {}", there.join(", ")))
            },
            Ok,
        )
    };
    args.synapses.iter().map(named).collect()
}

/// Does what is to be done, and reports it.
fn follow(export: Export, out: &str, reporter: &Reporter) -> anyhow::Result<ExportReport> {
    let progress = Progress::new(reporter, 0, "cells");
    let noted = NotedPanics::begin();
    let done = AtomicUsize::new(0);
    let all = AtomicUsize::new(0);
    let told = |event: Event<'_>| match event {
        Event::Planned { to_do, .. } => all.store(to_do, Ordering::Relaxed),
        Event::Written(cell) => {
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress.at(done, all.load(Ordering::Relaxed));
            if reporter.verbose() {
                let (label, id) = (&cell.label, cell.id);
                let triangles = count(cell.triangles, "triangle");
                reporter.result(&format!(
                    "{label} → segment {id}: {triangles}, {} bytes",
                    cell.bytes
                ));
            }
        }
        Event::Warned { file, warnings } if reporter.verbose() => {
            let file = file.display().to_string();
            for warning in warnings {
                let warning = ReaderWarning::from(warning.clone());
                reporter.warning(&warning.in_file(&file));
            }
        }
        Event::Failed(failure) => reporter.failure(&Failure(failure.told(Spelling::Flag))),
        _ => {}
    };
    let report = export.run(told).map_err(|error| match error {
        ExportError::Other(_) => anyhow::anyhow!(
            "{out} was written from other cells, or with other options: give another folder, or --force"
        ),
        ExportError::Exists(_) => anyhow::anyhow!(
            "{out} was written before: --resume finishes it, --force writes it anew"
        ),
        ExportError::NoAttribute { .. } => Usage(format!("--color-by: {error}")).into(),
        ExportError::Ids(error) => Usage(error.to_string()).into(),
        other => other.into(),
    });
    drop((noted, progress));
    report
}

/// The summary, and the link.
fn tell(report: &ExportReport, out: &str, clock: Instant, reporter: &Reporter) {
    let (cells, kept) = (count(report.written, "cell"), report.kept);
    let kept = if kept > 0 {
        format!(", {kept} kept")
    } else {
        String::new()
    };
    reporter.note(&format!(
        "{cells} → {out}: {}, {:.1} MB{kept} in {:.2} s",
        count(report.triangles as usize, "triangle"),
        report.bytes as f64 / 1e6,
        clock.elapsed().as_secs_f64()
    ));
    inputs::tell_warnings(&report.warnings, reporter);
    if !report.link.is_empty() {
        reporter.result(&report.link);
    }
}
